"""How answers are drawn: which of the wishes a model takes, as far as litellm knows."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from proc3s import Sampling
from proc3s_litellm.prices import entry
from proc3s_litellm.refusals import Failure

_WORDED: Mapping[str, str] = {
    "temperature": r"(?<![\w-])temperature(?![\w-])",
    "seed": r"(?<![\w-])(random_?)?seed(?![\w-])",
    "max_tokens": r"(?<![\w-])max_?(completion_?|output_?|new_?)?tokens(?![\w-])",
    "n": r"""['"`]n['"`] | (?<![\w-])n\ ?(=|>|must|should|is\ ) | ^n\b | candidate_?count
        | (argument|parameter|field)s?(\ supplied)?:?\ n\b""",
    "reasoning_effort": r"(?<![\w-])(reasoning(_?effort)?|(enable_?)?think(ing)?)(?![\w-])",
}
"""What providers call the parameters in their refusals."""
_TOO_MANY = re.compile(r"max_?(completion_?)?tokens\W.{0,40}too (large|high)", re.IGNORECASE)
_OTHER_NAME = re.compile(r"use\W{0,3}max_completion_tokens", re.IGNORECASE)
_NOT_IN_RESPONSES = frozenset({"n", "seed"})
"""Models that are only served by OpenAI's Responses API: it has no such parameters."""


def split(litellm: Any, model: str, sampling: Sampling) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Arguments for the call, and the names of those that must be left out because the model refuses them.

    What litellm would drop silently is found by leaving out one after the other and comparing the results.
    """
    wanted = {k: v for k, v in sampling.model_dump(exclude_none=True).items() if (k, v) != ("n", 1)}
    whole = _mapped(litellm, model, wanted)
    dropped = {k for k in wanted if _mapped(litellm, model, _without(wanted, k)) == whole}
    if "thinking" in whole and wanted.get("temperature") != 1.0:
        # Claude refuses any other while it thinks, and DeepSeek ignores it; litellm sends it all the same.
        dropped.add("temperature")
    if (entry(litellm, model) or {}).get("mode") == "responses":
        dropped |= _NOT_IN_RESPONSES
    kept = {k: v for k, v in wanted.items() if k not in dropped}
    return kept, tuple(k for k in wanted if k in dropped)


def refused(failure: Failure, sent: Iterable[str]) -> tuple[str, ...]:
    """Which of the parameters that were sent a refusal is about: lists, or at least mentions."""
    if failure.status not in (400, 422):
        return ()
    said = f"{failure.about} {failure.words}" if failure.fault == "other" else failure.about
    found = {name for name in sent if re.search(_WORDED[name], said, re.IGNORECASE | re.VERBOSE)}
    if "max_tokens" in sent and failure.fault == "context" and _TOO_MANY.search(failure.words):
        found.add("max_tokens")
    return tuple(sorted(found))


def renamed(failure: Failure) -> bool:
    """Whether the advice is to say `max_completion_tokens` instead of `max_tokens`."""
    return failure.status in (400, 422) and bool(_OTHER_NAME.search(failure.words))


def _mapped(litellm: Any, model: str, wanted: dict[str, Any]) -> dict[str, Any]:
    """The provider's own parameters for these wishes."""
    name, provider, *_ = litellm.get_llm_provider(model)
    mapped: dict[str, Any] = litellm.utils.get_optional_params(
        model=name, custom_llm_provider=provider, drop_params=True, **wanted
    )
    return mapped


def _without(wanted: dict[str, Any], name: str) -> dict[str, Any]:
    return {k: v for k, v in wanted.items() if k != name}
