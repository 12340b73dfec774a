"""Asking a model: patience with faults that pass, all candidates of a round, and within the budget."""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from queue import SimpleQueue
from typing import TYPE_CHECKING

from pydantic import BaseModel, ConfigDict, Field, model_validator

from proc3s.budget import Account
from proc3s.errors import TRANSIENT, BudgetSpent, LLMError, SpecError, blame
from proc3s.llms import LLM, Candidate, Completion, Effort, Price, Request, Sampling
from proc3s.secrets import redacted

if TYPE_CHECKING:
    from tenacity import RetryCallState

_PATIENCE = 60.0
_MOST_ATTEMPTS = 6
_VARIED = 0.7
"""Temperature for several candidates: at 0 they would all be the same."""
_SEEDS_APART = 1_000_003


class CallOptions(BaseModel):
    """Options that every LLM takes."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    temperature: float | None = Field(
        None,
        ge=0,
        le=2,
        description=f"sampling temperature; by default 0, or {_VARIED} for several candidates",
    )
    max_tokens: int | None = Field(None, ge=1, description="longest answer; by default the provider's")
    reasoning_effort: Effort | None = Field(None, description="how long the model thinks, where it can")
    patience: float = Field(
        _PATIENCE, ge=0, le=_PATIENCE, description="seconds in which failed calls are repeated"
    )
    prompt_price: float | None = Field(None, ge=0, description="US dollars for a million tokens of prompt")
    completion_price: float | None = Field(
        None, ge=0, description="US dollars for a million tokens of answer"
    )

    @model_validator(mode="after")
    def _whole_price(self) -> "CallOptions":
        if (self.prompt_price is None) != (self.completion_price is None):
            raise ValueError("prompt_price and completion_price go together")
        return self

    @property
    def price(self) -> Price | None:
        """The declared price, if both parts are given."""
        if self.prompt_price is None or self.completion_price is None:
            return None
        return Price(prompt=self.prompt_price, completion=self.completion_price)

    def sampling(self, seed: int, candidates: int) -> Sampling:
        """How the answers of a round are drawn; the run's seed is the provider's too."""
        usual = 0.0 if candidates == 1 else _VARIED
        return Sampling(
            temperature=usual if self.temperature is None else self.temperature,
            seed=seed,
            n=candidates,
            max_tokens=self.max_tokens,
            reasoning_effort=self.reasoning_effort,
        )


class Patient(LLM):
    """A backend with patience: passing faults are retried, a cut answer gets twice the room once.

    Only whole answers come out. `report` hears of every failed attempt that another one follows, with the
    seconds until then; `name` is how the backend was chosen.
    """

    def __init__(
        self,
        llm: LLM,
        name: str,
        account: Account,
        options: CallOptions,
        report: Callable[[Request, LLMError, float], None],
    ) -> None:
        self._llm = llm
        self._name = name
        self._account = account
        self._options = options
        self._report = report
        self.live = llm.live

    def complete(self, request: Request) -> Completion:
        """The whole candidates of an answer. Raises LLMError or BudgetSpent."""
        if not self.live:
            return _uncut(self._once(request))
        first = self._repeatedly(request)
        if whole := _whole(first):
            return whole
        wider = request.sampling.model_copy(update={"max_tokens": 2 * _room(request, first)})
        self._report(request, _cut_off(first), 0.0)
        second = self._repeatedly(request.model_copy(update={"sampling": wider}))
        if whole := _whole(second):
            return whole.model_copy(update={"attempts": first.attempts + second.attempts})
        raise _cut_off(second)

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
            raise LLMError(f"{error} ({attempts} attempts)", error.fault, error.retry_after) from error
        return completion.model_copy(update={"attempts": retrying.statistics["attempt_number"]})

    def _once(self, request: Request) -> Completion:
        try:
            with blame("llm"):
                completion: object = self._llm.complete(request)
        except LLMError as error:
            raise LLMError(redacted(str(error)), error.fault, error.retry_after) from error
        except SpecError as error:
            raise LLMError(redacted(str(error))) from error
        if not isinstance(completion, Completion):
            raise LLMError(f"{self._name}: complete() gave a {type(completion).__name__}, no Completion")
        if not completion.candidates and not self.live:
            raise LLMError(f"{self._name}: the answer holds no candidates", "no_answer")
        return completion

    def _charged(self, request: Request) -> Completion:
        charged = self._account.charge(request)
        begun = time.perf_counter()
        try:
            completion = self._once(request)
        except LLMError as error:
            self._account.release(charged, error)
            raise
        changes: dict[str, object] = {"model_asked": completion.model_asked or self._name}
        if completion.latency is None:
            changes["latency"] = time.perf_counter() - begun
        if self._options.price is not None:
            changes["cost"] = None  # what is declared counts
        completion = self._account.settle(charged, completion.model_copy(update=changes))
        _refuse_empty(completion)
        return completion

    def _failed(self, state: "RetryCallState") -> None:
        error = state.outcome.exception() if state.outcome else None
        if isinstance(error, LLMError):
            self._report(state.args[0], error, state.upcoming_sleep)


def _passes(error: BaseException) -> bool:
    return isinstance(error, LLMError) and error.fault in TRANSIENT


def _wait(state: "RetryCallState") -> float:
    """What the provider asks for, else 0.5 s doubling with some jitter."""
    import tenacity

    error = state.outcome.exception() if state.outcome else None
    if isinstance(error, LLMError) and error.retry_after is not None:
        return max(error.retry_after, 0.0)
    return (tenacity.wait_exponential(multiplier=0.5, max=10.0) + tenacity.wait_random(0.0, 0.25))(state)


def _refuse_empty(completion: Completion) -> None:
    """Raises LLMError if no candidate has a text, be it a part of one."""
    if any(candidate.text.strip() or _cut(candidate) for candidate in completion.candidates):
        return
    if any(candidate.finish_reason == "content_filter" for candidate in completion.candidates):
        raise LLMError(
            f"{completion.model}: the provider's content filter held the answer back; change the "
            "instruction, or choose another --llm",
            "filtered",
        )
    raise LLMError(f"{completion.model}: the answer is empty; choose another --llm if it stays so", "empty")


def _cut(candidate: Candidate) -> bool:
    return candidate.finish_reason == "length"


def _cut_off(completion: Completion) -> LLMError:
    tokens = completion.usage.completion_tokens
    where = f" after {tokens:,} tokens" if tokens else ""
    return LLMError(
        f"{completion.model}: the answer was cut off{where}; raise -L max_tokens=N, or choose a model that "
        "writes less",
        "cut_off",
    )


def _uncut(completion: Completion) -> Completion:
    """An answer that was there already, without candidates that are not whole. Raises LLMError."""
    whole = tuple(candidate for candidate in completion.candidates if not _cut(candidate))
    if not whole:
        raise _cut_off(completion)
    return completion.model_copy(update={"candidates": whole})


def _whole(completion: Completion) -> Completion | None:
    """The completion with the candidates that have a text and were not cut off; None without any."""
    whole = tuple(c for c in completion.candidates if c.text.strip() and not _cut(c))
    return completion.model_copy(update={"candidates": whole}) if whole else None


def _room(request: Request, completion: Completion) -> int:
    """Tokens that were too few."""
    return request.sampling.max_tokens or completion.usage.completion_tokens or 4096


def ask_all(
    llm: LLM, request: Request, jobs: int, warn: Callable[[str], None]
) -> Iterator[tuple[int, Completion]]:
    """`request.sampling.n` candidates as they come, each answer with the number of its first.

    What one call does not bring is asked for one by one, with at most `jobs` calls in flight. The first call
    must succeed; where a later one fails the round goes on without that candidate, and `warn` is told.
    """
    first = llm.complete(request)
    yield request.candidate, first
    missing = range(request.candidate + len(first.candidates), request.candidate + request.sampling.n)
    for number, outcome in _in_flight(llm, request, missing, jobs):
        if isinstance(outcome, Completion):
            yield number, outcome
        elif isinstance(outcome, LLMError | BudgetSpent):
            warn(f"candidate {number} is missing: {outcome}")
        else:
            raise outcome


def _in_flight(
    llm: LLM, request: Request, numbers: Iterable[int], jobs: int
) -> Iterator[tuple[int, Completion | Exception]]:
    """Answers or errors as they come. Closed early, calls that are not begun are not made.

    The threads are daemons: an executor's would keep the program alive for as long as a call takes.
    """
    todo = deque(numbers)
    count = len(todo)
    done: SimpleQueue[tuple[int, Completion | Exception]] = SimpleQueue()

    def work() -> None:
        while True:
            try:
                number = todo.popleft()
            except IndexError:
                return
            try:
                done.put((number, llm.complete(_alone(request, number))))
            except Exception as error:
                done.put((number, error))

    try:
        for _ in range(min(jobs, count)):
            threading.Thread(target=work, daemon=True).start()
        for _ in range(count):
            yield done.get()
    finally:
        todo.clear()


def _alone(request: Request, candidate: int) -> Request:
    """The request for one further candidate, with a seed of its own."""
    seed = request.sampling.seed
    apart = None if seed is None else seed + _SEEDS_APART * candidate
    sampling = request.sampling.model_copy(update={"n": 1, "seed": apart})
    return request.model_copy(update={"candidate": candidate, "sampling": sampling})
