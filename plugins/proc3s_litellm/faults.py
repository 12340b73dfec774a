"""What went wrong with a call, read from what the server really sent and not from litellm's disguises."""

import json
import re
from collections.abc import Iterator
from typing import Any

from proc3s_litellm.refusals import Failure, fault_by_words, is_html, one_line, refused, words

_WRONG_SHAPE = (KeyError, TypeError, AttributeError, IndexError, RecursionError)


def diagnose(error: BaseException) -> Failure:
    """The failure behind an exception of litellm.

    The chain of causes is followed from the outside: whatever the caller was busy with comes last.
    """
    return next(filter(None, map(_decisive, _chain(error))), None) or _undecided(error)


def _chain(error: BaseException | None) -> Iterator[BaseException]:
    seen: list[int] = []
    while error is not None and id(error) not in seen:
        seen.append(id(error))
        yield error
        error = error.__cause__ or error.__context__


def _decisive(link: BaseException) -> Failure | None:
    """What one link of the chain proves: a server refused, or the way to it failed."""
    import httpx

    if isinstance(link, httpx.HTTPStatusError):
        return refused(link.response.status_code, _body(link.response), link.response.headers)
    if isinstance(link, httpx.TransportError):
        return _transport(link)
    if isinstance(link, TimeoutError):
        return Failure("timeout")
    if isinstance(link, httpx.DecodingError):
        return Failure("broken", "it cannot be decompressed")
    if isinstance(link, httpx.TooManyRedirects):
        return Failure("other", "the server sends in circles", lost=True)
    if isinstance(link, json.JSONDecodeError):
        return _unreadable(link.doc)
    if isinstance(link, ModuleNotFoundError):
        return Failure("other", f"litellm needs the Python module {link.name}, which is not installed")
    if type(link) is Exception and hasattr(link, "status_code"):
        return _error_in_200(link)
    return None


def _body(response: Any) -> str:
    import httpx

    try:
        return str(response.text)
    except httpx.ResponseNotRead:
        return ""


def _transport(error: Any) -> Failure:
    """A failure on the way: no answer in time, none at all, or half of one."""
    import httpx

    words = one_line(re.sub(r"^\[Errno -?\d+\] ", "", str(error)).rstrip("."))
    if isinstance(error, httpx.TimeoutException):
        return Failure("timeout")
    if isinstance(error, httpx.LocalProtocolError | httpx.UnsupportedProtocol):
        return Failure("other", words)
    if isinstance(error, httpx.RemoteProtocolError) and "without sending a response" not in words:
        return Failure("broken", "the answer breaks off")
    return Failure("connection", words)


def _unreadable(body: str) -> Failure:
    """A body that is no answer; what is wrong with an HTML page is the address."""
    html = is_html(body)
    return Failure("broken", "a page of HTML" if html else "not JSON", lost=html)


def _error_in_200(link: Any) -> Failure:
    """An error that was sent with status 200, as gateways do; litellm makes an exception of it."""
    code, message = str(link.status_code), str(getattr(link, "message", ""))
    if re.fullmatch(r"[45]\d\d", code):
        return refused(int(code), json.dumps({"message": message}), {})
    return _unnumbered(code, message)


def sent_as_success(body: str) -> Failure | None:
    """The error in a body that came with status 200 and has no number of its own; litellm says 422 then."""
    error = json.loads(body)["error"]
    if isinstance(error, dict) and re.fullmatch(r"[45]\d\d", str(error.get("code"))):
        return None
    code = str(error.get("code") or error.get("type") or "") if isinstance(error, dict) else ""
    return _unnumbered(code, words(body))


def _unnumbered(code: str, message: str) -> Failure:
    if re.search(r"unexpected endpoint|no such (route|endpoint)|invalid url", message, re.IGNORECASE):
        return Failure("other", one_line(message), lost=True)
    return Failure(fault_by_words(f"{code} {message}") or "server", one_line(message))


def _undecided(error: BaseException) -> Failure:
    """No link proves anything: litellm failed by itself, or could not make sense of an answer."""
    text, status = str(error), getattr(error, "status_code", None)
    if "LLM Provider NOT provided" in text or "GetLLMProvider" in text:
        return Failure("unknown_model")
    if re.search(r"api_key client option|credentials|missing .*api key", text, re.IGNORECASE):
        return Failure("missing_key")
    if is_html(text):
        return _unreadable(text)
    if _no_answer(text) or any(isinstance(link, _WRONG_SHAPE) for link in _chain(error)):
        return Failure("broken", "not in the shape of an answer")
    if any(getattr(link, "status_code", None) == 200 for link in _chain(error)):
        return Failure("broken", one_line(_bare(text)))
    if isinstance(status, int) and status != 500:
        return refused(status, json.dumps({"message": _bare(text)}), {})
    return Failure("other", one_line(_bare(text)))


def _no_answer(text: str) -> bool:
    return bool(re.search(r"invalid response|provider returned|to valid response", text, re.IGNORECASE))


def _bare(text: str) -> str:
    """litellm's text without its own prefixes and tracebacks."""
    text = text.partition("Traceback (most recent call last)")[0]
    return re.sub(r"^(litellm\.)?\w+(Error|Timeout): (\w+: )?(\w+Exception - )?", "", text)
