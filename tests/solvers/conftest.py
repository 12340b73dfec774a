"""Solvers as the registry makes them."""

import pytest

from proc3s import SolverSpec
from proc3s.options import part_options
from proc3s.registry import open_registry


@pytest.fixture(scope="session")
def solvers():
    """`solvers(name, **options)` gives `make(space, budget, rng)`."""
    registry = open_registry()

    def named(name, **options):
        spec = registry.get(SolverSpec, name)
        made = part_options(spec, {key: str(value) for key, value in options.items()})
        return lambda space, budget, rng: spec.load()(space, budget, rng, made)

    return named
