"""The conversation with the LLM: earlier rounds become messages, an answer becomes a program."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeAlias

from proc3s.candidates import ask_all
from proc3s.errors import LLMError
from proc3s.events import AnswerReceived, Emit, PromptRendered, Warned
from proc3s.feedback import Diagnosis
from proc3s.llms import LLM, Completion, Message, Request, Sampling, Source, digest
from proc3s.problem import Problem
from proc3s.prompts import Prompter
from proc3s.sketch.extract import Extract, extract, without_thinking


@dataclass(frozen=True)
class Exchange:
    """An answer of the LLM and what became of it."""

    answer: str
    diagnosis: Diagnosis


@dataclass(frozen=True)
class Proposal:
    """An answer without the thoughts before it, and how to get the program out of it (raises SketchError if
    it has none).

    `round` and `candidate` name the program in the log and seed its random draws.
    """

    answer: str
    source: Source
    program: Callable[[], Extract]
    round: int = 0
    candidate: int = 0
    stale: bool = False
    """It answers another prompt than that of the run."""


Propose: TypeAlias = Callable[[int, Sequence[Exchange]], Sequence[Proposal]]
"""The programs of a round, by the rounds before it."""


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


@dataclass(frozen=True)
class Question:
    """What every request of a run has in common; `seed` and number of candidates are in `sampling`."""

    problem: Problem
    prompter: Prompter
    sampling: Sampling
    jobs: int = 1
    """Calls in flight."""

    def request(self, round_: int, messages: tuple[Message, ...]) -> Request:
        """The request for all candidates of a round."""
        method = self.prompter.method
        return Request(
            messages=messages,
            task=self.problem.name,
            method=method.name,
            template=method.template,
            seed=self.problem.seed,
            round=round_,
            sampling=self.sampling,
            bundled=_bundled(self.problem),
        )


def ask_llm(llm: LLM, question: Question, emit: Emit) -> Propose:
    """A proposer that renders the conversation and asks a language model.

    Where the model cannot take it all, only the latest round is shown; so it was in a recording that has
    no answer to the whole.
    """

    def propose(round_: int, history: Sequence[Exchange]) -> Sequence[Proposal]:
        try:
            return ask(round_, history)
        except LLMError as error:
            if len(history) < 2 or error.fault not in ("context", "no_answer"):
                raise
            try:
                proposals = ask(round_, history[-1:])
            except LLMError as again:
                raise (again if error.fault == "context" else error) from error
            emit(Warned(round=round_, text="the conversation is too long: only its latest round was shown"))
            return proposals

    def ask(round_: int, history: Sequence[Exchange]) -> Sequence[Proposal]:
        messages = conversation(question.prompter, question.problem, history)
        emit(PromptRendered(round=round_, sha256=digest(messages), messages=messages))
        request = question.request(round_, messages)
        proposals: list[Proposal] = []

        def warn(text: str) -> None:
            emit(Warned(round=round_, text=text))

        for number, completion in ask_all(llm, request, question.jobs, warn):
            emit(AnswerReceived(round=round_, candidate=number, completion=completion))
            proposals += proposals_of(completion, round_, number)
        return sorted(proposals, key=lambda proposal: proposal.candidate)

    return propose


def proposals_of(completion: Completion, round_: int, first: int = 0) -> list[Proposal]:
    """The candidates of an answer, numbered from `first`."""
    said = (without_thinking(candidate.text) for candidate in completion.candidates)
    return [
        Proposal(text, completion.source, partial(extract, text), round_, number, completion.stale)
        for number, text in enumerate(said, start=first)
    ]


def _bundled(problem: Problem) -> Path | None:
    """The domain's answers, unless the goal is another than the one they answer."""
    folder = problem.domain.spec.folder
    return folder / "answers" if folder and problem.goal == problem.task.instruction else None


def given_program(
    program: str, origin: Source = "none", round_: int = 0, candidate: int = 0, stale: bool = False
) -> Propose:
    """A proposer of one program that is there already; `round_` and `candidate` say whose random draws it
    takes."""
    return lambda _, history: [Proposal(program, origin, lambda: Extract(program), round_, candidate, stale)]
