"""A refusal as it came over the wire: status, body and headers say what kind of failure it is."""

import email.utils
import json
import math
import re
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from proc3s.llm.errors import LLMFault

_LONGEST = 2000
_HTML = re.compile(r"<(!doctype|html|head|body)\b", re.IGNORECASE)
_RETRY = re.compile(r'retry(?:Delay"?: ?"?| in )(\d+(?:\.\d+)?) ?s')

_STATUS: Mapping[int, LLMFault] = {
    401: "auth",
    402: "quota",
    403: "auth",
    404: "unknown_model",
    408: "timeout",
    413: "context",
    429: "rate_limit",
    504: "timeout",
}
_QUOTA = r"""
    insufficient_quota | exceeded.your.current.quota | billing | insufficient.(balance|credit|funds)
    | credit.balance | (out.of|all.available|not.enough).credits | spending.limit | payment.required
"""
_CONTEXT = r"""
    context_length_exceeded | exceed_context_size | (maximum|model's|available).context
    | context.(window|limit|size|length) | prompt.is.too.long | input.is.too.long | request.too.large
    | maximum.(prompt|input|model).length | exceeds.the.maximum.number.of.tokens | too.many.tokens
    | tokens_limit_reached | reduce.the.length.of.the.messages
"""
_FILTERED = r"""
    content.?(filter|policy|management) | safety.system | responsible.?ai | usage.polic | data_inspection
    | prohibited_content | content.exists.risk | \bflagged\b | guardrail
"""
_KEY = r"""
    api.?key.{0,20}(invalid|not.valid|expired)
    | (invalid|incorrect|wrong|missing).{0,12}(api.?key|authentication)
"""
_MODEL = r"""
    model_not_found | (invalid|unknown|no.such).model | not.a.valid.model | access.to.model
    | model\b.{0,80}(not.found|not.exist|not.available|no.longer|decommissioned)
"""
_BY_WORDS: Mapping[LLMFault, str] = {
    "quota": _QUOTA,
    "context": _CONTEXT,
    "filtered": _FILTERED,
    "auth": _KEY,
    "unknown_model": _MODEL,
}
_TELLING: Mapping[int, frozenset[LLMFault]] = {
    401: frozenset({"quota"}),
    402: frozenset(),
    403: frozenset({"quota", "filtered", "unknown_model"}),
    404: frozenset({"quota", "filtered"}),
    413: frozenset({"quota"}),
    429: frozenset({"quota", "context"}),
}
"""What the words may make of a status; of 400 and its like they may make anything."""


@dataclass(frozen=True)
class Failure:
    """What is known of a failed call; `words` are those of whoever refused, one line of plain text."""

    fault: LLMFault
    words: str = ""
    status: int | None = None
    retry_after: float | None = None
    lost: bool = False
    """Whether it looks as if the address led nowhere."""
    about: str = ""
    """Names of the parameters that the refusal is about, where it lists them."""


def refused(status: int, body: str, headers: Mapping[str, str]) -> Failure:
    """The failure behind a status, the body that came with it, and its headers."""
    delay = retry_after(headers)
    if delay is None and (found := _RETRY.search(body)):
        delay = float(found[1])
    return Failure(_fault(status, body, delay), words(body), status, delay, is_html(body), _about(body))


def _fault(status: int, body: str, delay: float | None) -> LLMFault:
    telling = "" if is_html(body) else " ".join(_message(body))
    if status == 429 and delay is not None and "RESOURCE_EXHAUSTED" in telling and "PerDay" not in telling:
        return "rate_limit"  # Gemini speaks of quota and billing where a minute's wait is meant
    said = fault_by_words(telling)
    if status >= 500:
        return "context" if said == "context" else _STATUS.get(status, "server")
    if said and said in _TELLING.get(status, _BY_WORDS):
        return said
    return _STATUS.get(status, "other")


def fault_by_words(text: str) -> LLMFault | None:
    """The kind of failure that a message speaks of."""
    flags = re.IGNORECASE | re.VERBOSE | re.DOTALL
    return next((fault for fault, pattern in _BY_WORDS.items() if re.search(pattern, text, flags)), None)


def is_html(body: str) -> bool:
    """Whether a body is a page, or holds one."""
    return bool(_HTML.search(body))


def words(body: str) -> str:
    """What a body says to people: one line, never HTML."""
    return "a page of HTML" if is_html(body) else one_line(_message(body)[0])


def one_line(text: str) -> str:
    """The printable part of a text, on one line."""
    return " ".join("".join(c if c.isprintable() else " " for c in text[:_LONGEST]).split())


def _message(body: str) -> tuple[str, str]:
    """Message and codes of an error; a request that the body may echo is in neither.

    Providers word it `{"error": {"message", "type", "code", …}}`, or nearly so.
    """
    error = _error(body)
    if not isinstance(error, dict):
        return str(error)[:_LONGEST], ""
    said = next((_text(error[name]) for name in ("message", "msg", "detail", "error") if error.get(name)), "")
    metadata = error.get("metadata")
    upstream = metadata.get("raw") if isinstance(metadata, dict) else None
    message = f"{said}: {upstream}" if isinstance(upstream, str) else said
    return message[:_LONGEST], json.dumps([error.get(name) for name in ("type", "code", "status", "details")])


def _error(body: str) -> Any:
    """The error in a body: mostly a dict; a text if it is no JSON."""
    try:
        data = json.loads(body)
    except (ValueError, RecursionError):
        return body
    first = data[0] if isinstance(data, list) and data else data
    if not isinstance(first, dict):
        return first
    several = first.get("errors")
    return several[0] if isinstance(several, list) and several else first.get("error", first)


def _about(body: str) -> str:
    """OpenAI names one parameter as `param`, FastAPI a path to each as `loc`."""
    error = _error(body)
    if not isinstance(error, dict):
        return ""
    detail = error.get("detail")
    paths = [part.get("loc") for part in detail if isinstance(part, dict)] if isinstance(detail, list) else []
    ends = [str(path[-1]) for path in paths if isinstance(path, list) and path]
    return " ".join([*ends, str(error.get("param") or "")]).strip()


def _text(said: Any) -> str:
    """A message; FastAPI sends a list with one entry a mistake, and the input beside it."""
    if isinstance(said, list):
        return "; ".join(str(part.get("msg", "")) for part in said if isinstance(part, dict))
    return str(said)


def retry_after(headers: Mapping[str, str]) -> float | None:
    """Seconds that the headers ask to wait, given in milliseconds, in seconds or as a date; else None."""
    for name, unit in (("retry-after-ms", 1000.0), ("retry-after", 1.0)):
        try:
            seconds = float(headers.get(name, "")) / unit
        except ValueError:
            continue
        return seconds if math.isfinite(seconds) and seconds >= 0 else None
    return _until(headers.get("retry-after", ""))


def _until(date: str) -> float | None:
    try:
        return max(0.0, email.utils.parsedate_to_datetime(date).timestamp() - time.time())
    except (ValueError, OverflowError):
        return None
