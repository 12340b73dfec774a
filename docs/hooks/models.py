"""Tables of the fields of pydantic models, as Markdown has them."""

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel


def tables(*roots: type[BaseModel]) -> list[dict[str, Any]]:
    """A table of fields for each model and for all that it is made of, in the order of their mention."""
    found: dict[str, dict[str, Any]] = {}
    for root in roots:
        schema = root.model_json_schema()
        parts = {root.__name__: schema, **schema.get("$defs", {})}
        for name in _mentioned(root.__name__, parts):
            found.setdefault(name, _table(name, parts[name]))
    return list(found.values())


def _mentioned(name: str, parts: dict[str, Any]) -> list[str]:
    order = [name]
    for known in order:  # it grows while it is read
        order += [n for n in _references(parts[known].get("properties", {})) if n not in order]
    return list(dict.fromkeys(order))


def _references(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        if "$ref" in schema:
            yield schema["$ref"].rsplit("/", 1)[-1]
        schema = list(schema.values())
    if isinstance(schema, list):
        for part in schema:
            yield from _references(part)


def _table(name: str, schema: dict[str, Any]) -> dict[str, Any]:
    required = schema.get("required", ())
    fields = [
        {
            "name": field,
            "type": _type(part),
            "default": "required" if field in required else default(part.get("default")),
            "says": part.get("description", ""),
        }
        for field, part in schema.get("properties", {}).items()
    ]
    return {"name": name, "says": schema.get("description", ""), "fields": fields}


def _type(schema: dict[str, Any]) -> str:
    """The type of a field in words; specs link to their table."""
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[-1]
        return f"[{name}](#{name.lower()})"
    if "const" in schema or "enum" in schema:
        return ", ".join(f"`{value}`" for value in schema.get("enum", [schema.get("const")]))
    if "anyOf" in schema:
        return " or ".join(_type(part) for part in schema["anyOf"] if part.get("type") != "null")
    if schema.get("type") == "array":
        if parts := schema.get("prefixItems"):
            return f"[{', '.join(map(_type, parts))}]"
        return f"list of {_type(schema['items'])}" if schema.get("items") else "list"
    if schema.get("type") == "object":
        inner = schema.get("additionalProperties") or next(
            iter(schema.get("patternProperties", {}).values()), None
        )
        return f"mapping of name to {_type(inner)}" if isinstance(inner, dict) else "mapping"
    return str(schema.get("type", "anything"))


def default(value: Any) -> str:
    """A default as it stands in a table; none for what is empty."""
    return "" if value in (None, [], {}, "") else str(value)
