"""Carries out the episodes of a suite: each is a `proc3s run` of its own, several at a time.

Each has a process of its own, so that a crash ends one episode alone, and simulators share no thread. A
finished episode is in the store before the next begins.
"""

import contextlib
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path

from proc3s.errors import Proc3sError
from proc3s.llm.budget import Ledger
from proc3s.planning.summary import Summary
from proc3s.runs.reading import LOG, events_of
from proc3s.specs.suite import Cell, SuiteSpec
from proc3s.suites.episode import Episode, episode_of
from proc3s.suites.outcomes import Unfinished
from proc3s.suites.store import Store
from proc3s.wording import total

RUNS = "runs"
"""Folder of the run folders, below that of the suite."""
GRACE = 10.0
"""Seconds in which an episode may write what it has after Ctrl-C."""

ALIKE = 3
"""So many episodes in a row that end with the same error end the suite: the next ones would, too."""


@dataclass(frozen=True)
class Order:
    """What holds for all episodes: arguments of `proc3s run`, how many at a time, and what they may cost."""

    spec: SuiteSpec
    llm: str
    llm_options: tuple[str, ...] = ()
    """`key=value`."""
    arguments: tuple[str, ...] = ()
    again: tuple[str, ...] = ()
    """Arguments that a run which goes on takes, too."""
    llm_jobs: int | None = None
    """Calls in flight of one episode."""
    jobs: int = 1
    max_cost: float | None = None
    """US dollars, of all episodes together."""
    template_dir: Path | None = None
    """Folder of templates that go before all others; it is among the arguments, too."""
    judged: Mapping[str, bool] = field(default_factory=dict)
    """Tasks that have a judge."""
    filmed: frozenset[str] = frozenset()
    """Tasks whose worlds keep films; others draw their outcome at once."""
    world_options: Mapping[str, str] = field(default_factory=dict)
    """Options of the world; they are among the arguments, too."""


EpisodeOutcome = Episode | Unfinished


class Runner:
    """Runs the episodes that the store does not have yet. Close it to stop those under way."""

    def __init__(self, order: Order, store: Store) -> None:
        self._order, self._store = order, store
        self._running: dict[Cell, subprocess.Popen[str]] = {}
        self._lock, self._stopped = threading.Lock(), False
        self._allotted: dict[Cell, float] = {}
        self._broke = False
        self._latest: list[str] = []
        """The errors of the latest episodes, as long as they are the same."""
        self._spent = {run.name: spent_on(run) for run in (store.folder / RUNS).glob("*")}

    def outcomes(self, cells: Iterable[Cell]) -> Iterator[EpisodeOutcome]:
        """What became of each episode, as they end; a finished one is in the store by then.

        No more are begun once `max_cost` is spent.
        """
        waiting, pool = iter(cells), ThreadPoolExecutor(self._order.jobs)
        under_way: set[Future[EpisodeOutcome]] = set()
        try:
            while True:
                while len(under_way) < self._order.jobs and not self._poor():
                    if (cell := next(waiting, None)) is None:
                        break
                    self._allot(cell)
                    under_way.add(pool.submit(self._run, cell))
                if not under_way:
                    return
                done, under_way = wait(under_way, return_when=FIRST_COMPLETED)
                # all are kept before anyone hears of the first
                yield from [self._settle(future.result()) for future in done]
        finally:
            self.close()
            pool.shutdown()

    def _poor(self) -> bool:
        """Whether the budget leaves nothing for another episode."""
        return self._broke or self._left() == 0.0 or self.hopeless

    @property
    def hopeless(self) -> bool:
        """Whether no further episodes are begun, since the latest ones all ended with the same error."""
        return len(self._latest) >= ALIKE

    def _left(self) -> float | None:
        """What may still be allotted; None without a limit."""
        if self._order.max_cost is None:
            return None
        return max(0.0, self._order.max_cost - self._known - sum(self._allotted.values()))

    @property
    def spent(self) -> str:
        """US dollars in words, with estimates for unknown figures; says which parts are unknown."""
        return total([*self._spent.values()], "{:.4f}")

    @property
    def _known(self) -> float:
        return sum(cost or 0.0 for cost in self._spent.values())

    def _allot(self, cell: Cell) -> None:
        """A fair share of what is left, so that all together never cost more."""
        if (left := self._left()) is not None:
            self._allotted[cell] = left / (self._order.jobs - len(self._allotted))

    def _settle(self, outcome: EpisodeOutcome) -> EpisodeOutcome:
        self._allotted.pop(outcome.cell, None)
        self._broke |= isinstance(outcome, Unfinished) and outcome.stopped == "budget"
        self._spent[outcome.cell.folder] = spent_on(self._store.folder / RUNS / outcome.cell.folder)
        if isinstance(outcome, Episode):
            self._latest = []
            self._store.add(outcome)
        else:
            error = outcome.error if outcome.word == "error" else ""
            self._latest = [*(old for old in self._latest if old == error), error] if error else []
            self._store.leave(outcome)
        return outcome

    def _run(self, cell: Cell) -> EpisodeOutcome:
        """One episode; an error around its process is recorded as the reason why it is unfinished."""
        try:
            return self._carried_out(cell)
        except (OSError, Proc3sError) as error:
            return Unfinished(cell, "crashed", str(error))

    def _carried_out(self, cell: Cell) -> EpisodeOutcome:
        """One episode in a process of its own, new or resumed."""
        run = self._store.folder / RUNS / cell.folder
        if (ended := _ended(run)) is not None:
            return self._episode(cell, ended, run)
        going_on = _begun(run)
        if not going_on and run.exists():
            shutil.rmtree(run)  # a run that was killed before it asked anything
        # -P: what lies in the working directory must not hide a package
        command = [sys.executable, "-P", "-m", "proc3s.cli.episode_process", "run"]
        command += self._command(cell, run, going_on)
        with self._lock:
            if self._stopped:
                return Unfinished(cell, "interrupted", "interrupted before it began")
            # the process is this program once more, and asks the provider: it keeps the environment
            process = self._running[cell] = subprocess.Popen(
                command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
            )
        output, complaints = process.communicate()
        with self._lock:
            del self._running[cell]
        return self._outcome(cell, run, output, complaints, process.returncode)

    def _command(self, cell: Cell, run: Path, going_on: bool) -> Iterator[str]:
        spec = self._order.spec
        if going_on:
            yield from ("--resume", str(run), *self._order.again)
        else:
            yield from (cell.task, "--method", cell.method, "--preset", cell.preset, "--seed", str(cell.seed))
            yield from ("--out", str(run), "--no-miss-picture")
            if cell.task in self._order.filmed:
                yield from ("--pictures", "none")  # drawn when the page is made
            for name, value in (("--samples", spec.samples), ("--feedback", spec.feedback)):
                yield from (name, str(value)) if value is not None else ()
            yield from self._order.arguments
        yield from ("--llm", _apart(self._order.llm, spec, cell))
        for option in self._order.llm_options:
            yield from ("-L", option)
        if self._order.llm_jobs is not None:
            yield from ("--llm-jobs", str(self._order.llm_jobs))
        if cell in self._allotted:
            yield from ("--max-cost", repr(self._allotted[cell] + (spent_on(run) or 0.0)))
        yield "--json"

    def _outcome(self, cell: Cell, run: Path, output: str, complaints: str, code: int) -> EpisodeOutcome:
        try:
            summary = Summary.model_validate_json(output)
        except ValueError:
            stopped = "interrupted" if self._stopped else "crashed"
            return Unfinished(cell, stopped, _last_words(code, complaints))
        if summary.stopped is not None or summary.error is not None:
            return Unfinished(cell, summary.stopped or "usage", summary.error or "")
        return self._episode(cell, summary, run)

    def _episode(self, cell: Cell, summary: Summary, run: Path) -> Episode:
        judged = self._order.judged.get(cell.task, False)
        return episode_of(cell, summary, run, f"{RUNS}/{cell.folder}", judged)

    def close(self) -> None:
        """Stop what is under way: as by Ctrl-C first, so that it keeps what it has."""
        with self._lock:
            self._stopped = True
            processes = list(self._running.values())
        for process in processes:
            with contextlib.suppress(ProcessLookupError):
                process.send_signal(signal.SIGINT)
        for process in processes:
            try:
                process.wait(GRACE)
            except subprocess.TimeoutExpired:
                process.kill()


def _ended(run: Path) -> Summary | None:
    """The summary of a run that came to its end, though nobody was left to keep it."""
    found = events_of(run, "run_ended") if (run / LOG).is_file() else []
    summary = Summary.model_validate(found[-1]["summary"]) if found else None
    return summary if summary and summary.stopped is None and summary.error is None else None


def _last_words(code: int, complaints: str) -> str:
    """Why a process ended that left no summary."""
    if code < 0:
        name = signal.Signals(-code).name if -code in [*signal.Signals] else str(-code)
        hint = "; was there memory enough? fewer --jobs take less" if name == "SIGKILL" else ""
        return f"the process of the run was ended by signal {name}{hint}"
    lines = complaints.strip().splitlines() or ["it said nothing"]
    return f"the run ended with code {code} and no summary: {lines[-1]}"


def _begun(run: Path) -> bool:
    """Whether a run folder has a beginning that can be gone on with."""
    return (run / LOG).is_file() and bool(events_of(run, "run_started"))


def spent_on(run: Path) -> float | None:
    """US dollars that the calls of a run have cost up to now, None if unknown; its limit counts them, too."""
    charged = events_of(run, "charged") if (run / LOG).is_file() else []
    return Ledger.model_validate(charged[-1]["ledger"]).cost if charged else 0.0


def _apart(llm: str, spec: SuiteSpec, cell: Cell) -> str:
    """The LLM for a cell: prompts of several presets go to folders of their own, since names do not tell
    them apart."""
    if llm.startswith("manual:") and len(spec.presets) > 1:
        return f"{llm.rstrip('/')}/{cell.preset}"
    return llm


def remaining(spec: SuiteSpec, store: Store) -> list[Cell]:
    """The episodes that are not finished."""
    finished = {episode.cell for episode in store.episodes()}
    return [cell for cell in spec.cells() if cell not in finished]
