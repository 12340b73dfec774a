"""State classes, made from the types of a `domain.yaml`."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from pydantic import ConfigDict, TypeAdapter

if TYPE_CHECKING:
    from proc3s.specs.domain import FieldSpec, TypeSpec
from proc3s.specs.types import SCALARS, split_type


@dataclass(frozen=True)
class State:
    """Base of the frozen state classes that are made from the types of a `domain.yaml`."""


class StateModel:
    """The state classes of a domain: parse plain data into a frozen `State`, and dump it again.

    `types` maps the names of the spec to frozen dataclasses, `root` names the one that is the state.
    """

    def __init__(self, types: "Mapping[str, TypeSpec]", root: str) -> None:
        self.types: dict[str, type[State]] = {}
        for name in _dependency_order(types):
            self.types[name] = self._make(name, types[name].fields)
        self._adapter: TypeAdapter[State] = TypeAdapter(self.types[root])

    def parse(self, data: Mapping[str, Any] | State) -> State:
        """The state that plain data describes. Raises `pydantic.ValidationError`."""
        return self._adapter.validate_python(data)

    def dump(self, state: State) -> dict[str, Any]:
        """Plain data that `parse` turns back into an equal state; JSON can hold it."""
        data: dict[str, Any] = self._adapter.dump_python(state, mode="json")
        return data

    def _make(self, name: str, fields: "Mapping[str, FieldSpec]") -> type[State]:
        members = [(n, self._annotation(f.type), _default(f)) for n, f in fields.items()]
        made = dataclasses.make_dataclass(name, members, bases=(State,), frozen=True)
        made.__pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)  # type: ignore[attr-defined]
        return made

    def _annotation(self, text: str) -> Any:
        container, inner = split_type(text)
        scalar: Any = SCALARS.get(inner) or self.types[inner]
        return {"": scalar, "list": tuple[scalar, ...], "dict": dict[str, scalar]}[container]


def _default(spec: "FieldSpec") -> Any:
    value = tuple(spec.default) if isinstance(spec.default, list) else spec.default
    if spec.required:
        return field()
    return field(default_factory=lambda: dict(value)) if isinstance(value, dict) else field(default=value)


def _dependency_order(types: "Mapping[str, TypeSpec]") -> list[str]:
    done: list[str] = []

    def visit(name: str) -> None:
        if name in types and name not in done:
            for spec in types[name].fields.values():
                visit(split_type(spec.type)[1])
            done.append(name)

    for name in types:
        visit(name)
    return done
