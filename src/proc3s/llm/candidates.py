"""All candidates of a round: what one call does not bring is asked for with several calls in flight."""

import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from queue import SimpleQueue

from proc3s.llm.errors import BudgetSpent, LLMError
from proc3s.llm.types import LLM, Completion, Request

_SEEDS_APART = 1_000_003


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
) -> Iterator[tuple[int, Completion | BaseException]]:
    """Answers or errors as they come. Closed early, calls that are not begun are not made.

    The threads are daemons: an executor's would keep the program alive for as long as a call takes.
    """
    todo = deque(numbers)
    count = len(todo)
    done: SimpleQueue[tuple[int, Completion | BaseException]] = SimpleQueue()

    def work() -> None:
        while True:
            try:
                number = todo.popleft()
            except IndexError:
                return
            try:
                done.put((number, llm.complete(_alone(request, number))))
            except BaseException as error:  # the caller waits for every thread: no error may get lost
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
