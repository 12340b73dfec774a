"""Gaussian noise around a fixed plan, as a sketch of its own: one dimension for every perturbed number."""

from collections.abc import Iterator
from dataclasses import dataclass
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

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
        self._batch = batch
        params = [p for k in batch.skill for p in batch.signatures[k].params]
        starts = np.cumsum([0, *(WIDTH[p.type] for p in params)])[:-1].tolist()
        columns = [p for p in params for _ in range(WIDTH[p.type])]
        ranged = [p.type in ("float", "point") for p in columns]
        self._low = np.where(ranged, [p.low for p in columns], -np.inf)
        self._high = np.where(ranged, [p.high for p in columns], np.inf)
        self._rigid = [at for p, at in zip(params, starts, strict=True) if p.type in ("pose", "grasp")]
        self._source = np.arange(len(columns))
        for repeat in _repeats(batch):
            self._source[repeat.again + _SIX] = repeat.first + _SIX
        noise = np.array([scale for p in params for scale in _noise(p)], float)
        self._own = np.flatnonzero((noise > 0) & (self._source == np.arange(len(columns))))
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
        params, at = batch.signatures[skill].params, int(batch.offset[action])
        starts = np.cumsum([at, *(WIDTH[p.type] for p in params)])[:-1].tolist()
        named = [start for p, start in zip(params, starts, strict=True) if p.type == "object"]
        for start in (start for p, start in zip(params, starts, strict=True) if p.type == "grasp"):
            key = batch.values[named].tobytes(), batch.values[start + _SIX].tobytes()
            if (first := known.setdefault(key, start)) != start:
                yield Repeat(first, start)


def _noise(param: Parameter) -> FloatArray:
    """The standard deviation of each number of a parameter."""
    if param.type in ("pose", "grasp"):
        return np.repeat([param.noise, param.turn_noise], 3)
    return np.full(WIDTH[param.type], param.noise if param.type in ("float", "point") else 0.0)


def _moved(pose: FloatArray, by: FloatArray) -> FloatArray:
    """A pose (6,) moved by transforms (n, 6) in its own frame; left to the bit where there is no move."""
    poses = np.broadcast_to(pose, by.shape)
    return np.where(by.any(axis=1, keepdims=True), compose(poses, by), poses)
