"""Our own solvers pass the kit that a third party's solvers pass."""

import pytest

from proc3s.testing.solvers import SolverTests


class TestRejection(SolverTests):
    @pytest.fixture
    def make_solver(self, solvers):
        return solvers("rejection")


class TestGaussian(SolverTests):
    @pytest.fixture
    def make_solver(self, solvers):
        return solvers("gaussian")


class TestBacktracking(SolverTests):
    @pytest.fixture
    def make_solver(self, solvers):
        return solvers("backtracking")


class TestCma(SolverTests):
    @pytest.fixture
    def make_solver(self, solvers):
        return solvers("cma")


class TestPortfolio(SolverTests):
    @pytest.fixture
    def make_solver(self, solvers):
        return solvers("portfolio")
