"""Scripted answers, one a round."""

import json
from pathlib import Path
from typing import Any

from proc3s import LLM, Candidate, Completion, LLMError, Request
from proc3s.textfiles import read_text
from proc3s.wording import count


class Stub(LLM):
    """Answers with the elements of a JSON list, by round: a text, or a list of texts, the candidates.

    Raises LLMError past its end.
    """

    live = False

    def __init__(self, path: str, options: None) -> None:
        try:
            script = json.loads(read_text(Path(path)))
        except (OSError, ValueError, RecursionError) as error:
            raise LLMError(f"the script {path!r} cannot be read: {error}") from error
        self._rounds = [_candidates(element) for element in script] if isinstance(script, list) else []
        if not isinstance(script, list) or not all(self._rounds):
            raise LLMError(f"the script {path} must be a JSON list of texts, or of lists of texts")

    def complete(self, request: Request) -> Completion:
        """As many candidates of the round as are wanted and there."""
        if request.round >= len(self._rounds):
            there = f"{count(len(self._rounds), 'answer')}, none"
            raise LLMError(f"the script has {there} for round {request.round}", "no_answer")
        texts = self._rounds[request.round]
        wanted = texts[request.candidate :][: request.sampling.n]
        if not wanted:
            there = f"{count(len(texts), 'candidate')} for round {request.round}, none"
            raise LLMError(f"the script has {there} with number {request.candidate}", "no_answer")
        candidates = tuple(Candidate(text=text) for text in wanted)
        return Completion(candidates=candidates, source="authored", model="stub")


def _candidates(element: Any) -> list[str]:
    """The texts of a round; none if it is something else."""
    texts = element if isinstance(element, list) else [element]
    return texts if all(isinstance(text, str) for text in texts) else []
