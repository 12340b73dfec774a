"""Gaussian noise around a fixed plan, as a sketch of its own: one dimension for every perturbed number."""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from proc3s.samplers import Space
from proc3s.state import WIDTH, FloatArray, PlanBatch

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

    `batch` holds the one plan. The paper's Gaussian baselines (appendix) perturb every numeric argument.
    """

    def __init__(self, batch: PlanBatch) -> None:
        self._batch = batch
        params = [p for k in batch.skill for p in batch.signatures[k].params for _ in range(WIDTH[p.type])]
        numeric = [p.type in ("float", "point") for p in params]
        self._noise = np.where(numeric, [p.noise for p in params], 0.0)
        self._low = np.where(numeric, [p.low for p in params], -np.inf)
        self._high = np.where(numeric, [p.high for p in params], np.inf)
        names = {f"number_{i}": Normal(scale) for i, scale in enumerate(self._noise) if scale > 0}
        self.space = Space(names)

    def plans(self, u: FloatArray, first: int = 0) -> PlanBatch:
        """Perturbed plans, one for each row of u; their numbers change nothing."""
        n, base = len(u), self._batch
        values = np.tile(base.values, (n, 1))
        values[:, self._noise > 0] += self.space.decode(u)
        values = np.clip(values, self._low, self._high)
        actions, width = len(base.skill), base.values.size
        offset = np.add.outer(np.arange(n) * width, base.offset[:-1]).ravel()
        return PlanBatch(
            base.signatures,
            start=np.arange(n + 1) * actions,
            skill=np.tile(base.skill, n),
            offset=np.append(offset, n * width),
            values=values.ravel(),
        )
