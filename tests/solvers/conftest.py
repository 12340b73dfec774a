"""Solvers as the registry makes them, and searches in the Drawing domain."""

import math

import pytest

from proc3s import SolverSpec
from proc3s.planning.options import RunOptions
from proc3s.planning.planner import plan
from proc3s.planning.proposals import given_program
from proc3s.planning.setup import make_setup
from proc3s.plugins.part_options import part_options
from proc3s.plugins.registry import open_registry
from proc3s.prompts.extract import extract_program

STROKES = 10


@pytest.fixture(scope="session")
def registry():
    return open_registry()


@pytest.fixture(scope="session")
def solvers(registry):
    """`solvers(name, **options)` gives `make(space, budget, rng)`."""

    def named(name, **options):
        spec = registry.get(SolverSpec, name)
        made = part_options(spec, {key: str(value) for key, value in options.items()})
        return lambda space, budget, rng: spec.load()(space, budget, rng, made)

    return named


@pytest.fixture(scope="session")
def samples_of(registry):
    """How many samples a solver takes for a program in a task of the Drawing domain; None if it fails."""

    def search(task, program, solver, seed, samples=10000):
        options = RunOptions(
            task=f"drawing/{task}", goal="x", solver=solver, seed=seed, samples=samples, feedback=0
        )
        setup = make_setup(registry, options)
        try:
            outcome = plan(setup, given_program(program, "none", 0), lambda event: None)
        finally:
            setup.executor.close()
        assert outcome.error is None
        (attempt,) = outcome.attempts
        return attempt.samples if attempt.solution else None

    return search


def _strokes(names, stroke, domains):
    parameters = [f"{name}{i}" for i in range(STROKES) for name in names]
    actions = ", ".join(f"stroke({', '.join(f'{name}{i}' for name in names)})" for i in range(STROKES))
    samplers = ", ".join(
        f"'{name}{i}': ContinuousSampler({low}, {high})"
        for i in range(STROKES)
        for name, (low, high) in zip(names, domains, strict=True)
    )
    return "\n".join(
        [
            f"def stroke({', '.join(names)}):",
            f"    return Action('draw_line', [{stroke}])",
            f"def gen_plan(initial, {', '.join(parameters)}):",
            f"    return [{actions}]",
            "def gen_domain(initial):",
            f"    return {{{samplers}}}",
        ]
    )


@pytest.fixture(scope="session")
def programs(registry):
    """Name to (task, program): the bundled answers, and two chains of independent strokes."""
    folder = registry.domain("drawing").spec.folder / "answers"
    answers = {
        path.stem: (path.name.split(".")[0], extract_program(path.read_text(encoding="utf-8")))
        for path in sorted(folder.glob("*.proc3s*.md"))
    }
    ends = _strokes(["ax", "ay", "bx", "by"], "ax, ay, bx, by", [(0, 100)] * 4)
    long = _strokes(
        ["x", "y", "way", "length"],
        "x, y, x + length * math.cos(way), y + length * math.sin(way)",
        [(0, 100), (0, 100), (0, 2 * math.pi), (30, 70)],
    )
    return answers | {"chain.ends": ("free", ends), "chain.long": ("free", long)}
