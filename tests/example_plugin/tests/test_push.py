"""The kits of proc3s, on this package."""

import pytest
from proc3s_push.llm import Shelf
from proc3s_push.solver import Annealed

from proc3s.testing.domains import DomainTests
from proc3s.testing.llms import BackendTests
from proc3s.testing.solvers import SolverTests


class TestPush(DomainTests):
    @pytest.fixture
    def domain_name(self):
        return "push"


class TestAnnealed(SolverTests):
    @pytest.fixture
    def make_solver(self):
        return lambda space, budget, rng: Annealed(space, budget, rng, None)


class TestShelf(BackendTests):
    @pytest.fixture
    def make_llm(self, tmp_path):
        (tmp_path / "domain-task.proc3s.md").write_text("```python\nx = 1\n```\n")
        return lambda: Shelf(str(tmp_path), None)

    @pytest.fixture
    def unable_llm(self, tmp_path):
        return Shelf(str(tmp_path / "nowhere"), None)
