"""Scripted answers, one a round."""

import json
from pathlib import Path

from proc3s import Completion, LLMError, Request


class Stub:
    """Answers with the texts of a JSON list, by round. Raises LLMError past its end."""

    def __init__(self, path: str, options: None) -> None:
        try:
            self._texts = json.loads(Path(path).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise LLMError(f"the script {path!r} cannot be read: {error}") from error
        if not isinstance(self._texts, list) or not all(isinstance(text, str) for text in self._texts):
            raise LLMError(f"the script {path} must be a JSON list of texts")

    def complete(self, request: Request) -> Completion:
        """The text of the round."""
        if request.round >= len(self._texts):
            raise LLMError(f"the script has {len(self._texts)} answers, none for round {request.round}")
        return Completion(
            text=self._texts[request.round], source="authored", model="stub", finish_reason="stop"
        )
