"""Limits set by `--limit KEY=VALUE`: those of the box, and those of the clock, which only abort a run."""

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError

from proc3s.errors import UsageError, did_you_mean
from proc3s.sandbox.limits import Limits
from proc3s.search.watch import SECONDS

Part = TypeVar("Part", Limits, "ClockLimits")


@dataclass(frozen=True)
class ClockLimits:
    """Wall-clock seconds after which a run is aborted, None for no limit; no verdict depends on them."""

    round: float | None = None
    """From the answers of a round to the end of its search."""
    step: float = SECONDS
    """One step of a plan in a world, its reset, or a judge."""


def make_limits(given: Mapping[str, str]) -> tuple[Limits, ClockLimits]:
    """Box and clock limits with the changes of the command line. Raises UsageError."""
    known = [*_names(Limits), *_names(ClockLimits)]
    for name in given:
        if name not in known:
            raise UsageError(f"there is no limit {name!r}{did_you_mean(name, known)}")
    return _made(Limits, given), _made(ClockLimits, given)


def box_limits(given: Mapping[str, str]) -> dict[str, str]:
    """The box limits alone; they are part of a run's identity, clock limits are not."""
    return {name: value for name, value in given.items() if name in _names(Limits)}


def clock_only(given: Mapping[str, str]) -> dict[str, str]:
    """The clock limits alone; they may change when a run is resumed."""
    return {name: value for name, value in given.items() if name in _names(ClockLimits)}


def _names(part: type[Limits] | type[ClockLimits]) -> list[str]:
    return [field.name for field in dataclasses.fields(part)]


def _made(part: type[Part], given: Mapping[str, str]) -> Part:
    own = {name: value for name, value in given.items() if name in _names(part)}
    try:
        limits = TypeAdapter(part).validate_python(own)
    except ValidationError as error:
        detail = error.errors()[0]
        raise UsageError(f"limit {detail['loc'][0]}: {detail['msg']}, not {detail['input']!r}") from error
    for name in own:
        if not 0 < getattr(limits, name) < math.inf:
            raise UsageError(f"limit {name}: must be above 0 and finite, not {given[name]!r}")
    return limits
