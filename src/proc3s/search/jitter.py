"""Gaussian noise around a fixed plan, as a sketch of its own: one dimension for every perturbed number."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from proc3s.domain.plan_batch import WIDTH, Parameter, PlanBatch
from proc3s.domain.samplers import Space
from proc3s.domain.transforms import compose
from proc3s.domain.values import FloatArray

_SIX = np.arange(6)
_inv_cdf = np.vectorize(NormalDist().inv_cdf, otypes=[float])


@dataclass(frozen=True)
class Normal:
    """A number with standard deviation `noise`; u = 0.5 is no noise at all."""

    noise: float
    dim = 1

    def decode(self, u: FloatArray) -> FloatArray:
        """Shape (n, 1) in (0, 1) to offsets of shape (n, 1)."""
        tiny = np.finfo(float).tiny
        offsets: FloatArray = _inv_cdf(np.clip(u, tiny, 1 - 2**-53)) * self.noise
        return offsets


class Jitter:
    """A plan whose numbers are the open parameters, with the noise and within the range of their skills.

    `batch` holds the one plan. The paper's Gaussian baselines (appendix) perturb every numeric argument. A
    pose and a grasp are moved and turned by a small transform in their own frame; a grasp that several
    actions on the same objects have is one grasp, and stays so.
    """

    def __init__(self, batch: PlanBatch) -> None:
        params = [param for skill in batch.skill for param in batch.signatures[skill].params]
        columns = [param for param in params for _ in range(WIDTH[param.type])]
        noise = np.concatenate([np.empty(0), *map(_noise, params)])
        self._batch = batch
        self._low, self._high = _range(columns)
        self._rigid = [at for param, at in _placed(params) if param.type in ("pose", "grasp")]
        self._source = _source(batch, len(columns))
        """For each number, the one whose offset it takes: its own, but for a grasp that stands again."""
        own = self._source == np.arange(len(columns))
        self._own = np.flatnonzero((noise > 0) & own)
        self.space = Space({f"number_{i}": Normal(float(noise[i])) for i in self._own.tolist()})

    def plans(self, u: FloatArray, first: int = 0) -> PlanBatch:
        """Perturbed plans, one for each row of u; their numbers change nothing."""
        n, base = len(u), self._batch
        offsets = np.zeros((n, base.values.size))
        offsets[:, self._own] = self.space.decode(u)
        offsets = offsets[:, self._source]
        values = np.clip(base.values + offsets, self._low, self._high)
        for at in self._rigid:
            values[:, at : at + 6] = _moved(base.values[at : at + 6], offsets[:, at : at + 6])
        actions, width = len(base.skill), base.values.size
        offset = np.add.outer(np.arange(n) * width, base.offset[:-1]).ravel()
        return PlanBatch(
            base.signatures,
            start=np.arange(n + 1) * actions,
            skill=np.tile(base.skill, n),
            offset=np.append(offset, n * width),
            values=values.ravel(),
        )


class Repeat(NamedTuple):
    """Where the six numbers of a grasp stand first, and where again."""

    first: int
    again: int


def _repeats(batch: PlanBatch) -> Iterator[Repeat]:
    known: dict[tuple[bytes, bytes], int] = {}
    for action, skill in enumerate(batch.skill.tolist()):
        placed = list(_placed(batch.signatures[skill].params, int(batch.offset[action])))
        named = [at for param, at in placed if param.type == "object"]
        for start in (at for param, at in placed if param.type == "grasp"):
            key = batch.values[named].tobytes(), batch.values[start + _SIX].tobytes()
            if (first := known.setdefault(key, start)) != start:
                yield Repeat(first, start)


def _placed(params: Sequence[Parameter], at: int = 0) -> Iterator[tuple[Parameter, int]]:
    """Every parameter with the column of its first number; they stand one after another, from `at` on."""
    for param in params:
        yield param, at
        at += WIDTH[param.type]


def _source(batch: PlanBatch, width: int) -> NDArray[np.int_]:
    source = np.arange(width)
    for repeat in _repeats(batch):
        source[repeat.again + _SIX] = repeat.first + _SIX
    return source


def _range(columns: Sequence[Parameter]) -> tuple[FloatArray, FloatArray]:
    """The least and the greatest value of each number; only numbers and points have a range."""
    ranged = [param.type in ("float", "point") for param in columns]
    low = np.where(ranged, [param.low for param in columns], -np.inf)
    return low, np.where(ranged, [param.high for param in columns], np.inf)


def _noise(param: Parameter) -> FloatArray:
    """The standard deviation of each number of a parameter."""
    if param.type in ("pose", "grasp"):
        return np.repeat([param.noise, param.turn_noise], 3)
    return np.full(WIDTH[param.type], param.noise if param.type in ("float", "point") else 0.0)


def _moved(pose: FloatArray, by: FloatArray) -> FloatArray:
    """A pose (6,) moved by transforms (n, 6) in its own frame; left to the bit where there is no move."""
    poses = np.broadcast_to(pose, by.shape)
    return np.where(by.any(axis=1, keepdims=True), compose(poses, by), poses)
