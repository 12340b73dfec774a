"""One row of a suite's results: what one method did with one task and one seed."""

from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

from proc3s.feedback.report import Diagnosis
from proc3s.llm.budget import Spent
from proc3s.llm.types import Completion
from proc3s.planning.summary import Summary
from proc3s.runs.reading import read_events
from proc3s.specs.suite import Cell


class Episode(BaseModel):
    """A finished episode; task, method, preset and seed tell it from the others."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    task: str
    """`domain/task`."""
    method: str
    """The method."""
    preset: str
    """The preset."""
    seed: int
    """Seed of the scene and of the search."""
    llm: str | None = None
    """The language model as `--llm` names it."""
    source: Literal["live", "recorded", "authored", "manual", "none"] = "none"
    """Where the answers are from; no success rate is made of authored ones."""
    stale: bool = False
    """An answer was given to another prompt than that of the episode; such episodes have a table of their
    own."""
    model: str | None = None
    """The model as the provider names it."""
    answered: str | None = None
    """When the first answer was given, ISO 8601; null if unknown."""
    prompt_sha256: str | None = None
    """Of the first prompt."""
    dropped: tuple[str, ...] = ()
    """Sampling options that the provider did not take, e.g. seed, temperature."""
    solved: bool = False
    """The world accepted a plan."""
    executed: Literal["solution", "fallback", "none"] = "none"
    """Which plan was carried out."""
    goal_reached: bool | None = None
    """The judge's verdict; null without a judge or without a plan."""
    goal_reason: str | None = None
    """Why the judge says so."""
    failure: str | None = None
    """The commonest failure of its last program, where no plan was accepted."""
    judged: bool = False
    """The task has a judge."""
    rounds: int = 0
    """Feedback rounds."""
    samples: int = 0
    """Parameter vectors with a verdict over all rounds."""
    seconds: dict[str, float] = {}
    """Wall seconds: llm, solve, execute, total."""
    cpu_seconds: dict[str, float] = {}
    """CPU seconds, the same keys."""
    llm_seconds: float | None = None
    """Seconds that the provider took; for recorded answers, when they were recorded."""
    prompt_tokens: int | None = None
    """Of all calls; null if unknown."""
    completion_tokens: int | None = None
    """Of all calls; null if unknown."""
    cost: float | None = None
    """US dollars of all calls; null if unknown."""
    violations: dict[str, int] = {}
    """How many samples failed first by each constraint or kind of error."""
    program_errors: int = 0
    """Programs that could not be used."""
    error: str | None = None
    """Always null; earlier versions kept episodes that could not be carried out, with the reason here."""
    run_dir: str = ""
    """The run folder, relative to that of the suite."""

    @property
    def cell(self) -> Cell:
        """Its place in the matrix."""
        return Cell(self.task, self.method, self.preset, self.seed)


def episode_of(cell: Cell, summary: Summary, run: Path, run_dir: str, judged: bool) -> Episode:
    """The row of a run that came to its end."""
    events = read_events(run) if run.is_dir() else []
    answers = [e for e in events if e["event"] == "answer_received"]
    completions = [Completion.model_validate(e["completion"]) for e in answers]
    first = completions[0] if completions else None
    live = bool(first and first.source == "live")
    prompts = [e["sha256"] for e in events if e["event"] == "prompt_rendered"]
    by_model = summary.llm_source in ("live", "recorded")
    given = Spent(
        prompt_tokens=None,
        completion_tokens=None,
        cost=None if summary.llm_source == "manual" else 0.0,  # a stale answer may have been paid for
        latency=None,
    )
    usage = summary.usage if by_model else given
    return Episode(
        **cell._asdict(),
        **summary.model_dump(
            include={
                *("llm", "stale", "solved", "executed", "goal_reached", "goal_reason"),
                *("rounds", "samples"),
            }
        ),
        source=summary.llm_source,
        model=first.model if first else None,
        answered=(answers[0]["time"] if live else first.answered) if first else None,
        prompt_sha256=prompts[0] if prompts else None,
        dropped=tuple(sorted({name for c in completions for name in c.dropped})),
        failure=None if summary.solved else _failure(events),
        judged=judged,
        seconds=summary.seconds,
        cpu_seconds=summary.cpu_seconds,
        llm_seconds=usage.latency,
        prompt_tokens=usage.prompt_tokens,
        completion_tokens=usage.completion_tokens,
        cost=usage.cost,
        violations=_violations(events),
        program_errors=_count(events, "program_extracted") - _count(events, "sketch_loaded"),
        run_dir=run_dir,
    )


def _failure(events: list[dict[str, Any]]) -> str | None:
    """What most samples of the last round failed by; `round_ended` tells of its best program."""
    ended = [event["diagnosis"] for event in events if event["event"] == "round_ended"]
    failure = Diagnosis.model_validate(ended[-1]).commonest if ended else None
    return failure.told if failure else None


def _count(events: list[dict[str, Any]], name: str) -> int:
    return sum(event["event"] == name for event in events)


def _violations(events: list[dict[str, Any]]) -> dict[str, int]:
    """First violations of all samples, by constraint."""
    counts: dict[str, int] = {}
    for event in events:
        if event["event"] == "batch_evaluated":
            for name in event["violation"]:
                if name is not None:
                    counts[name] = counts.get(name, 0) + 1
    return counts
