"""Rollouts in several processes, one world each."""

import itertools
import multiprocessing
import pickle
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import lru_cache
from pathlib import Path

from proc3s import Plan, Problem, Rollouts, Trial, UsageError, loose_files

_CHUNKS_PER_WORKER = 4
_MOST_PLANS = 64
"""Largest chunk: a plan that is accepted early should not wait behind many that nobody needs."""
_MOST_RESTARTS = 5


class Processes:
    """A pool of `jobs` spawned workers. Results come in the order of the plans, whoever computed them.

    A worker that dies takes only time: what it had not answered is computed again. Raises UsageError if
    workers keep dying.
    """

    def __init__(self, jobs: int = 2) -> None:
        self._jobs = jobs
        self._pool: ProcessPoolExecutor | None = None
        self._restarts = 0

    def map(self, problem: Problem, plans: Iterable[Plan]) -> Iterator[Trial]:
        """The trial of every plan, in order; chunks ahead of the one taken are under way."""
        waiting = _chunks(list(plans), self._jobs)
        key = pickle.dumps(problem)
        running: deque[tuple[Sequence[Plan], Future[list[Trial]]]] = deque()
        try:
            while waiting or running:
                while waiting and len(running) < 2 * self._jobs:
                    chunk = waiting.popleft()
                    running.append((chunk, self._submit(key, chunk)))
                try:
                    trials = running[0][1].result()
                except BrokenProcessPool:
                    self._restart()
                    waiting.extendleft(chunk for chunk, _ in reversed(running))
                    running.clear()
                    continue
                running.popleft()
                yield from trials
        finally:
            for _, future in running:
                future.cancel()

    def _submit(self, key: bytes, chunk: Sequence[Plan]) -> "Future[list[Trial]]":
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            files = loose_files()
            self._pool = ProcessPoolExecutor(self._jobs, context, initializer=_begin, initargs=(files,))
        try:
            return self._pool.submit(_evaluate, key, chunk)
        except BrokenProcessPool as error:
            broken: Future[list[Trial]] = Future()
            broken.set_exception(error)
            return broken

    def _restart(self) -> None:
        self._restarts += 1
        if self._restarts > _MOST_RESTARTS:
            jobs = f"--jobs {self._jobs}"
            raise UsageError(f"{self._restarts} worker processes died; is there memory enough for {jobs}?")
        self.close()

    def close(self) -> None:
        """End the workers."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None


def _chunks(plans: list[Plan], jobs: int) -> deque[Sequence[Plan]]:
    """Small chunks first: the accepted plan is often an early one."""
    size = max(1, min(_MOST_PLANS, len(plans) // (jobs * _CHUNKS_PER_WORKER)))
    sizes = itertools.chain((1,) * jobs, itertools.repeat(size))
    chunks: deque[Sequence[Plan]] = deque()
    at = 0
    for size in sizes:
        if at >= len(plans):
            return chunks
        chunks.append(plans[at : at + size])
        at += size
    return chunks


def _begin(files: tuple[Path, ...]) -> None:
    """Loose plugin files are importable in a worker as they are in the parent."""
    from proc3s import import_loose_file

    for path in files:
        import_loose_file(path)


def _evaluate(key: bytes, chunk: Sequence[Plan]) -> list[Trial]:
    rollouts = _rollouts(key)
    return [rollouts(plan) for plan in chunk]


@lru_cache(maxsize=1)
def _rollouts(key: bytes) -> Rollouts:
    """The worker's world for the problem it works on."""
    problem: Problem = pickle.loads(key)
    return Rollouts(problem)
