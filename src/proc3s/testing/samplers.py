"""Conformance kit of samplers: inherit `SamplerTests`, give it a `sampler`, and run pytest."""

from typing import Any

import numpy as np

from proc3s import Sampler


def rows(value: Any, count: int) -> list[Any]:
    """What was decoded of every point, as plain data."""
    found = [np.asarray(row).tolist() for row in value]
    assert len(found) == count, f"decode must return one value for each of {count} points, not {len(found)}"
    return found


class SamplerTests:
    """A sampler is a fixed map from the unit cube. Override the fixture `sampler`."""

    def test_its_dimension_is_a_number_of_columns(self, sampler: Sampler) -> None:
        """`dim` is a whole number, not negative."""
        assert isinstance(sampler.dim, int)
        assert sampler.dim >= 0

    def test_it_decodes_every_point_of_the_cube(self, sampler: Sampler) -> None:
        """Corners included, to finite numbers."""
        u = np.vstack([np.zeros(sampler.dim), np.full(sampler.dim, 1 - 1e-12), self._draw(sampler, 200)])
        for row in rows(sampler.decode(u), len(u)):
            values = np.atleast_1d(np.asarray(row))
            assert values.dtype.kind not in "fc" or np.isfinite(values).all(), row

    def test_it_is_a_function_of_the_point(self, sampler: Sampler) -> None:
        """The same point gives the same value, again and in another batch."""
        u = self._draw(sampler, 50)
        whole = rows(sampler.decode(u), 50)
        assert rows(sampler.decode(u), 50) == whole
        assert [rows(sampler.decode(u[i : i + 1]), 1)[0] for i in range(50)] == whole
        assert rows(sampler.decode(u[::-1]), 50) == whole[::-1]

    def test_it_uses_its_dimensions(self, sampler: Sampler) -> None:
        """Points that differ give values that differ, more than one at least."""
        if sampler.dim:
            assert len({str(row) for row in rows(sampler.decode(self._draw(sampler, 200)), 200)}) > 1

    def test_it_leaves_its_points_alone(self, sampler: Sampler) -> None:
        """The solver uses them again."""
        u = self._draw(sampler, 20)
        before = u.copy()
        sampler.decode(u)
        assert (u == before).all()

    @staticmethod
    def _draw(sampler: Sampler, count: int) -> Any:
        return np.random.default_rng(0).random((count, sampler.dim))
