"""Asks a model: retries transient errors, drops refused parameters, and stays within the budget."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from proc3s.errors import SpecError, blame
from proc3s.llm.budget import Account
from proc3s.llm.completeness import cut_off, prompt_was_cut, refuse_empty, room, uncut, whole
from proc3s.llm.errors import TRANSIENT, LLMError
from proc3s.llm.types import LLM, Completion, Request, Sampling, WrappedLLM
from proc3s.redaction import redacted

if TYPE_CHECKING:
    from tenacity import RetryCallState
from proc3s.llm.call_options import CallOptions

_MOST_ATTEMPTS = 6


class RetryingLLM(WrappedLLM):
    """Retries transient errors of a backend; a truncated answer is retried once with twice max_tokens.

    A parameter that the provider refuses is left out from then on. Only complete answers are returned.
    `report` is called for every failed attempt that is retried, with the seconds until then; `name` is the
    backend's name on the command line.
    """

    def __init__(
        self,
        llm: LLM,
        name: str,
        account: Account,
        options: CallOptions,
        report: Callable[[Request, LLMError, float], None],
    ) -> None:
        super().__init__(llm)
        self._name = name
        self._account = account
        self._options = options
        self._report = report
        self._refused: set[str] = set()

    def prepare(self) -> None:
        """Do slow preparations before the first call; they count neither as model time nor as waiting."""
        with self._for_people():
            self._llm.prepare()

    def complete(self, request: Request) -> Completion:
        """The complete candidates of an answer. Raises LLMError or BudgetSpent."""
        if not self.live:
            return self._told(uncut(self._once(request)))
        self.prepare()
        first = self._accepted(request)
        if usable := whole(first):
            return usable
        wider = request.sampling.model_copy(update={"max_tokens": 2 * room(request, first)})
        self._report(request, cut_off(first), 0.0)
        second = self._accepted(request.model_copy(update={"sampling": wider}))
        if usable := whole(second):
            return usable.model_copy(update={"attempts": first.attempts + second.attempts})
        raise cut_off(second)

    def _accepted(self, request: Request) -> Completion:
        """The answer, asked for without the parameters that the provider refuses."""
        failed = 0
        while True:
            asked = request.model_copy(update={"sampling": request.sampling.without(self._refused)})
            try:
                completion = self._repeatedly(asked)
            except LLMError as error:
                failed += 1
                vain = error.parameters and not _sent(asked).intersection(error.parameters)
                if error.fault != "parameter" or vain or failed == _MOST_ATTEMPTS:
                    raise
                self._refused.update(error.parameters)
                self._report(request, error, 0.0)
            else:
                return self._as_asked(request, completion, failed)

    def _as_asked(self, request: Request, completion: Completion, failed: int) -> Completion:
        """The completion with the parameters in effect, and the number of calls that finding them took."""
        lost = {*completion.dropped, *self._refused}
        dropped = tuple(name for name in Sampling.model_fields if name in lost & _sent(request))
        changes = {"dropped": dropped, "sampling": request.sampling.without(dropped)}
        return completion.model_copy(update={**changes, "attempts": completion.attempts + failed})

    def _told(self, completion: Completion) -> Completion:
        """A replayed answer, with a note on the call options that had no effect on it."""
        idle = self._options.model_fields_set
        if completion.sampling is not None:
            idle = idle - Sampling.model_fields.keys()  # a replay tells what was other then
        if not idle:
            return completion
        note = f"nothing was asked, so -L {', '.join(sorted(idle))} changed nothing"
        return completion.model_copy(update={"notes": (*completion.notes, note)})

    def _repeatedly(self, request: Request) -> Completion:
        import tenacity

        retrying = tenacity.Retrying(
            retry=tenacity.retry_if_exception(_passes),
            wait=_wait,
            stop=tenacity.stop_after_attempt(_MOST_ATTEMPTS)
            | tenacity.stop_before_delay(self._options.patience),
            before_sleep=self._failed,
            reraise=True,
        )
        try:
            completion = retrying(self._charged, request)
        except LLMError as error:
            attempts = retrying.statistics["attempt_number"]
            if attempts == 1:
                raise
            said = f"{error} ({attempts} attempts)"
            raise LLMError(said, error.fault, error.retry_after, parameters=error.parameters) from error
        return completion.model_copy(update={"attempts": retrying.statistics["attempt_number"]})

    def _once(self, request: Request) -> Completion:
        with self._for_people():
            completion: object = self._llm.complete(request)
        if not isinstance(completion, Completion):
            raise LLMError(f"{self._name}: complete() gave a {type(completion).__name__}, no Completion")
        if not completion.candidates and not self.live:
            raise LLMError(f"{self._name}: the answer holds no candidates", "no_answer")
        return completion

    @contextmanager
    def _for_people(self) -> Iterator[None]:
        """Turn any exception of the backend into an LLMError without secrets; a bug in it names its line."""
        try:
            with blame(f"llm {self._name}"):
                yield
        except LLMError as error:
            said = redacted(str(error))
            raise LLMError(said, error.fault, error.retry_after, error.usage, error.parameters) from error
        except SpecError as error:
            raise LLMError(redacted(str(error))) from error

    def _charged(self, request: Request) -> Completion:
        charged = self._account.charge(request)
        begun = time.perf_counter()
        try:
            completion = self._once(request)
        except LLMError as error:
            self._account.release(charged, error)
            raise
        changes: dict[str, object] = {
            "model_asked": completion.model_asked or self._name,
            "notes": (*completion.notes, *prompt_was_cut(request, completion)),
        }
        if completion.latency is None:
            changes["latency"] = time.perf_counter() - begun
        if self._options.price is not None:
            changes["cost"] = None  # what is declared counts
        completion = self._account.settle(charged, completion.model_copy(update=changes))
        refuse_empty(completion)
        return completion

    def _failed(self, state: "RetryCallState") -> None:
        error = state.outcome.exception() if state.outcome else None
        if isinstance(error, LLMError):
            self._report(state.args[0], error, state.upcoming_sleep)


def _sent(request: Request) -> set[str]:
    """Names of the parameters that are not left to the provider."""
    return set(request.sampling.model_dump(exclude_defaults=True))


def _passes(error: BaseException) -> bool:
    return isinstance(error, LLMError) and error.fault in TRANSIENT


def _wait(state: "RetryCallState") -> float:
    """The wait that the provider asks for, else 0.5 s, doubling, with jitter."""
    import tenacity

    error = state.outcome.exception() if state.outcome else None
    if isinstance(error, LLMError) and error.retry_after is not None:
        return max(error.retry_after, 0.0)
    return (tenacity.wait_exponential(multiplier=0.5, max=10.0) + tenacity.wait_random(0.0, 0.25))(state)
