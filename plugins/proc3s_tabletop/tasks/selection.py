"""Which objects are meant: by name, category or colour."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict

from proc3s.specs.yaml_files import validate


class Selector(BaseModel):
    """Objects that have one of the given names, categories and colours; what is left out is free."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    name: str | tuple[str, ...] = ()
    """`object_0`, …"""
    category: str | tuple[str, ...] = ()
    """A key of `bodies`."""
    color: str | tuple[str, ...] = ()
    """As in the scene."""

    def matches(self, name: str, category: str, color: str) -> bool:
        """Whether an object is meant."""
        wanted = ((self.name, name), (self.category, category), (self.color, color))
        return all(not some or value in _several(some) for some, value in wanted)

    def __str__(self) -> str:
        adjectives = [" or ".join(_several(some)) for some in (self.name, self.color) if some]
        return " ".join([*adjectives, " or ".join(_several(self.category)) or "object"])


def _several(some: str | tuple[str, ...]) -> tuple[str, ...]:
    return (some,) if isinstance(some, str) else some


def selector(given: Mapping[str, Any] | None, where: str) -> Selector:
    """A selector from plain data. Raises SpecError that names `where` and the field."""
    return validate(Selector, given or {}, where)


def select(objects: Mapping[str, Any], chosen: Selector) -> dict[str, Any]:
    """The objects that are meant, by name."""
    return {n: o for n, o in objects.items() if chosen.matches(n, o.category, o.color)}
