"""Our half of the contract check: builds the samplers that a program asked for, and words what is wrong."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from proc3s.domain.samplers import Sampler, Space, decoded
from proc3s.errors import blame
from proc3s.sandbox.errors import SketchIssue
from proc3s.sandbox.protocol import Contents, Malformed, ReadParameter, Scalar
from proc3s.sandbox.text import Source, clean, message
from proc3s.specs.domain import SamplerSpec

_LONGEST_TEXT = 200


@dataclass(frozen=True)
class OpenParameter:
    """A parameter with its sampler; None where the program gives none that works."""

    name: str
    sampler: Sampler | None

    def drawn(self, rng: np.random.Generator | None = None) -> list[float | None]:
        """A value at random, else that in the middle of the cube, as it crosses."""
        if self.sampler is None:
            return [None]
        shape = (1, self.sampler.dim)
        u = np.full(shape, 0.5) if rng is None else rng.random(shape)
        value: list[float | None] = decoded(self.sampler, u)[0].tolist()
        return value


def open_parameters(
    contents: Contents, specs: Iterable[SamplerSpec], source: Source
) -> tuple[list[OpenParameter], list[SketchIssue]]:
    """The parameters in order, and the samplers' own objections. Raises Malformed."""
    known = {spec.name: spec for spec in specs}
    if len({parameter.name for parameter in contents.parameters}) < len(contents.parameters):
        raise Malformed("a parameter occurs twice")
    parameters, issues = [], []
    for read in contents.parameters:
        try:
            parameters.append(_open(read, known))
        except ValueError as error:
            parameters.append(OpenParameter(read.name, None))
            issues.append(issue(f"gen_domain: {read.name}: {error}", read.line, source))
    return parameters, issues


def _open(read: ReadParameter, known: Mapping[str, SamplerSpec]) -> OpenParameter:
    if read.sampler is None:
        return OpenParameter(read.name, None)
    spec = known.get(read.sampler)
    if spec is None or set(read.args) != set(spec.params):
        raise Malformed("a sampler is unknown")
    args: dict[str, Any] = {}
    for name, kind in spec.params.items():
        value = read.args[name]
        if isinstance(value, list) is not (kind == "list"):
            raise Malformed("a sampler has wrong arguments")
        args[name] = [_cleaned(v) for v in value] if isinstance(value, list) else value
    make = spec.load()
    with blame(f"sampler {spec.name}", ValueError):
        return OpenParameter(read.name, make(**args))


def _cleaned(value: Scalar) -> Scalar:
    return clean(value, _LONGEST_TEXT, keep="") if isinstance(value, str) else value


def space_of(parameters: Iterable[OpenParameter]) -> Space:
    """The space that a solver searches; all parameters must have a sampler."""
    return Space({p.name: p.sampler for p in parameters if p.sampler is not None})


def issue(text: str, line: int | None, source: Source) -> SketchIssue:
    """A breach of the contract, quoting the program's line from our own copy."""
    return SketchIssue(message(text), *source.quote(line))


def in_order(issues: Iterable[SketchIssue]) -> list[SketchIssue]:
    """Issues by line, those about the whole program first, each once."""
    return sorted(dict.fromkeys(issues), key=lambda i: i.line or 0)
