"""A bar that shows how a search goes, on a terminal or in a notebook."""

from collections import Counter
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from proc3s.runs.events import BatchEvaluated, Event, RoundEnded, SketchLoaded


class SearchProgress:
    """A context manager that hears of events; `samples` is how many a round may take."""

    def __init__(self, samples: int, console: Console | None = None, shown: bool = True) -> None:
        console = console or Console(stderr=True)
        self._samples = samples
        self._progress = Progress(
            TextColumn("  {task.description}"),
            BarColumn(bar_width=24),
            MofNCompleteColumn(),
            TextColumn(
                "samples  {task.fields[rate]}  furthest step {task.fields[reached]}  {task.fields[why]}"
            ),
            TimeElapsedColumn(),
            console=console,
            transient=True,
            disable=not shown,
        )
        self._task = self._progress.add_task(
            "sampling", start=False, visible=False, rate="", reached=0, why=""
        )
        self._why: Counter[str] = Counter()

    def __enter__(self) -> "SearchProgress":
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()

    def update(self, event: Event) -> None:
        """Begin again with a program, go on with its samples."""
        if isinstance(event, SketchLoaded):
            self._why.clear()
            self._progress.reset(
                self._task, total=self._samples, visible=True, rate="", reached=0, why="", start=True
            )
        elif isinstance(event, BatchEvaluated):
            self._sampled(event)
        elif isinstance(event, RoundEnded):
            self._progress.update(self._task, visible=False)

    def _sampled(self, event: BatchEvaluated) -> None:
        self._why.update(name for name in event.violation if name)
        task = self._progress.tasks[0]
        self._progress.update(
            self._task,
            advance=len(event.accepted),
            rate=f"{task.speed:,.0f}/s" if task.speed else "",
            reached=max([task.fields["reached"], *event.reached]),
            why="  ".join(f"{name} {count}" for name, count in self._why.most_common(3)),
        )
