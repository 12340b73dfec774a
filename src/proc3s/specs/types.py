"""Type names of fields: scalars, lists and dictionaries of types."""

from collections.abc import Mapping

SCALARS: Mapping[str, type] = {"float": float, "int": int, "str": str, "bool": bool}
"""The types of fields that are no types of the domain."""


def split_type(text: str) -> tuple[str, str]:
    """`list[Obstacle]` -> ("list", "Obstacle"); `float` -> ("", "float")."""
    container, bracket, rest = text.partition("[")
    return (container, rest.removesuffix("]")) if bracket else ("", text)
