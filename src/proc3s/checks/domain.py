"""The checks of a domain, in the order in which an author should read what they find."""

import re
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from pydantic import BaseModel, ConfigDict

from proc3s.checks import judging, reading, stepping
from proc3s.checks.fault import Fault, NotCheckedError, located
from proc3s.checks.subject import Subject
from proc3s.errors import Proc3sError, SpecError, blame

Run: TypeAlias = Callable[[Subject], Iterator[Fault]]


@dataclass(frozen=True)
class Check:
    """What is checked, why it matters, and how to fix it."""

    name: str
    why: str
    mend: str
    run: Run
    needs: tuple[str, ...] = ()
    """Checks whose errors would show here again."""


class CheckFinding(BaseModel):
    """One thing that is wrong, or worth knowing, about a domain."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    level: str
    """`error` or `note`."""
    check: str
    """The check that found it."""
    text: str
    """What is wrong."""
    where: str
    """`file:line` where there is one."""
    why: str
    """Why it matters."""
    mend: str
    """How to fix it."""


@dataclass(frozen=True)
class Checked:
    """What a check found; `unchecked` says why it was not made, or not made to its end."""

    check: Check
    findings: tuple[CheckFinding, ...]
    unchecked: str
    seconds: float


RAISED_WHY = "what the domain's code raises ends the run, or the check, that meets it"
RAISED_MEND = "correct what is named"
CHECKS: tuple[Check, ...] = (
    Check(
        "targets",
        "what cannot be imported fails in the middle of a run",
        "correct the `target`, or install the package that it names",
        reading.targets,
    ),
    Check(
        "scenes",
        "a benchmark is repeated by its seeds: a seed is one scene, and another seed another",
        "draw every number from the generator that the scene is given, and bound its attempts",
        reading.scenes,
    ),
    Check(
        "states",
        "states cross to the program's box and into logs as JSON, and come back",
        "keep to the fields that the types declare; numbers must be finite",
        reading.states,
    ),
    Check(
        "models",
        "plans are worth what the world's models of bodies are worth",
        "make the model finer",
        reading.models,
    ),
    Check(
        "prompts",
        "the model reads what is rendered",
        "correct the template, the preface or the example that is named",
        reading.prompts,
    ),
    Check(
        "judges",
        "a judge that the untouched scene satisfies judges nothing",
        "require what the instruction asks for",
        judging.judges,
    ),
    Check(
        "skills",
        "a skill that no bundled plan uses is not tested by anything",
        "use it in an example or a bundled answer",
        stepping.skills,
    ),
    Check(
        "refusals",
        "models invent skills and forget arguments; they must be told",
        "declare the types and ranges of the parameters in the skill's `params`",
        stepping.refusals,
    ),
    Check(
        "steps",
        "the same plan must get the same verdict in every process, order and number of workers",
        "keep no state in the world but what `save` returns; take no clocks, no global random numbers",
        stepping.deterministic,
    ),
    Check(
        "snapshots",
        "beginnings of plans are remembered: a step from a snapshot must equal that of a replayed plan",
        "save everything that later steps depend on, and restore it exactly in `load`",
        stepping.snapshots,
        needs=("steps",),
    ),
    Check(
        "margins",
        "the diagnosis ranks failures by margins, and solvers climb along them",
        "return finite numbers, negative where the constraint is violated, in the constraint's unit",
        stepping.margins,
    ),
    Check(
        "screens",
        "a screen that rejects what the world accepts throws solutions away",
        "reject only outside a band of uncertainty, and look at every plan by itself",
        stepping.screens,
    ),
    Check(
        "programs",
        "bundled programs are what users run first, and what models imitate",
        "correct the program; its scene is that of the example",
        judging.programs,
        needs=("steps", "snapshots", "screens"),
    ),
)


def examine(subject: Subject) -> Iterator[Checked]:
    """Every check, and what it found."""
    for check in CHECKS:
        yield examine_one(check, subject)


def examine_one(check: Check, subject: Subject) -> Checked:
    """Carry out one check of a subject, after those that it needs.

    An exception of the domain's code is a finding of the first check that meets it; the others are not made.
    """
    began = time.monotonic()
    found: list[Fault] = []
    unchecked = next((f"see {name}" for name in ("targets", *check.needs) if name in subject.wrong), "")
    try:
        if not unchecked:
            with blame(check.name, NotCheckedError):
                for fault in check.run(subject):
                    found.append(fault)
    except NotCheckedError as reason:
        unchecked = str(reason)
    except Proc3sError as error:
        raised = list(_raised(error))
        known = {subject.causes[_key(fault)] for fault in raised if _key(fault) in subject.causes}
        if known - {check.name}:
            unchecked = f"see {min(known - {check.name})}"
        else:
            found += raised
            subject.causes |= {_key(fault): check.name for fault in raised}
    if any(fault.error for fault in found):
        subject.wrong.add(check.name)
    findings = tuple(_finding(check, fault, subject) for fault in found)
    return Checked(check, findings, unchecked, time.monotonic() - began)


def _raised(error: Proc3sError) -> Iterator[Fault]:
    """What the domain's code raised, with its place."""
    for issue in error.issues if isinstance(error, SpecError) else ():
        yield Fault(f"{issue.field}: {issue.message}", issue.where, RAISED_MEND, why=RAISED_WHY)
    if not isinstance(error, SpecError):
        yield Fault(str(error), mend=RAISED_MEND, why=RAISED_WHY)


def _key(fault: Fault) -> str:
    """The same for an exception of one type at one line, whoever met it, and whatever the values are."""
    kind = re.search(r"raised (\w+)", fault.text)
    return f"{fault.where} {kind[1]}" if kind else f"{fault.where} {fault.text}"


def _where(place: str, subject: Subject) -> str:
    """A file with its line; where that is not known, the domain's file, and the part of it."""
    if re.search(r":\d+$", place) or Path(place).is_file():
        return place
    return f"{place} in {subject.file}" if place else subject.file


def _finding(check: Check, fault: Fault, subject: Subject) -> CheckFinding:
    return CheckFinding(
        level="error" if fault.error else "note",
        check=check.name,
        text=fault.text,
        where=_where(located(fault.where), subject),
        why=fault.why or check.why,
        mend=fault.mend or check.mend,
    )
