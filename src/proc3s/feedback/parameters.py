"""Which parameters tell the better samples of a round from the worse."""

from collections.abc import Iterator, Sequence

import numpy as np
from pydantic import BaseModel, ConfigDict

from proc3s.domain.samplers import ContinuousSampler, Space
from proc3s.domain.values import FloatArray
from proc3s.search.trial import Trial

_FEWEST_SAMPLES = 40
_BEST_SHARE = 0.1
FEWEST_BEST = 8
"""With fewer samples nothing is told apart."""
DISTANCE = 0.4
"""Kolmogorov-Smirnov distance above which two distributions of a parameter are told apart."""
_EDGE = 0.08
"""The best samples press against a bound when their median lies in this outermost part of the range."""
_MOST = 3


class Separation(BaseModel):
    """The samples that got furthest have this parameter between `low` and `high`."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    parameter: str
    """Its name in `gen_domain`."""
    low: float
    """In the parameter's unit."""
    high: float
    """In the parameter's unit."""


class BoundHit(BaseModel):
    """The samples that got furthest press against a bound of this parameter."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    parameter: str
    """Its name in `gen_domain`."""
    bound: float
    """In the parameter's unit."""
    side: str
    """`lower` or `upper`."""


def separations(trials: Sequence[Trial], space: Space) -> tuple[Separation, ...]:
    """At most three, the clearest first. None where few samples failed or all got equally far."""
    found = []
    for distance, name, sampler, best in _separating(trials, space):
        low, high = (value_at(sampler, q) for q in np.quantile(best, (0.05, 0.95)))
        found.append((-distance, Separation(parameter=name, low=low, high=high)))
    return tuple(separation for _, separation in sorted(found, key=lambda item: item[0])[:_MOST])


def bound_hits(trials: Sequence[Trial], space: Space) -> tuple[BoundHit, ...]:
    """Bounds that a wider `gen_domain` might profit from moving."""
    hits = []
    for _, name, sampler, best in _separating(trials, space):
        middle = float(np.median(best))
        if middle < _EDGE:
            hits.append(BoundHit(parameter=name, bound=value_at(sampler, 0.0), side="lower"))
        elif middle > 1 - _EDGE:
            hits.append(BoundHit(parameter=name, bound=value_at(sampler, 1.0), side="upper"))
    return tuple(hits)


def _separating(
    trials: Sequence[Trial], space: Space
) -> Iterator[tuple[float, str, ContinuousSampler, FloatArray]]:
    """(distance, name, sampler, u of the best samples) of every number that tells best from rest."""
    scored = [(t.reached, t.violations[0].margin) for t in trials if t.violations]
    if len(scored) < _FEWEST_SAMPLES or len(set(scored)) == 1:
        return
    order = sorted(range(len(scored)), key=lambda i: scored[i], reverse=True)
    best_count = max(FEWEST_BEST, int(_BEST_SHARE * len(order)))
    u = np.array([t.u for t in trials if t.violations])[order]
    at = 0
    for name, sampler in space.samplers.items():
        best, rest = u[:best_count, at], u[best_count:, at]
        at += sampler.dim
        if isinstance(sampler, ContinuousSampler) and (apart := distance(best, rest)) > DISTANCE:
            yield apart, name, sampler, best


def distance(a: FloatArray, b: FloatArray) -> float:
    """Kolmogorov-Smirnov distance of two samples."""
    grid = np.concatenate([a, b])
    below_a = np.searchsorted(np.sort(a), grid, side="right") / len(a)
    below_b = np.searchsorted(np.sort(b), grid, side="right") / len(b)
    return float(np.max(np.abs(below_a - below_b)))


def value_at(sampler: ContinuousSampler, u: float) -> float:
    """The parameter's value, to three digits: enough to act on, and stable."""
    return float(f"{sampler.decode(np.array([[u]]))[0, 0]:.3g}")
