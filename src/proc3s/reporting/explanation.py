"""`proc3s explain`: a run in plain words, and the same as data."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from proc3s.domain.room import Room
from proc3s.reporting.advice import Pointer, of_program, of_run
from proc3s.reporting.history import ProgramRecord, RoundRecord, Story
from proc3s.reporting.room_words import improvement
from proc3s.reporting.templates import ReportTemplates
from proc3s.sandbox.text import clean

_OF_PROGRAM = {
    *("round", "candidate", "ending", "best", "blocks", "parameters", "taken", "evaluations", "rejected_by")
}
_LONGEST = 100_000
"""Characters of an explanation; programs may name things at any length."""


def explain(story: Story, folders: Sequence[Path]) -> str:
    """The run in plain words, round by round, fit for a terminal. The words are in `explain.j2`."""
    return (
        clean(ReportTemplates(folders).render("explain.j2", **explained(story, folders)).strip(), _LONGEST)
        + "\n"
    )


def explained(story: Story, folders: Sequence[Path]) -> dict[str, Any]:
    """The same as data: what `proc3s explain --json` prints and what the template is given."""
    templates = ReportTemplates(folders)
    return {
        "run": str(story.run),
        "task": story.task,
        "seed": story.options.get("seed"),
        "method": story.options.get("method"),
        "goal": story.goal,
        "solved": story.solved,
        "ended": story.summary is not None,
        "error": story.error,
        "samples": sum(program.taken for program in story.programs),
        "rounds": [_round(round_, story, templates) for round_ in story.rounds],
        "executed": _executed(story),
        "look": looks(of_run(story), templates),
    }


def looks(pointers: Sequence[Pointer], templates: ReportTemplates) -> list[dict[str, Any]]:
    """Pointers with their sentences."""
    return [
        {
            "kind": p.kind,
            "text": templates.render("look.j2", kind=p.kind, facts=p.facts).strip(),
            "facts": p.facts,
        }
        for p in pointers
    ]


def _round(round_: RoundRecord, story: Story, templates: ReportTemplates) -> dict[str, Any]:
    return {
        "round": round_.number,
        "origin": round_.completions[0].source if round_.completions else "none",
        "stale": any(completion.stale for completion in round_.completions),
        "notes": list(round_.notes),
        "programs": [_program(program, story, templates) for program in round_.programs],
    }


def _program(program: ProgramRecord, story: Story, templates: ReportTemplates) -> dict[str, Any]:
    diagnosis = program.diagnosis
    return {
        **program.model_dump(mode="json", include=_OF_PROGRAM),
        "file": program.file if program.source is not None else None,
        "diagnosis": diagnosis.model_dump(mode="json") if diagnosis else None,
        "steps": [report.model_dump(mode="json") for report in program.steps],
        "nearest": program.nearest,
        "change": program.change.model_dump(mode="json") if program.change else None,
        "look": looks(of_program(program, story), templates),
    }


def _executed(story: Story) -> dict[str, Any] | None:
    if story.executed is None:
        return None
    told = {name: value for name, value in story.executed.items() if name not in ("event", "time")}
    room, improved = told.get("room"), (story.summary or {}).get("improved")
    return told | {
        "room_words": str(Room(**room)) if room else None,
        "improved": improvement(improved) if improved else None,
    }
