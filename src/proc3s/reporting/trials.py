"""The samples of one program as columns, and what they say of each step."""

import statistics
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ConfigDict

from proc3s.feedback.report import Diagnosis


class Samples(BaseModel):
    """Equal positions belong to one sample, in the order of their verdicts."""

    model_config = ConfigDict(frozen=True)

    u: tuple[tuple[float, ...], ...] = ()
    accepted: tuple[bool, ...] = ()
    reached: tuple[int, ...] = ()
    violation: tuple[str | None, ...] = ()
    """The constraint that was violated first, or the kind of an error."""
    step: tuple[int | None, ...] = ()
    text: tuple[str | None, ...] = ()
    margin: tuple[float | None, ...] = ()

    @classmethod
    def of(cls, batches: Sequence[Mapping[str, Any]]) -> "Samples":
        """All batches of a program one after another."""
        return cls.model_validate(
            {name: [x for batch in batches for x in batch[name]] for name in cls.model_fields}
        )


class StepReport(BaseModel):
    """Samples that one constraint stopped at one step. Steps count from 0."""

    model_config = ConfigDict(frozen=True)

    step: int | None
    """None for samples that the program itself failed on."""
    skill: str
    constraint: str
    count: int
    share: float
    """Percent of all samples."""
    nearest: float | None
    """The margin of the nearest miss, in the constraint's unit; negative."""
    median: float | None
    """Half of the samples missed by more."""


def by_step(samples: Samples, diagnosis: Diagnosis | None) -> tuple[StepReport, ...]:
    """First violations in the order of the plan; the commonest of a step first."""
    found: defaultdict[tuple[int | None, str], list[float | None]] = defaultdict(list)
    columns = zip(samples.step, samples.violation, samples.margin, strict=True)
    for step, constraint, margin in columns:
        if constraint is not None:
            found[step, constraint].append(margin)
    skills = {f.step: f.skill or "" for f in reversed(diagnosis.failures)} if diagnosis else {}
    reports = [
        _report(place, margins, skills.get(place[0], ""), len(samples.u)) for place, margins in found.items()
    ]
    return tuple(sorted(reports, key=lambda r: (r.step is None, r.step or 0, -r.count, r.constraint)))


def _report(place: tuple[int | None, str], margins: list[float | None], skill: str, total: int) -> StepReport:
    known = [margin for margin in margins if margin is not None]
    return StepReport(
        step=place[0],
        skill=skill,
        constraint=place[1],
        count=len(margins),
        share=round(100 * len(margins) / total, 1),
        nearest=max(known, default=None),
        median=statistics.median(known) if known else None,
    )
