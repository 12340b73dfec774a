"""What a person sees of a run: progress on stderr while it samples, then a short result."""

import sys
from pathlib import Path
from types import TracebackType

from rich.console import Console as RichConsole
from rich.markup import escape

from proc3s.cli.console.lines import print_line
from proc3s.domain.values import Action
from proc3s.feedback.report import Diagnosis
from proc3s.feedback.shares import portion
from proc3s.llm.budget import Spent
from proc3s.llm.types import Completion
from proc3s.planning.options import RunOptions
from proc3s.planning.summary import Summary
from proc3s.reporting.progress import SearchProgress
from proc3s.reporting.room_words import room_lines
from proc3s.runs.events import (
    AnswerReceived,
    Audited,
    CallFailed,
    Event,
    ProgramExtracted,
    PromptRendered,
    RoundEnded,
    SketchLoaded,
    Undrawn,
    Warned,
)
from proc3s.runs.pictures import NEAREST_MISS
from proc3s.wording import count

_ORIGIN = {
    "authored": "an authored answer (written by hand, not by a model)",
    "recorded": "a recorded answer",
    "manual": "an answer given by hand",
    "live": "an answer",
}
_LOST = {
    "seed": ": this run cannot be reproduced",
    "temperature": ": answers may vary",
    "n": ": candidates are asked for one by one",
}
"""What goes with a parameter that the provider does not take."""


class Console:
    """Progress is shown only on a terminal; `quiet` prints nothing but errors.

    `samples` is how many a round may take.
    """

    def __init__(self, options: RunOptions, samples: int, quiet: bool) -> None:
        self._options = options
        self._samples = samples
        self._quiet = quiet
        self._err = RichConsole(stderr=True, quiet=quiet, highlight=False, soft_wrap=True)
        self._progress = SearchProgress(samples, self._err, shown=not quiet and sys.stderr.isatty())
        self._lost: set[str] = set()

    def __enter__(self) -> "Console":
        self._progress.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.__exit__(kind, error, trace)

    def update(self, event: Event) -> None:
        """Show what an event says."""
        self._progress.update(event)
        if isinstance(event, PromptRendered):
            size = sum(len(message.text) for message in event.messages)
            self.say(f"round {event.round}: asking {self._options.llm} ({size} characters)")
        elif isinstance(event, CallFailed):
            self.say(f"round {event.round}: {event.message}; trying again in {event.wait:.1f} s")
        elif isinstance(event, Undrawn):
            self.say(event.text)
        elif isinstance(event, Warned):
            self.say(f"round {event.round}: {event.text}")
        elif isinstance(event, AnswerReceived):
            self._answered(event.round, event.completion)
        elif isinstance(event, ProgramExtracted) and event.blocks:
            self.say(f"round {event.round}: the program is {event.blocks} in the answer")
        elif isinstance(event, SketchLoaded):
            self._loaded(event)
        elif isinstance(event, Audited):
            self.say(f"round {event.round}: audit: {len(event.wrong)} of {event.checked} rejects were wrong")
        elif isinstance(event, RoundEnded):
            self._diagnosis(event.round, event.diagnosis)

    def _answered(self, round_: int, completion: Completion) -> None:
        source, count = completion.source, len(completion.candidates)
        whose = "" if source == "authored" else f" from {completion.model}"
        many = f", {count} candidates" if count > 1 else ""
        self.say(f"round {round_}: {_ORIGIN.get(source, 'an answer')}{whose}{many}{_cost(completion)}")
        for name in completion.dropped:
            if name not in self._lost:
                self.say(f"round {round_}: {completion.model} does not support {name}{_LOST.get(name, '')}")
        self._lost.update(completion.dropped)
        for note in completion.notes:
            self.say(f"round {round_}: {note}")

    def say(self, text: str) -> None:
        """A line on stderr."""
        print_line(self._err, escape(text))

    def _loaded(self, event: SketchLoaded) -> None:
        listed = ", ".join(event.parameters)
        shown = listed if len(listed) <= 100 else f"{listed[:100]}…"
        number = (
            f"with {count(len(event.parameters), 'open parameter')}" if listed else "without open parameters"
        )
        self.say(f"round {event.round}: a program {number} {shown}".rstrip())

    def _diagnosis(self, round_: int, diagnosis: Diagnosis) -> None:
        self.say(f"round {round_}: no plan was accepted ({_samples(diagnosis.samples)})")
        if diagnosis.alike:
            self.say(f"  no more were drawn: all of the first {diagnosis.samples} raised the same exception")
        for failure in (*diagnosis.program_errors, *diagnosis.failures)[:3]:
            self.say(f"  {portion(failure.share):>5}  {failure.told}")

    def result(self, summary: Summary) -> None:
        """The outcome in a few lines on stdout."""
        if self._quiet:
            return
        out = RichConsole(highlight=False, soft_wrap=True)
        print_line(out, _headline(summary))
        if summary.error is None or summary.solved:
            print_line(out, escape(f"goal     {_goal(summary)}"))
        if self._options.world_options:
            chosen = ", ".join(f"{name} {value}" for name, value in summary.world.items())
            print_line(out, escape(f"world    {chosen}"))
        if summary.samples:
            rounds = count(summary.rounds + 1, "round")
            print_line(out, f"samples  {summary.samples} in {rounds}, {_times(summary)}")
        elif summary.seconds:
            print_line(out, f"time     {_times(summary)}; no sample was drawn")
        for line in room_lines(summary.room, summary.improved):
            print_line(out, escape(line))
        for screen, rejected in summary.rejected_by.items():
            if rejected:
                print_line(out, f"screen   {screen} rejected {rejected}")
        if summary.usage.calls:
            print_line(out, f"answers  {_spent(summary.usage)}")
        if summary.llm_source == "authored":
            print_line(out, "answer   authored (written by hand, not by a model)")
        if summary.stale:
            print_line(out, "answer   stale (given to another prompt than that of this run)")
        for step, action in enumerate(summary.plan or []):
            print_line(out, escape(f"  {step:2d}  {Action.from_json(action)}"))
        for violation in summary.violations[:5]:
            print_line(out, escape(f"  violated at step {violation['step']}: {violation['text']}"))
        miss = Path(summary.run_dir or "") / NEAREST_MISS
        if not summary.solved and miss.is_file():
            print_line(out, escape(f"nearest  {_nearest(summary)}"))
            out.print(escape(f"picture  {miss}"))
        out.print(escape(f"folder   {summary.run_dir}"))


def _nearest(summary: Summary) -> str:
    """What the plan that came furthest violates; the same as is below its picture."""
    violations = summary.nearest["violations"] if summary.nearest else summary.violations
    return "; ".join(f"step {v['step']} ({v['skill']}): {v['text']}" for v in violations[:1])


def _spent(spent: Spent) -> str:
    tokens = "unknown" if spent.prompt_tokens is None or spent.completion_tokens is None else None
    tokens = tokens or f"{spent.prompt_tokens:,} + {spent.completion_tokens:,}"
    cost = "unknown" if spent.cost is None else f"${spent.cost:.4f}"
    return f"{count(spent.calls, 'call')}, tokens {tokens}, cost {cost}"


def _cost(completion: Completion) -> str:
    """What an answer cost, as far as it is known."""
    usage = completion.usage
    known = (
        f"{usage.prompt_tokens:,} + {usage.completion_tokens:,} tokens"
        if usage.prompt_tokens is not None and usage.completion_tokens is not None
        else "",
        f"${completion.cost:.4f}" if completion.cost is not None else "",
        f"{completion.latency:.1f} s" if completion.latency is not None else "",
    )
    text = ", ".join(part for part in known if part)
    return f" ({text})" if text else ""


def _samples(number: int) -> str:
    return count(number, "sample") if number else "no sample was drawn"


def _headline(summary: Summary) -> str:
    if summary.error is not None and not summary.solved:
        return f"[bold red]stopped[/]  {summary.task} (seed {summary.seed})"
    if summary.solved:
        steps = count(len(summary.plan or []), "step")
        return f"[bold green]solved[/]   {summary.task} (seed {summary.seed}), a plan of {steps}"
    tail = "; a plan that violates constraints was executed" if summary.executed == "fallback" else ""
    return f"[bold red]unsolved[/] {summary.task} (seed {summary.seed}){tail}"


def _goal(summary: Summary) -> str:
    if summary.goal_reached is None:
        return f"not judged: {summary.goal_reason or 'no plan was executed'}"
    return f"{'reached' if summary.goal_reached else 'missed'}: {summary.goal_reason}"


def _times(summary: Summary) -> str:
    return f"{summary.seconds['solve']:.2f} s solving, {summary.seconds['llm']:.2f} s LLM"
