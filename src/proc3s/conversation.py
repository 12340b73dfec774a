"""The conversation with the LLM: earlier rounds become messages, an answer becomes a program."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from proc3s.events import AnswerReceived, Emit, PromptRendered
from proc3s.feedback import Diagnosis
from proc3s.llms import LLM, Message, Request, Source, digest
from proc3s.problem import Problem
from proc3s.prompts import Prompter
from proc3s.sketch.extract import extract_program


@dataclass(frozen=True)
class Exchange:
    """An answer of the LLM and what became of it."""

    answer: str
    diagnosis: Diagnosis


@dataclass(frozen=True)
class Proposal:
    """An answer, and how to get the program out of it (raises SketchError if it has none)."""

    answer: str
    source: Source
    program: Callable[[], str]
    round: int = 0
    """Names the round in the log and seeds its random draws."""


Propose: TypeAlias = Callable[[int, Sequence[Exchange]], Proposal]


class Rounds:
    """How many questions are left: the first, the feedback rounds, and repairs of unusable programs.

    A program that never came to be sampled costs a repair before it costs a round, as many in a row as the
    preset says.
    """

    def __init__(self, feedback: int, repairs: int) -> None:
        self._feedback = feedback
        self.left = feedback + 1
        self._repairs = repairs if feedback else 0
        self._repaired = 0

    @property
    def used(self) -> int:
        """Feedback rounds so far; the first question is none."""
        return min(self._feedback + 1 - self.left, self._feedback)

    def spend(self, repair: bool) -> None:
        """A question was answered in vain; `repair`: its program could not be used at all."""
        if repair and self._repaired < self._repairs:
            self._repaired += 1
        else:
            self.left -= 1
            self._repaired = 0


def conversation(prompter: Prompter, problem: Problem, history: Sequence[Exchange]) -> tuple[Message, ...]:
    """All messages up to the next answer: system, worked examples, task, then round by round."""
    messages = [prompter.system(problem), *prompter.examples(problem), prompter.task(problem)]
    shown, tried = _shown(history, prompter.preset.restart_after)
    for exchange in shown:
        messages.append(Message(role="assistant", kind="reply", text=exchange.answer))
        messages.append(prompter.feedback(problem, exchange.diagnosis, tried))
    return tuple(messages)


def _shown(history: Sequence[Exchange], restart_after: int) -> tuple[Sequence[Exchange], Sequence[Diagnosis]]:
    """All rounds; or, when the last ones brought no progress, the best alone and what was tried since.

    The authors saw that an LLM rarely recovers from a wrong change of its own (PRoC3S, section 6).
    """
    best = max(range(len(history)), key=lambda i: (history[i].diagnosis.progress, -i), default=0)
    since = history[best + 1 :]
    if not restart_after or len(since) < restart_after:
        return history, ()
    return history[best : best + 1], [exchange.diagnosis for exchange in since]


def ask_llm(llm: LLM, prompter: Prompter, problem: Problem, emit: Emit) -> Propose:
    """A proposer that renders the conversation and asks a language model."""

    def propose(round_: int, history: Sequence[Exchange]) -> Proposal:
        messages = conversation(prompter, problem, history)
        emit(PromptRendered(round=round_, sha256=digest(messages), messages=messages))
        completion = llm.complete(
            Request(
                messages=messages,
                task=problem.name,
                template=prompter.method.template,
                seed=problem.seed,
                round=round_,
                bundled=_bundled(problem),
            )
        )
        emit(AnswerReceived(round=round_, completion=completion))
        return Proposal(completion.text, completion.source, lambda: extract_program(completion.text), round_)

    return propose


def _bundled(problem: Problem) -> Path | None:
    """The domain's answers, unless the goal is another than the one they answer."""
    folder = problem.domain.spec.folder
    return folder / "answers" if folder and problem.goal == problem.task.instruction else None


def given_program(program: str, origin: Source = "none", round_: int = 0) -> Propose:
    """A proposer of one program that is there already; `round_` says whose random draws it takes."""
    return lambda _, history: Proposal(program, origin, lambda: program, round_)
