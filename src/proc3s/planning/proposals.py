"""Proposals: where the programs of a round come from."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeAlias

from proc3s.llm.candidates import ask_all
from proc3s.llm.errors import LLMError
from proc3s.llm.types import LLM, Completion, Message, Request, Sampling, Source, digest
from proc3s.prompts.conversation import Exchange, conversation
from proc3s.prompts.extract import Extract, extract, without_thinking
from proc3s.prompts.prompter import Prompter
from proc3s.runs.events import AnswerReceived, Emit, PromptRendered, Warned
from proc3s.search.problem import Problem


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


@dataclass(frozen=True)
class Question:
    """The parts that all requests of a run share; `seed` and number of candidates are in `sampling`."""

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
