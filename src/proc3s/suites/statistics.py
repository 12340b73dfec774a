"""The few statistics of the tables, in closed form; the tests compare them with scipy's."""

import math
import statistics
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

LEVEL = 0.95
"""Of all intervals."""
_Z = statistics.NormalDist().inv_cdf(0.5 + LEVEL / 2)

ALPHA = 0.1
"""Level of the paper's one-tailed test."""

_RESAMPLES = 10_000


class Estimate(NamedTuple):
    """A figure and the ends of its interval."""

    value: float
    low: float
    high: float


def wilson(successes: int, trials: int) -> Estimate:
    """A proportion with Wilson's score interval (Wilson 1927). Raises ValueError without trials."""
    if trials <= 0:
        raise ValueError("a proportion needs trials")
    share, square = successes / trials, _Z**2
    middle = (share + square / (2 * trials)) / (1 + square / trials)
    half = _Z / (1 + square / trials) * math.sqrt(share * (1 - share) / trials + square / (4 * trials**2))
    return Estimate(share, min(share, max(0.0, middle - half)), max(share, min(1.0, middle + half)))


def worse(successes: int, trials: int, best: int, of: int) -> float:
    """p of the one-tailed two-proportion z-test that the first proportion is less than the second.

    Pooled variance, as in the paper's tables; 0.5 where both are all or nothing.
    """
    pooled = (successes + best) / (trials + of)
    spread = math.sqrt(pooled * (1 - pooled) * (1 / trials + 1 / of))
    if spread == 0:
        return 0.5
    return statistics.NormalDist().cdf((successes / trials - best / of) / spread)


def mean_std(values: Sequence[float]) -> tuple[float, float]:
    """Mean and sample standard deviation; the deviation of one value is 0."""
    return statistics.fmean(values), statistics.stdev(values) if len(values) > 1 else 0.0


def paired_proportions(pairs: Sequence[tuple[bool, bool]]) -> Estimate:
    """How much more often the second of a pair succeeds, with the adjusted Wald interval of Bonett and
    Price (2012). Raises ValueError without pairs."""
    if not pairs:
        raise ValueError("a difference needs pairs")
    n = len(pairs)
    won = sum(second and not first for first, second in pairs)
    lost = sum(first and not second for first, second in pairs)
    p, q = (won + 1) / (n + 2), (lost + 1) / (n + 2)
    half = _Z * math.sqrt((p + q - (p - q) ** 2) / (n + 2))
    return Estimate((won - lost) / n, max(-1.0, p - q - half), min(1.0, p - q + half))


def paired_means(differences: Sequence[float]) -> Estimate:
    """A mean difference with the percentile interval of a bootstrap, always with the same draws."""
    values = np.array(differences, float)
    drawn = np.random.default_rng(0).choice(values, (_RESAMPLES, len(values)))
    low, high = np.quantile(drawn.mean(axis=1), [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return Estimate(float(values.mean()), float(low), float(high))
