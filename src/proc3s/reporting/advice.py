"""Where a person would look: places that the diagnosis of a run points at. The words are in `look.j2`."""

from collections import defaultdict
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel, ConfigDict

from proc3s.feedback.report import Diagnosis, Failure
from proc3s.reporting.history import ProgramRecord, Story
from proc3s.runs.pictures import pictures_of, undrawn

_HOPEFUL = 10
"""How many times the budget a search that gets further now and then is given on trial."""


_ALIKE = 1.05
"""Misses that differ by no more than this factor are one."""


class Pointer(BaseModel):
    """A place to look at: `kind` says why, `facts` which one."""

    model_config = ConfigDict(frozen=True)

    kind: str
    facts: dict[str, Any]


def of_program(program: ProgramRecord, story: Story) -> tuple[Pointer, ...]:
    """Places that the failures of one program point at, the most certain first."""
    diagnosis = program.diagnosis
    if diagnosis is None or program.ending == "solved":
        return ()
    always = _always(diagnosis)
    numbers = [] if always and _by_name_alone(program) else list(_numbers(diagnosis, program))
    found = [*_errors(diagnosis), *numbers]
    if always:
        if not numbers:
            found.append(Pointer(kind="always", facts=always.model_dump()))
    elif program is story.programs[-1] and _hopeful(diagnosis, story):  # the one that replay takes
        found.append(Pointer(kind="more_samples", facts={"samples": _HOPEFUL * diagnosis.samples}))
    if any(report.constraint == "goal" for report in diagnosis.constraints):
        found.append(Pointer(kind="goal", facts={}))
    if program.audited and program.audited[1]:
        found.append(
            Pointer(kind="screens", facts={"checked": program.audited[0], "wrong": program.audited[1]})
        )
    given = {"file": program.file if program.source is not None else "the answer", "run": str(story.run)}
    return tuple(Pointer(kind=p.kind, facts={**p.facts, **given}) for p in found)


def _errors(diagnosis: Diagnosis) -> Iterator[Pointer]:
    for failure in (*diagnosis.program_errors, *(f for f in diagnosis.failures if f.step is None)):
        yield Pointer(kind="error", facts=failure.model_dump())


def _always(diagnosis: Diagnosis) -> Failure | None:
    """The one way in which every sample failed, if it is at one step."""
    at_steps = [failure for failure in diagnosis.failures if failure.step is not None]
    places = {(failure.step, failure.kind) for failure in diagnosis.failures}
    alone = len(places) == 1 and at_steps and at_steps[0].skill != "goal"
    return at_steps[0] if alone and diagnosis.samples > 1 else None


def _by_name_alone(program: ProgramRecord) -> bool:
    """Whether the size of a miss depends only on the object that is named, not on any number."""
    missed: defaultdict[str, list[float]] = defaultdict(list)
    for text, margin in zip(program.samples.text, program.samples.margin, strict=True):
        if text is not None and margin is not None:
            missed[text].append(margin)
    return len(missed) > 1 and all(min(m) >= _ALIKE * max(m) for m in missed.values())


def _numbers(diagnosis: Diagnosis, program: ProgramRecord) -> Iterator[Pointer]:
    pressed = {hit.parameter for hit in diagnosis.bound_hits}
    for separation in diagnosis.separations:
        if separation.parameter in pressed:
            continue  # its best values lie beyond the bound
        now = program.parameters.get(separation.parameter, "")
        yield Pointer(kind="narrow", facts={**separation.model_dump(), "now": now})
    for hit in diagnosis.bound_hits:
        yield Pointer(kind="widen", facts=hit.model_dump())


def _hopeful(diagnosis: Diagnosis, story: Story) -> bool:
    """The samples were used up, and did not all fail at the first step."""
    return bool(diagnosis.reached and diagnosis.samples > 1 and diagnosis.samples >= (story.budget or 0))


def of_run(story: Story) -> tuple[Pointer, ...]:
    """Places that the end of the run points at."""
    facts = {"run": str(story.run)}
    found: list[Pointer] = []
    if story.summary is None or story.error:
        known = story.options.get("llm") is not None and bool(story.rounds)
        found.append(Pointer(kind="resume" if known else "repeat", facts=facts))
    if executed := story.executed:
        found += [Pointer(kind=kind, facts={**facts, **executed}) for kind in _of_execution(executed)]
    pictures, more = [path.name for path in pictures_of(story.run)], undrawn(story.run)
    if pictures or more:
        found.append(Pointer(kind="pictures", facts={**facts, "pictures": pictures, "undrawn": more}))
    return tuple(found)


def _of_execution(executed: dict[str, Any]) -> Iterator[str]:
    if executed["executed"] == "fallback":
        yield "fallback"
    if executed["goal_reached"] is None:
        yield "not_judged"
    elif not executed["goal_reached"]:
        yield "execution" if executed.get("goal_expected") else "missed"
