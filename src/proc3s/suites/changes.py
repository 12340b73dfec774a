"""What has changed between two runs of a suite, in sentences."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from proc3s.errors import Proc3sError
from proc3s.llm.types import digest
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import first_messages
from proc3s.plugins.registry import Registry
from proc3s.suites.episode import Episode


def changes(
    registry: Registry, before: Mapping[str, Any], now: Mapping[str, Any], episodes: Sequence[Episode]
) -> Iterator[str]:
    """Differences in the suite, its options, the installed versions and the prompts since it began."""
    spec, changed = now["spec"], before.get("spec", {})
    if names := sorted(name for name in spec if spec[name] != changed.get(name)):
        yield f"the suite is not as it was: {', '.join(names)} changed"
    if (before.get("llm"), before.get("llm_options")) != (now["llm"], now["llm_options"]):
        yield f"the language model was {before.get('llm')}, now it is {now['llm']}, or has other options"
    if before.get("arguments") != now["arguments"]:
        yield f"the options were {before.get('arguments')}, now they are {now['arguments']}"
    old, new = before.get("versions", {}), now["versions"]
    other = [f"{n} {old.get(n)} -> {new.get(n)}" for n in sorted({*old, *new}) if old.get(n) != new.get(n)]
    if other:
        yield f"other versions are installed: {', '.join(other)}"
    if prompts := list(changed_prompts(registry, episodes)):
        yield f"these prompts are not as they were: {', '.join(prompts)}"


def changed_prompts(registry: Registry, episodes: Sequence[Episode]) -> Iterator[str]:
    """Task, method and preset of the prompts that would be others today; one of each is looked at."""
    looked: set[tuple[str, str, str]] = set()
    for episode in episodes:
        kind = (episode.task, episode.method, episode.preset)
        if kind not in looked and episode.prompt_sha256 is not None:
            looked.add(kind)
            if _prompt(registry, episode) != episode.prompt_sha256:
                yield " ".join(kind)


def _prompt(registry: Registry, episode: Episode) -> str | None:
    """SHA-256 of what would be asked today; None if nothing could be."""
    place = episode.model_dump(include={"task", "method", "preset", "seed"})
    options = RunOptions.model_validate(place)
    try:
        return digest(first_messages(registry, options))
    except Proc3sError:
        return None
