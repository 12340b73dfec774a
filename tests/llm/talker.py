"""A backend in a loose file: says what a script tells it, and writes down what it was asked.

The script is a JSON list, one entry a call: a text, a list of texts (candidates), or an object with fields of
a completion, or with a `fault`. The count of calls goes on from process to process.
"""

import json
import threading
import time
from pathlib import Path

from proc3s import LLM, Candidate, Completion, LLMError, LLMSpec, Price, hookimpl


class Talker(LLM):
    def __init__(self, path, options):
        self._script = Path(path)
        self._asked = self._script.with_suffix(".asked")
        self._turn = threading.Lock()
        cheap = self._script.with_suffix(".price")
        self.price = Price.model_validate_json(cheap.read_text()) if cheap.exists() else None

    def complete(self, request):
        entry = self._next_entry(request)
        if isinstance(entry, dict) and "wrong" in entry:
            return entry["wrong"]
        if not isinstance(entry, dict):
            entry = {"texts": [entry] if isinstance(entry, str) else entry}
        time.sleep(entry.pop("seconds", 0))
        if "fault" in entry:
            raise LLMError(
                entry["message"],
                entry["fault"],
                entry.get("retry_after"),
                parameters=entry.get("parameters", ()),
            )
        finish = entry.pop("finish", "stop")
        candidates = tuple(Candidate(text=text, finish_reason=finish) for text in entry.pop("texts"))
        return Completion(candidates=candidates, model="talker-1", **entry)

    def _next_entry(self, request):
        """Calls that come at the same time take different entries."""
        with self._turn:
            with self._asked.open("a") as file:
                file.write(request.model_dump_json() + "\n")
            calls = len(self._asked.read_text().splitlines())
        return json.loads(self._script.read_text())[calls - 1]


@hookimpl
def register_llms(register):
    register(
        LLMSpec(name="talker", summary="Says what it is told.", usage="talker:FILE", target="talker:Talker")
    )
