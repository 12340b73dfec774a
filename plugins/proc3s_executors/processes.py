"""Rollouts in several processes, one world each."""

import contextlib
import itertools
import multiprocessing
import os
import pickle
import signal
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from proc3s import (
    OutOfTime,
    Plan,
    Problem,
    Rollouts,
    Trial,
    UsageError,
    Violation,
    loose_files,
    without_secrets,
)

_CHUNK_SECONDS = 0.02
"""Work that goes to a worker at once: long against sending it, short to wait for when nobody needs it."""
_MOST_PLANS = 64
_AHEAD = 2
"""Chunks under way for each worker."""
_MOST_RESTARTS = 6
"""So often in a row may workers die without a result in between."""
_SAFE_PATH = "PYTHONSAFEPATH"
"""Makes Python begin without the working directory on its path; then a worker takes its parent's path."""


@dataclass(frozen=True)
class WorkerReply:
    """What a worker made of a chunk: trials up to the error that stopped it, if one did."""

    trials: list[Trial]
    error: Exception | None
    seconds: float


class Processes:
    """A pool of `jobs` spawned workers. Results come in the order of the plans, whoever computed them.

    A worker that dies takes only time: what it had not answered is computed again. A plan that kills its
    worker every time is rejected for that. Raises UsageError if workers keep dying whatever they do.
    """

    def __init__(self, jobs: int = 2) -> None:
        self._jobs = jobs
        self._pool: ProcessPoolExecutor | None = None
        self._told: tempfile.TemporaryDirectory[str] | None = None
        self._restarts = 0
        self._plans_per_chunk = 1

    def map(self, problem: Problem, plans: Iterable[Plan]) -> Iterator[Trial]:
        """The trial of every plan, in order; plans are taken a few chunks ahead of the trial taken."""
        plans, key = iter(plans), pickle.dumps(problem)
        self._plans_per_chunk = 1
        running: deque[tuple[Sequence[Plan], Future[WorkerReply]]] = deque()
        try:
            while True:
                while len(running) < _AHEAD * self._jobs and (chunk := self._next_chunk(plans)):
                    running.append((chunk, self._submit(key, chunk)))
                if not running:
                    return
                try:
                    answer = running[0][1].result()
                except BrokenProcessPool:
                    self._restart()
                    suspects, *others = [chunk for chunk, _ in running]
                    running.clear()
                    for plan in suspects:
                        yield self._alone(key, plan)
                    running.extend((chunk, self._submit(key, chunk)) for chunk in others)
                    continue
                running.popleft()
                self._learn(answer)
                yield from answer.trials
                if answer.error is not None:
                    raise answer.error
        finally:
            for _, future in running:
                future.cancel()

    def _alone(self, key: bytes, plan: Plan) -> Trial:
        """The trial of a plan that may be what kills workers; it is if it kills two of them by itself."""
        for _ in range(2):
            try:
                answer = self._submit(key, [plan]).result()
            except BrokenProcessPool:
                self._restart()
                continue
            self._learn(answer)
            if answer.error is not None:
                raise answer.error
            return answer.trials[0]
        crash = Violation("world", 0, plan[0].skill, -1.0, "the simulator crashed on this plan")
        return Trial(plan, (crash,))

    def _next_chunk(self, plans: Iterator[Plan]) -> list[Plan]:
        return list(itertools.islice(plans, self._plans_per_chunk))

    def _learn(self, answer: WorkerReply) -> None:
        """Chunks grow towards a fixed time; their size decides nothing but how long things take."""
        self._restarts = 0
        if answer.trials:
            fitting = int(_CHUNK_SECONDS * len(answer.trials) / max(answer.seconds, 1e-6))
            self._plans_per_chunk = max(1, min(fitting, 2 * self._plans_per_chunk, _MOST_PLANS))

    def _submit(self, key: bytes, chunk: Sequence[Plan]) -> "Future[WorkerReply]":
        try:
            with _for_children():  # this may start processes
                return self._workers().submit(_evaluate, key, chunk)
        except (BrokenProcessPool, OSError) as error:  # OSError: the pool is about to notice a dead worker
            broken: Future[WorkerReply] = Future()
            broken.set_exception(BrokenProcessPool(str(error)))
            return broken

    def _workers(self) -> ProcessPoolExecutor:
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            self._told = self._told or tempfile.TemporaryDirectory(prefix="proc3s-")
            given = (loose_files(), Path(self._told.name))
            self._pool = ProcessPoolExecutor(self._jobs, context, initializer=_begin, initargs=given)
        return self._pool

    def _restart(self) -> None:
        if (late := self._last_words()) is not None:
            self._kill()
            self.close()
            raise OutOfTime(late)
        self._restarts += 1
        if self._restarts > _MOST_RESTARTS:
            jobs = f"--jobs {self._jobs}"
            raise UsageError(f"{self._restarts} worker processes died; is there memory enough for {jobs}?")
        self._kill()
        self.close()

    def _last_words(self) -> str | None:
        """Of a worker that was ended because it took too long; that is no verdict on a plan."""
        found = Path(self._told.name).iterdir() if self._told else iter(())
        path = next(found, None)
        return path.read_text(encoding="utf-8") if path else None

    def _kill(self) -> None:
        """End the workers at once.

        A pool ends its own when one of them dies, but misses one that is just being started, and then waits
        for it for ever (CPython 3.11); it has no public way to say this.
        """
        processes = self._pool._processes if self._pool else None
        for process in list((processes or {}).values()):
            process.kill()

    def close(self) -> None:
        """End the workers; each finishes the chunk that it works on."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None
        if self._told is not None:
            self._told.cleanup()
            self._told = None


@contextlib.contextmanager
def _for_children() -> Iterator[None]:
    """While workers are started in here they get no key, and import nothing from the working directory.

    Nor do they run the script that runs here, which may have no main guard: its module is not to be seen.
    """
    before, main = os.environ.get(_SAFE_PATH), sys.modules["__main__"]
    with without_secrets():
        os.environ[_SAFE_PATH] = "1"
        sys.modules["__main__"] = ModuleType("__main__")
        try:
            yield
        finally:
            sys.modules["__main__"] = main
            if before is None:
                del os.environ[_SAFE_PATH]
            else:
                os.environ[_SAFE_PATH] = before


def _begin(files: tuple[Path, ...], told: Path) -> None:
    """A worker leaves Ctrl-C to the parent, ends with it, and has its loose plugin files.

    If it takes too long, `told` gets its last words.
    """
    from proc3s import import_loose_file
    from proc3s.search.watch import watch

    watch().told = told

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    for path in files:
        # The parent lives with a plugin that does not load; what it brings is missed by name when it is used.
        with contextlib.suppress(Exception):
            import_loose_file(path)


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def _evaluate(key: bytes, chunk: Sequence[Plan]) -> WorkerReply:
    """The trials of a chunk; what came before an error is kept, as if plans were carried out one by one."""
    begun = time.perf_counter()
    trials: list[Trial] = []
    error = None
    try:
        rollouts = _worker.rollouts(key)
        for plan in chunk:
            trials.append(rollouts(plan))
    except Exception as raised:
        error = raised
    return WorkerReply(trials, error, time.perf_counter() - begun)


class _Worker:
    """The one world that a worker process keeps, for the problem that it works on."""

    def __init__(self) -> None:
        self._key = b""
        self._rollouts: Rollouts | None = None

    def rollouts(self, key: bytes) -> Rollouts:
        """The world of the problem; that of another problem is closed."""
        if self._rollouts is None or key != self._key:
            if self._rollouts is not None:
                self._rollouts.close()
                self._rollouts = None
            problem: Problem = pickle.loads(key)
            self._key, self._rollouts = key, Rollouts(problem)
        return self._rollouts


_worker = _Worker()
