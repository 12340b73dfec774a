"""A language-model provider on this machine: a real HTTP server that does as it is told.

It speaks the chat protocols of OpenAI and Anthropic. `server.script(...)` sets what the next questions get,
one reply each; a question beyond the script gets `server.text`. `server.asked` remembers them all. The list
of models (GET) is `server.listing`; who looked it up is in `server.looked_up`.
"""

import json
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Literal

Headers = Mapping[str, str]
MODEL = "tiny-2026"
USAGE = {"prompt_tokens": 11, "completion_tokens": 22, "total_tokens": 33}


@dataclass(frozen=True)
class Reply:
    """What one request gets. `body` replaces the answer that the protocol asks for."""

    text: str | None = None
    status: int = 200
    body: bytes | None = None
    headers: Headers = field(default_factory=dict)
    finish: str = "stop"
    usage: Mapping[str, Any] | None = field(default_factory=lambda: USAGE)
    after: float = 0.0
    """Seconds before anything is sent."""
    does: Literal["answer", "hang", "close", "cut", "drip", "drip head", "spaces"] = "answer"
    """`hang`: nothing is sent; `close`: the connection ends; `cut`: it ends amid the body; `drip`: the body
    comes byte by byte, `drip head` the headers, ever more of them; `spaces`: lines that keep it open."""


def says(text: str | None, **how: Any) -> Reply:
    """An answer, or a candidate without text."""
    return Reply(text=text, **how)


def sends(body: object, status: int = 200, **headers: str) -> Reply:
    """This very body: bytes as they are, a text as a page of HTML, anything else as JSON."""
    kind = "text/html" if isinstance(body, str) else "application/json"
    data = body if isinstance(body, bytes) else body.encode() if isinstance(body, str) else _json(body)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    return Reply(status=status, body=data, headers={"Content-Type": kind, **named})


def refuses(status: int, message: str, *, code: str | None = None, **headers: str) -> Reply:
    """An error as OpenAI words it."""
    error = {"message": message, "type": code or "error", "param": None, "code": code}
    return sends({"error": error}, status, **headers)


HANGS = Reply(does="hang")
CLOSES = Reply(does="close")
CUTS = Reply(text="half of this never arrives", does="cut")
DRIPS = tuple(Reply(body=b"{" + b" " * 1000, does=does) for does in ("drip", "drip head", "spaces"))


@dataclass(frozen=True)
class Asked:
    """One request as it came in; header names are in lower case."""

    path: str
    headers: Headers
    body: Any

    @property
    def key(self) -> str | None:
        """The key in its headers, whichever protocol it belongs to."""
        bearer = self.headers.get("authorization", "").removeprefix("Bearer ")
        return self.headers.get("x-api-key") or bearer or None


class Provider(ThreadingHTTPServer):
    """The server. `address` is what `-L api_base=` takes for models of OpenAI's protocol."""

    daemon_threads = True

    def __init__(self, text: str = "an answer") -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.text = text
        self.listing = sends({"object": "list", "data": [{"id": MODEL, "object": "model"}]})
        self.asked: list[Asked] = []
        self.looked_up: list[Asked] = []
        self.closing = threading.Event()
        self.under = ""
        """Where everything is; any other path is not found."""
        self._script: list[Reply] = []
        self._lock = threading.Lock()

    @property
    def root(self) -> str:
        """The address without a path, as models of Anthropic's protocol want it."""
        return f"http://127.0.0.1:{self.server_port}"

    @property
    def address(self) -> str:
        """The address with the path of OpenAI's protocol."""
        return f"{self.root}/v1"

    @property
    def keys(self) -> list[str | None]:
        """The keys that came with the requests."""
        return [request.key for request in self.asked]

    def script(self, *replies: Reply) -> None:
        """Set what the next requests get, in order."""
        with self._lock:
            self._script = list(replies)

    def next_reply(self, request: Asked) -> Reply:
        """Remember a request; the reply that it gets."""
        with self._lock:
            self.asked.append(request)
            return self._script.pop(0) if self._script else says(self.text)

    def handle_error(self, *_: object) -> None:
        """A client that goes away is no news."""


class _Handler(BaseHTTPRequestHandler):
    server: Provider

    def do_GET(self) -> None:
        self.server.looked_up.append(Asked(self.path, self._named(), None))
        self._send(self.server.listing, b"")

    def do_POST(self) -> None:
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        reply = self.server.next_reply(Asked(self.path, self._named(), body))
        speak = _anthropic if self.path.endswith("/messages") else _openai
        self._send(reply, speak(reply, body))

    def _named(self) -> dict[str, str]:
        return {name.lower(): value for name, value in self.headers.items()}

    def _send(self, reply: Reply, answer: bytes) -> None:
        self.close_connection = True
        if reply.does == "hang" or reply.after:
            self.server.closing.wait(reply.after or None)
        if reply.does in ("hang", "close"):
            return
        if not self.path.startswith(self.server.under):
            reply = sends({"detail": "Not Found"}, 404)
        body = answer if reply.body is None else reply.body
        if reply.does == "drip head":
            self._drip(b"HTTP/1.1 200 OK\r\n" + b"X: y\r\n" * 1000)
            return
        self.send_response(reply.status)
        for name, value in {"Content-Type": "application/json", **reply.headers}.items():
            self.send_header(name, value)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if reply.does in ("drip", "spaces"):
            self._drip(body if reply.does == "drip" else b"\n" * len(body))
            return
        self.wfile.write(body[: len(body) // 2] if reply.does == "cut" else body)

    def _drip(self, data: bytes) -> None:
        for k in range(len(data)):
            if self.server.closing.wait(0.05):
                return
            self.wfile.write(data[k : k + 1])
            self.wfile.flush()

    def log_message(self, *_: object) -> None:
        """Keep the test output clean."""


def _json(data: object) -> bytes:
    return json.dumps(data).encode()


def _openai(reply: Reply, asked: Mapping[str, Any]) -> bytes:
    """As many candidates as were asked for, numbered where there are several."""
    n = asked.get("n") or 1
    texts = [f"{reply.text} {k}" if n > 1 and reply.text else reply.text for k in range(n)]
    choices = [
        {"index": k, "message": {"role": "assistant", "content": text}, "finish_reason": reply.finish}
        for k, text in enumerate(texts)
    ]
    head = {"id": "1", "object": "chat.completion", "created": 1, "model": MODEL}
    usage = {} if reply.usage is None else {"usage": reply.usage}
    return _json({**head, "choices": choices, **usage})


def _anthropic(reply: Reply, asked: Mapping[str, Any]) -> bytes:
    usage = reply.usage or {}
    tokens = {
        "input_tokens": usage.get("prompt_tokens", 0),
        "output_tokens": usage.get("completion_tokens", 0),
    }
    return _json(
        {
            "id": "1",
            "type": "message",
            "role": "assistant",
            "model": asked.get("model"),
            "content": [] if reply.text is None else [{"type": "text", "text": reply.text}],
            "stop_reason": "end_turn" if reply.finish == "stop" else reply.finish,
            "usage": tokens,
        }
    )


@contextmanager
def running(text: str = "an answer") -> Iterator[Provider]:
    """A server for as long as the block lasts."""
    server = Provider(text)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.closing.set()
        server.shutdown()
        thread.join()
        server.server_close()
