"""The checks of a domain, in the order in which an author should read what they find."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

from pydantic import BaseModel, ConfigDict

from proc3s.checks import judging, reading, stepping
from proc3s.checks.fault import Fault, located
from proc3s.checks.subject import Subject, explain
from proc3s.errors import blame

Run: TypeAlias = Callable[[Subject], Iterator[Fault]]


@dataclass(frozen=True)
class Check:
    """What is checked, why it matters, and how to fix it."""

    name: str
    why: str
    mend: str
    run: Run


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
        "prompts",
        "the model reads what is rendered",
        "correct the template, the preface or the example that is named",
        reading.prompts,
    ),
    Check(
        "programs",
        "bundled programs are what users run first, and what models imitate",
        "run it by `proc3s solve TASK --sketch FILE` and correct what it says",
        judging.programs,
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
        "judges",
        "a judge that the untouched scene satisfies judges nothing",
        "require what the instruction asks for",
        judging.judges,
    ),
)


def examine(subject: Subject) -> Iterator[tuple[Check, list[CheckFinding], float]]:
    """Every check with its findings and the seconds it took; an exception in a check is its finding."""
    for check in CHECKS:
        began = time.monotonic()
        yield check, findings(check, subject), time.monotonic() - began


def findings(check: Check, subject: Subject) -> list[CheckFinding]:
    """What one check finds."""
    found: list[Fault] = []
    try:
        with blame(check.name, Exception):  # a domain's function may raise anything
            found += check.run(subject)
    except Exception as error:
        found.append(Fault(explain(error)))
    return [
        CheckFinding(
            level="error" if fault.error else "note",
            check=check.name,
            text=fault.text,
            where=located(fault.where) or subject.file,
            why=check.why,
            mend=fault.mend or check.mend,
        )
        for fault in found
    ]
