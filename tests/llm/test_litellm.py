"""The litellm backend against a real HTTP server on this machine that speaks the OpenAI protocol."""

import json
import os
import subprocess
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

ANSWER = (
    (Path(__file__).parents[2] / "domains/proc3s_drawing/answers/star.proc3s.md")
    .read_text()
    .split("---\n")[2]
)

pytestmark = pytest.mark.slow


class Provider(ThreadingHTTPServer):
    """Answers every question with `reply`, and remembers what it was asked."""

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.reply: tuple[int, dict[str, object]] = (200, completion(ANSWER))
        self.asked: list[dict[str, object]] = []
        self.keys: list[str] = []


class Handler(BaseHTTPRequestHandler):
    server: Provider

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.server.asked.append(json.loads(body))
        self.server.keys.append(self.headers["Authorization"])
        status, reply = self.server.reply
        data = json.dumps(reply).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, *_: object) -> None:
        """Keep the test output clean."""


def completion(text: str | None, finish: str = "stop") -> dict[str, object]:
    message = {"role": "assistant", "content": text}
    return {
        "id": "1",
        "object": "chat.completion",
        "created": 1,
        "model": "tiny-2026",
        "choices": [{"index": 0, "message": message, "finish_reason": finish}],
        "usage": {"prompt_tokens": 11, "completion_tokens": 22, "total_tokens": 33},
    }


@pytest.fixture
def provider() -> Iterator[Provider]:
    server = Provider()
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


def run(provider: Provider, folder: Path, **environment: str) -> tuple[int, dict[str, object], str]:
    api_base = f"http://127.0.0.1:{provider.server_port}/v1"
    command = [
        "proc3s",
        "run",
        "drawing/star",
        "--llm",
        "openai/tiny",
        "-L",
        f"api_base={api_base}",
        "--json",
    ]
    clean = {name: value for name, value in os.environ.items() if not name.endswith("_API_KEY")}
    done = subprocess.run(
        [*command, "--out", folder / "run"],
        env={**clean, **environment},
        capture_output=True,
        text=True,
        timeout=120,
    )
    return done.returncode, json.loads(done.stdout), done.stderr


def test_a_model_behind_a_local_server_solves_the_task(provider: Provider, tmp_path: Path) -> None:
    code, summary, _ = run(provider, tmp_path)
    assert code == 0
    assert summary["llm_source"] == "live"
    assert summary["goal_reached"]
    roles = [message["role"] for message in provider.asked[0]["messages"]]
    assert roles == ["system", "user", "assistant", "user"]
    events = [json.loads(line) for line in (tmp_path / "run/events.jsonl").read_text().splitlines()]
    answer = next(event for event in events if event["event"] == "answer_received")["completion"]
    assert (answer["model"], answer["prompt_tokens"], answer["completion_tokens"]) == ("tiny-2026", 11, 22)


def test_the_key_reaches_the_provider_and_nothing_else(provider: Provider, tmp_path: Path) -> None:
    code, _, stderr = run(provider, tmp_path, OPENAI_API_KEY="sk-planted-secret")
    assert code == 0
    assert provider.keys == ["Bearer sk-planted-secret"]
    assert "sk-planted-secret" not in stderr
    for path in (tmp_path / "run").iterdir():
        assert b"sk-planted-secret" not in path.read_bytes(), path


@pytest.mark.parametrize(
    ("status", "reply", "said"),
    [
        (401, {"error": {"message": "no such key", "type": "invalid_request_error"}}, "no such key"),
        (500, {"error": {"message": "the model fell over"}}, "fell over"),
        (200, completion(None), "the answer is empty"),
        (200, completion("gen_plan", "length"), "the answer was cut off"),
    ],
)
def test_a_provider_that_does_not_answer_ends_the_run_with_code_3(
    provider: Provider, tmp_path: Path, status: int, reply: dict[str, object], said: str
) -> None:
    provider.reply = (status, reply)
    code, summary, stderr = run(provider, tmp_path)
    assert code == 3
    assert said in str(summary["error"])
    assert "Traceback" not in stderr
    assert len(provider.asked) == 1
    assert (tmp_path / "run/prompt-0.md").is_file()
