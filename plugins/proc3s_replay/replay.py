"""Replayed answers: bundled ones by name, those of a run by round and checked against its prompts."""

from pathlib import Path

from proc3s import Completion, LLMError, Request, digest, runs
from proc3s_replay import answers

_WAYS_OUT = (
    "ask a model with --llm PROVIDER/MODEL, or record an answer: every run keeps its answers, and "
    "--llm replay:RUN plays them (--llm manual:DIR lets you write one yourself)"
)


class Replay:
    """`path` is a folder of answer files or a run folder; empty: the answers bundled with the domain."""

    def __init__(self, path: str, options: None) -> None:
        self._path = Path(path) if path else None
        if self._path is not None and not self._path.is_dir():
            raise LLMError(f"there is no folder {self._path} to replay; {_WAYS_OUT}")

    def complete(self, request: Request) -> Completion:
        """The recorded or authored answer. Raises LLMError if it is missing or stale."""
        if self._path is not None and (self._path / runs.LOG).is_file():
            return self._from_run(self._path, request)
        folder = self._path or request.bundled
        path = answers.find(folder, request) if folder else None
        if path is None:
            names = f"{answers.stem(request, seed=False)}.md or {answers.stem(request)}.md"
            where = f"in {self._path}" if self._path else "bundled"
            raise LLMError(
                f"no answer is {where} for {request.task} with the prompt {request.template!r}, "
                f"seed {request.seed}, round {request.round} ({names}); {_WAYS_OUT}"
            )
        return answers.read(path)

    def _from_run(self, run: Path, request: Request) -> Completion:
        """An answer of a run, given to exactly the prompt of this request."""
        prompts = {event["round"]: event["sha256"] for event in runs.events_of(run, "prompt_rendered")}
        given = {event["round"]: event["completion"] for event in runs.events_of(run, "answer_received")}
        if request.round not in given:
            raise LLMError(f"{run} has no answer for round {request.round}; {_WAYS_OUT}")
        if prompts.get(request.round) != digest(request.messages):
            raise LLMError(
                f"the answer of round {request.round} in {run} was given to another prompt; see it "
                f"with `proc3s render-prompt {request.task} --diff {run}`, then {_WAYS_OUT}"
            )
        found = Completion.model_validate(given[request.round])
        return found.model_copy(update={"source": "recorded"}) if found.source == "live" else found
