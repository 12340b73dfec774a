"""Suites as data: which tasks, methods, presets and seeds are run against one another."""

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, ClassVar, NamedTuple

from pydantic import Field, PrivateAttr

from proc3s.specs.base import Spec
from proc3s.specs.yaml_files import load_spec

Some = Annotated[tuple[str, ...], Field(min_length=1)]


class Cell(NamedTuple):
    """What tells an episode from the others of its suite."""

    task: str
    method: str
    preset: str
    seed: int

    @property
    def folder(self) -> str:
        """The name of its run folder."""
        return f"{self.task.replace('/', '-')}.{self.method}.{self.preset}.seed{self.seed}"


class SuiteSpec(Spec):
    """A matrix of runs: every task by every method, preset and seed."""

    kind: ClassVar[str] = "suites"
    name: str = Field(pattern=r"^[A-Za-z0-9][\w.-]*$")
    """What `proc3s bench` calls it."""
    summary: str
    """One sentence for `proc3s list`."""
    tasks: Some
    """`domain/task`, in the order of the tables."""
    methods: Some
    """In the order of the tables."""
    presets: Some = ("best",)
    """Presets; with several, every table has a row for each method with each."""
    seeds: int = Field(10, ge=1)
    """Seeds 0 to this less one."""
    samples: int | None = Field(None, ge=1)
    """Samples of a search; by default those of the task for the preset."""
    feedback: int | None = Field(None, ge=0)
    """Feedback rounds; by default those of the method."""
    figures: str | None = None
    """A CSV file beside this one with published figures: quantity, method, domain, task, mean, std."""
    source: str = ""
    """Where the published figures are from."""
    _folder: Path | None = PrivateAttr(default=None)

    @property
    def figures_file(self) -> Path | None:
        """The file of published figures."""
        return self._folder / self.figures if self._folder and self.figures else None

    def cells(self) -> Iterator[Cell]:
        """All of its episodes, the seeds outermost, so that a suite that is broken off has a bit of all."""
        for seed in range(self.seeds):
            yield from (Cell(*c, seed) for c in itertools.product(self.tasks, self.methods, self.presets))


def load_suite(path: Path) -> SuiteSpec:
    """The suite of a YAML file. Raises SpecError with all mistakes at once."""
    spec = load_spec(path, SuiteSpec)
    spec._folder = path.parent
    return spec
