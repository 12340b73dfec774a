"""A function as a language model: for scripts, notebooks and tests."""

from collections.abc import Callable, Sequence
from typing import TypeAlias

from proc3s.llm.errors import LLMError
from proc3s.llm.types import LLM, Completion, Message, Request, answer

AskFunction: TypeAlias = Callable[[Sequence[Message]], str]
"""From the messages of a conversation to the text of an answer."""


class FunctionLLM(LLM):
    """Asks a function. What it raises ends the run as an error of the model."""

    def __init__(self, function: AskFunction, name: str) -> None:
        self._function, self._name = function, name

    def complete(self, request: Request) -> Completion:
        """The text that the function gives for the messages. Raises LLMError if that is no text."""
        text = self._function(request.messages)
        if not isinstance(text, str):
            raise LLMError(f"the function {self._name} returned {text!r}, not a text")
        return answer(text, self._name)
