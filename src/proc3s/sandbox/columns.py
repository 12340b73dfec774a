"""From the bytes of many plans to a checked `PlanBatch`, without a Python object a sample."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from proc3s.domain.plan_batch import WIDTH, Parameter, PlanBatch, Signature
from proc3s.domain.values import FloatArray
from proc3s.sandbox.errors import SketchContractError, SketchError
from proc3s.sandbox.protocol import Replies

_BOUND = 1e6
"""No number of a plan may be as large as this, whatever its unit."""


class Columns:
    """Builds batches for one list of signatures, which is turned into tables once."""

    def __init__(self, signatures: tuple[Signature, ...]) -> None:
        self.signatures = signatures
        params = [(p, WIDTH[p.type]) for s in signatures for p in s.params]
        self._params = [p for p, width in params for _ in range(width)]
        self._width = np.array([s.width for s in signatures], np.int64)
        self._first = _bounds(self._width)[:-1]
        ranges = np.array([_range(p) for p in self._params], np.float64).reshape(-1, 2)
        self._low, self._high = ranges[:, 0], ranges[:, 1]
        self._whole = np.array([p.type in ("int", "str", "object") for p in self._params], bool)

    def batch(self, replies: Replies) -> PlanBatch:
        """The finished samples, each with a legal plan or an error.

        It ends before the first sample whose skills and values do not fit together, which no honest
        worker sends: then it is shorter than `replies.done`.
        """
        sizes = np.array(replies.sizes, np.int64).reshape(-1, 2)
        skill = np.frombuffer(b"".join(replies.skills), np.uint8)
        values = np.frombuffer(b"".join(replies.values), "<f8")
        honest = self._honest(sizes, skill)
        sizes = sizes[:honest]
        start = _bounds(sizes[:, 0])
        skill = skill[: start[-1]]
        offset = _bounds(self._width[skill])
        values = values[: offset[-1]]
        empty = np.flatnonzero(sizes[:, 0] == 0).tolist()
        errors: dict[int, SketchError] = {i: SketchContractError("the plan is empty") for i in empty}
        errors |= self._illegal(start, skill, offset, values)
        errors |= {i: error for i, error in replies.errors.items() if i < honest}
        logs = {i: log for i, log in replies.logs.items() if i < honest}
        return PlanBatch(self.signatures, start, skill, offset, values, errors, logs)

    def _honest(self, sizes: NDArray[np.int64], skill: NDArray[np.uint8]) -> int:
        """How many samples come before the first that is malformed."""
        known = skill < len(self.signatures)
        start = _bounds(sizes[:, 0])
        width = np.zeros(len(skill), np.int64)
        width[known] = self._width[skill[known]]
        wrong = np.diff(_bounds(width)[start]) != sizes[:, 1]
        wrong |= np.diff(_bounds(~known)[start]) > 0
        return int(np.argmax(wrong)) if wrong.any() else len(sizes)

    def _illegal(
        self,
        start: NDArray[np.int64],
        skill: NDArray[np.uint8],
        offset: NDArray[np.int64],
        values: FloatArray,
    ) -> Mapping[int, SketchError]:
        """The first illegal value of each sample that has one."""
        # which of the parameters' columns each value belongs to
        column = np.repeat((self._first[skill] - offset[:-1]).astype(np.int32), self._width[skill])
        column += np.arange(len(values), dtype=np.int32)
        # step by step, since a batch may be large
        legal = np.abs(values) < _BOUND
        legal &= values >= self._low[column]
        legal &= values <= self._high[column]
        legal &= ~self._whole[column] | (values == np.floor(values))
        wrong = np.flatnonzero(~legal)
        sample, first = np.unique(np.searchsorted(offset[start], wrong, "right") - 1, return_index=True)
        errors: dict[int, SketchError] = {}
        for i, at in zip(sample.tolist(), wrong[first].tolist(), strict=True):
            action = int(np.searchsorted(offset, at, "right")) - 1
            step = action - int(start[i])
            text = _complaint(float(values[at]), self._params[column[at]])
            errors[i] = SketchContractError(f"step {step}, {self.signatures[skill[action]].skill}: {text}")
        return errors


def _bounds(sizes: NDArray[Any]) -> NDArray[np.int64]:
    """Where ragged columns of these sizes begin and end."""
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)


def _range(param: Parameter) -> tuple[float, float]:
    if param.type in ("str", "object"):
        return 0, len(param.choices) - 1
    return (param.low, param.high) if WIDTH[param.type] == 1 else (-np.inf, np.inf)


def _complaint(value: float, param: Parameter) -> str:
    """What is wrong with a value, without the value: the same text for all samples that share the fault."""
    if not abs(value) < _BOUND:
        return f"{param.name} must be a finite number below {_BOUND:g}"
    if param.type in ("str", "object"):
        return f"{param.name} must be one of {', '.join(param.choices)}"
    if param.type == "int" and value != np.floor(value):
        return f"{param.name} must be a whole number"
    if np.isinf(param.high):
        return f"{param.name} must be at least {param.low:g}"
    if np.isinf(param.low):
        return f"{param.name} must be at most {param.high:g}"
    return f"{param.name} must lie between {param.low:g} and {param.high:g}"
