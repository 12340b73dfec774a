"""The conversation with the LLM: earlier rounds become messages, an answer becomes a program."""

from collections.abc import Sequence
from dataclasses import dataclass

from proc3s.feedback.report import Diagnosis
from proc3s.llm.types import Message
from proc3s.prompts.prompter import Prompter
from proc3s.search.problem import Problem


@dataclass(frozen=True)
class Exchange:
    """An answer of the LLM and what became of it."""

    answer: str
    diagnosis: Diagnosis


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
