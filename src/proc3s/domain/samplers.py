"""Samplers: maps from the unit cube to values, so that every solver works with every sampler."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from proc3s.domain.values import FloatArray
from proc3s.errors import blame


class Sampler(Protocol):
    """`decode` maps points of [0, 1]^dim, shape (n, dim), to wire columns, shape (n, width)."""

    @property
    def dim(self) -> int:
        """Dimensions of the unit cube that one value takes."""
        ...

    def decode(self, u: FloatArray) -> FloatArray:
        """Values of n samples, one row each."""
        ...


@dataclass(frozen=True)
class ContinuousSampler:
    """A number, uniform between `min` and `max`. Raises ValueError if they are not finite and ordered."""

    min: float
    max: float
    dim = 1

    def __post_init__(self) -> None:
        if not (np.isfinite(self.min) and np.isfinite(self.max)):
            raise ValueError(f"bounds must be finite numbers, not {self.min} and {self.max}")
        if self.min > self.max:
            raise ValueError(f"min {self.min:g} is above max {self.max:g}")

    def decode(self, u: FloatArray) -> FloatArray:
        """Shape (n, 1) to (n, 1)."""
        return np.clip(self.min * (1 - u) + self.max * u, self.min, self.max)


@dataclass(frozen=True)
class DiscreteSampler:
    """One of `values`, each equally likely; crosses as its index. Raises ValueError if there are none."""

    values: Sequence[Any]
    dim = 1

    def __post_init__(self) -> None:
        if not self.values:
            raise ValueError("needs at least one value")

    def decode(self, u: FloatArray) -> FloatArray:
        """Shape (n, 1) to indices of shape (n, 1)."""
        return np.minimum(np.floor(u * len(self.values)), len(self.values) - 1)


def decoded(sampler: Sampler, u: FloatArray) -> FloatArray:
    """`sampler.decode(u)`. Raises SpecError that names the sampler if it raises anything."""
    with blame(f"sampler {type(sampler).__name__}"):
        return sampler.decode(u)


@dataclass(frozen=True)
class Space:
    """The open parameters of a program, in order: each with its sampler.

    `probe` finds out where in the plan each parameter begins to matter; it runs the program.
    """

    samplers: Mapping[str, Sampler]
    probe: Callable[[], Mapping[str, int]] | None = None

    @property
    def dim(self) -> int:
        """Dimensions of the unit cube that a solver searches."""
        return sum(sampler.dim for sampler in self.samplers.values())

    @cached_property
    def influence(self) -> Mapping[str, int]:
        """The first step of the plan that each parameter changes; 0 where that is not known."""
        return self.probe() if self.probe else dict.fromkeys(self.samplers, 0)

    def decode(self, u: FloatArray) -> FloatArray:
        """Points u of shape (n, dim) to wire rows of shape (n, columns)."""
        columns, at = [], 0
        for sampler in self.samplers.values():
            columns.append(decoded(sampler, u[:, at : at + sampler.dim]))
            at += sampler.dim
        return np.hstack(columns) if columns else np.empty((len(u), 0))
