"""The recorded answer to a request: found by what was asked for, then checked against the prompt."""

import re
import shlex
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from proc3s import Completion, LLMError, Message, Request, Usage, digest
from proc3s.errors import did_you_mean
from proc3s.llm.recorder import Recording
from proc3s.prompts.text import for_any_python
from proc3s.runs.reading import LOG
from proc3s_replay.differences import difference

_NUMBER = re.compile(r"(?<![\w.])[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?")
_MOST_NAMED = 10
_CALL_OPTIONS = {
    "temperature": "temperature",
    "max_tokens": "max_tokens",
    "reasoning_effort": "reasoning_effort",
    "n": "candidates",
}
"""What is compared of two ways of sampling, and what a person calls it; seeds are those of the run."""
Take = tuple[str, int]


@dataclass(frozen=True)
class Lookup:
    """Recordings at a path, and which of them answer; missing ones are to be recorded at `record`.

    `repeat` chooses among several answers to one prompt, whatever Python it names; `lenient` takes one to a
    prompt with other numbers in its feedback, `stale` the latest one to any other prompt.
    """

    path: Path
    record: Path
    recordings: Sequence[Recording]
    repeat: int = 0
    lenient: bool = False
    stale: bool = False

    def answer(self, request: Request) -> Completion:
        """What was answered to exactly this prompt. Raises LLMError if nothing was, or to another prompt."""
        keyed = [r for r in self.recordings if _is_of(r, request)]
        if not keyed:
            raise self._missing(request)
        sha256 = digest(request.messages)
        if exact := [r for r in keyed if r.sha256 == sha256]:
            return self._chosen(exact, request)
        if same := [r for r in keyed if _on_any_python(r.messages) == _on_any_python(request.messages)]:
            return self._chosen(same, request, "was given to a prompt that names another Python")
        blurred = _blurred(request.messages)
        if self.lenient and (alike := [r for r in keyed if _blurred(r.messages) == blurred]):
            return self._chosen(alike, request, "was given to feedback with other numbers (lenient=true)")
        if not self.stale:
            raise self._refused(keyed[-1], request)
        latest = [r for r in keyed if r.sha256 == keyed[-1].sha256]
        chosen = self._chosen(latest, request, "was given to another prompt (stale=accept)")
        return chosen.model_copy(update={"stale": True})

    def _chosen(self, matching: Sequence[Recording], request: Request, *notes: str) -> Completion:
        """The answer of the wanted repeat: in every round that of the same recorded run, if it has one."""
        takes = _takes(self.recordings)
        wanted = self._wanted_take(takes, matching, request)
        for recording in matching:
            if takes[recording.where] == wanted:
                return _replayed(recording, request, *notes)
        if self.repeat < len(matching):
            other = f"is of another run than repeat={self.repeat} began with, which has none"
            return _replayed(matching[self.repeat], request, *notes, other)
        raise self._too_few(len(matching), request)

    def _wanted_take(
        self, takes: Mapping[str, Take], matching: Sequence[Recording], request: Request
    ) -> Take | None:
        """The run that the wanted repeat is of, counted among those that began with the same prompt."""
        openings: dict[Take, str] = {}
        for recording in self.recordings:
            if _episode(recording) == _episode(request):
                openings.setdefault(takes[recording.where], recording.sha256)
        prompts = {openings[takes[recording.where]] for recording in matching}
        alike = [take for take, sha256 in openings.items() if sha256 in prompts]
        return alike[self.repeat] if self.repeat < len(alike) else None

    def _too_few(self, answers: int, request: Request) -> LLMError:
        there = "one answer" if answers == 1 else f"{answers} answers"
        return LLMError(
            f"{self.path} has {there} for {_what(request)}; they are counted from 0, so there is none with "
            f"repeat={self.repeat}",
            "no_answer",
        )

    def _missing(self, request: Request) -> LLMError:
        near, hint = self.recordings, "; there is nothing in it"
        for name in ("task", "method", "seed", "round", "candidate"):
            wanted = getattr(request, name)
            left = [recording for recording in near if wanted in _values(recording, name)]
            if near and not left:
                hint = _there(near, name, wanted)
                break
            near = left
        return LLMError(
            f"{self.path} has no answer for {_what(request)}{hint}\n"
            f"record it with:\n  {self._command(request, near)}",
            "no_answer",
        )

    def _refused(self, recording: Recording, request: Request) -> LLMError:
        return LLMError(
            f"the answer for {_what(request)} in {recording.where} was given to another prompt:\n"
            f"{difference(recording.messages, request.messages)}\n"
            "run its program all the same, marked as stale, with -L stale=accept; or "
            "record it anew, with the other options of this run, with:\n"
            f"  {self._command(request, [recording])}",
            "no_answer",
        )

    def _command(self, request: Request, near: Sequence[Recording]) -> str:
        """The command that records an answer, from the model that gave the nearest ones."""
        given = [r.completion for r in near if r.completion.source in ("live", "recorded")]
        model = (given[-1].model_asked or given[-1].model) if given else "PROVIDER/MODEL"
        command = ["proc3s", "run", request.task, "--method", request.method, "--seed", str(request.seed)]
        many = request.candidate + request.sampling.n
        command += ["--candidates", str(many)] if many > 1 else []
        kept = [] if (self.path / LOG).is_file() else ["--record", str(self.record)]
        return shlex.join([*command, "--llm", model, *kept])


def _episode(one: Request | Recording) -> tuple[str, str, int]:
    return one.task, one.method, one.seed


def _numbers(recording: Recording) -> range:
    """The candidates that a recording answers."""
    return range(recording.candidate, recording.candidate + len(recording.completion.candidates))


def _is_of(recording: Recording, request: Request) -> bool:
    same = _episode(recording) == _episode(request) and recording.round == request.round
    return same and request.candidate in _numbers(recording)


def _takes(recordings: Sequence[Recording]) -> dict[str, Take]:
    """The run of each recording, by `where`. A question that is answered again begins another run."""
    seen: Counter[tuple[object, ...]] = Counter()
    takes: dict[str, Take] = {}
    for recording in recordings:
        question = (recording.take, *_episode(recording), recording.round, recording.candidate)
        takes[recording.where] = recording.take, seen[question]
        seen[question] += 1
    return takes


def _replayed(recording: Recording, request: Request, *notes: str) -> Completion:
    """The candidates that are wanted. The figures of a call go with the first of its candidates."""
    completion = recording.completion
    notes = (*notes, *_drawn_otherwise(recording, request))
    first = request.candidate - recording.candidate
    changes: dict[str, object] = {
        "candidates": completion.candidates[first : first + request.sampling.n],
        "source": "recorded" if completion.source == "live" else completion.source,
        "answered": completion.answered or recording.time,
        "notes": (*completion.notes, *(f"the answer in {recording.where} {note}" for note in notes)),
    }
    if first:
        changes |= {"usage": Usage(), "cost": None, "latency": None}
    return completion.model_copy(update=changes)


def _drawn_otherwise(recording: Recording, request: Request) -> Iterator[str]:
    """What to say of an answer that was drawn with other call options than those of this run."""
    drawn = recording.sampling or recording.completion.sampling
    if drawn is None:
        return
    then, now = drawn.model_dump(), request.sampling.model_dump()
    names = [n for n in _CALL_OPTIONS if then[n] != now[n] and n not in recording.completion.dropped]
    if request.candidate:
        names = [name for name in names if name != "n"]  # what one call did not bring was asked for alone
    if names:
        told = (f"{_CALL_OPTIONS[n]} {_value(then[n])}, not {_value(now[n])}" for n in names)
        yield f"was asked for with {'; '.join(told)}"


def _value(value: object) -> str:
    return "as the provider has it" if value is None else str(value)


def _on_any_python(messages: Sequence[Message]) -> list[tuple[str, str]]:
    """Messages without the version of Python that the prompt names."""
    return [(m.role, for_any_python(m.text) if m.kind == "system" else m.text) for m in messages]


def _blurred(messages: Sequence[Message]) -> list[tuple[str, str]]:
    """The same without the numbers in feedback; a digit in a name is no number."""
    texts = _on_any_python(messages)
    feedback = (m.kind == "feedback" for m in messages)
    return [(r, _NUMBER.sub("#", t) if f else t) for (r, t), f in zip(texts, feedback, strict=True)]


def _what(request: Request) -> str:
    candidate = f", candidate {request.candidate}" if request.candidate else ""
    return f"{request.task}, method {request.method}, seed {request.seed}, round {request.round}{candidate}"


def _values(recording: Recording, name: str) -> Sequence[str | int]:
    return _numbers(recording) if name == "candidate" else [getattr(recording, name)]


def _there(near: Sequence[Recording], name: str, wanted: str | int) -> str:
    """What there is in place of a value that is not there."""
    there = {value for recording in near for value in _values(recording, name)}
    if isinstance(wanted, str):
        return did_you_mean(wanted, map(str, there))
    numbers = sorted(there, key=lambda number: (abs(int(number) - wanted), number))[:_MOST_NAMED]
    more = " and others" if len(there) > _MOST_NAMED else ""
    return f"; there is {name} {', '.join(map(str, sorted(numbers)))}{more}"
