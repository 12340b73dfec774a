"""In which samples a program failed: the parameters that tell them from the others, or those of one."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from proc3s.domain.samplers import ContinuousSampler, DiscreteSampler, Space
from proc3s.domain.values import FloatArray
from proc3s.feedback.parameters import DISTANCE, FEWEST_BEST, distance, value_at
from proc3s.search.trial import Trial

_MOST, _MOST_SHOWN = 3, 6


def circumstances(failed: Sequence[Trial], others: Sequence[Trial], space: Space) -> str:
    """Words such as "with `x` between 1 and 60"; "" where all samples failed so, or none has parameters."""
    if not others or not space.dim:
        return ""
    one, rest = np.array([t.u for t in failed]), np.array([t.u for t in others])
    told = [text for _, text in sorted(_telling(one, rest, space), key=lambda found: -found[0])][:_MOST]
    if told:
        return f"with {' and '.join(told)}"
    shown = [f"`{name}` = {value!r}" for name, value in _values(failed[0].u, space)][:_MOST_SHOWN]
    return f"for example with {', '.join(shown)}" if shown else ""


def _telling(one: FloatArray, rest: FloatArray, space: Space) -> Iterator[tuple[float, str]]:
    """(distance, words) of every parameter whose values there are others than in the rest."""
    at = 0
    for name, sampler in space.samplers.items():
        here, there = one[:, at], rest[:, at]
        at += sampler.dim
        if min(len(here), len(there)) < FEWEST_BEST:
            continue
        if isinstance(sampler, ContinuousSampler) and (apart := distance(here, there)) > DISTANCE:
            low, high = (value_at(sampler, u) for u in (float(here.min()), float(here.max())))
            yield apart, f"`{name}` between {low} and {high}"
        elif isinstance(sampler, DiscreteSampler):
            chosen = {_choice(sampler, u) for u in here.tolist()}
            if chosen.isdisjoint(_choice(sampler, u) for u in there.tolist()):
                yield 1.0, f"`{name}` {', '.join(repr(sampler.values[i]) for i in sorted(chosen))}"


def _values(u: Sequence[float], space: Space) -> Iterator[tuple[str, Any]]:
    at = 0
    for name, sampler in space.samplers.items():
        if isinstance(sampler, ContinuousSampler):
            yield name, value_at(sampler, u[at])
        elif isinstance(sampler, DiscreteSampler):
            yield name, sampler.values[_choice(sampler, u[at])]
        at += sampler.dim


def _choice(sampler: DiscreteSampler, u: float) -> int:
    return int(sampler.decode(np.array([[u]]))[0, 0])
