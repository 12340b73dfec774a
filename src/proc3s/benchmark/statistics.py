"""Figures of a benchmark: the cost of each search variant, and its ratio to the plain one, paired by seed."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict

from proc3s.benchmark.measurement import PLAIN, STAGES, Measurement

_RESAMPLES = 2000


class Ratio(BaseModel):
    """A geometric mean over seeds of plain / this, more is better, and its 95 % bootstrap interval.

    `at_least`: the plain path had not found a plan on some seed when its budget was spent, so the true ratio
    is larger.
    """

    model_config = ConfigDict(frozen=True)

    mean: float
    low: float
    high: float
    seeds: int
    at_least: bool = False

    def __str__(self) -> str:
        sign = "≥" if self.at_least else ""
        return f"{sign}{self.mean:.3g} [{self.low:.3g}, {self.high:.3g}]"


class Row(BaseModel):
    """All seeds of a case and a variant. Times are CPU; a stage's are microseconds or seconds by its name."""

    model_config = ConfigDict(frozen=True)

    case: str
    way: str
    seeds: int
    solved: int
    samples: float
    """Median over seeds."""
    evaluations: float
    """Median of the plans that the world was given."""
    us_per_sample: dict[str, float]
    s_per_solution: dict[str, float] | None
    """Total cost, unsolved seeds included, per plan found."""
    samples_per_second: float
    faster_per_sample: Ratio | None = None
    fewer_samples: Ratio | None = None
    """To a solution, over the seeds that are solved."""
    faster_per_solution: Ratio | None = None
    faster_by_the_clock: Ratio | None = None
    """In wall seconds a sample: what more processes bring."""
    errors: tuple[str, ...] = ()
    audited: int = 0
    """Rejects of the screens that were put to the world after all, and how many of them it accepts."""
    wrong: int = 0


def rows(measurements: Sequence[Measurement]) -> list[Row]:
    """One row for every case and variant, in the order in which they were measured."""
    keys = dict.fromkeys((m.case, m.way) for m in measurements)
    return [_row(case, way, measurements) for case, way in keys]


def _row(case: str, way: str, measurements: Sequence[Measurement]) -> Row:
    own = [m for m in measurements if (m.case, m.way) == (case, way)]
    plain = {m.seed: m for m in measurements if (m.case, m.way) == (case, PLAIN.name)}
    samples, solved = sum(m.samples for m in own), sum(m.solved for m in own)
    spent = {stage: sum(m.cpu[stage] for m in own) for stage in STAGES}
    spent["total"] = sum(spent.values())
    compared: dict[str, Any] = {}
    if way != PLAIN.name:
        pairs = [(plain[m.seed], m) for m in own if m.seed in plain]
        wins = [pair for pair in pairs if pair[1].solved]
        compared = {
            "faster_per_sample": _ratio(pairs, lambda m: m.total / max(m.samples, 1)),
            "fewer_samples": _ratio(wins, lambda m: m.samples, solving=True),
            "faster_per_solution": _ratio(wins, lambda m: m.total, solving=True),
            "faster_by_the_clock": _ratio(pairs, lambda m: m.wall / max(m.samples, 1)),
        }
    return Row(
        case=case,
        way=way,
        seeds=len(own),
        solved=solved,
        samples=float(np.median([m.samples for m in own])),
        evaluations=float(np.median([m.evaluations for m in own])),
        us_per_sample={stage: 1e6 * value / max(samples, 1) for stage, value in spent.items()},
        s_per_solution={stage: value / solved for stage, value in spent.items()} if solved else None,
        samples_per_second=samples / sum(m.wall for m in own),
        audited=sum(m.audited for m in own),
        wrong=sum(m.wrong for m in own),
        errors=tuple(dict.fromkeys(m.error for m in own if m.error)),
        **compared,
    )


def _ratio(
    pairs: Iterable[tuple[Measurement, Measurement]],
    cost: Callable[[Measurement], float],
    solving: bool = False,
) -> Ratio | None:
    """Of the costs of pairs (plain, own)."""
    pairs = list(pairs)
    at_least = solving and not all(plain.solved for plain, _ in pairs)
    return geometric([(cost(plain), cost(own)) for plain, own in pairs], at_least)


def geometric(pairs: Sequence[tuple[float, float]], at_least: bool = False) -> Ratio | None:
    """How many times the second of each pair the first is; None without a pair.

    The bootstrap draws pairs with a fixed generator.
    """
    if not pairs:
        return None
    logs = np.log([plain / own for plain, own in pairs])
    drawn = np.random.default_rng(0).choice(logs, (_RESAMPLES, len(logs))).mean(axis=1)
    low, high = np.exp(np.quantile(drawn, [0.025, 0.975])).tolist()
    return Ratio(mean=float(np.exp(logs.mean())), low=low, high=high, seeds=len(pairs), at_least=at_least)
