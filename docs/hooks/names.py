"""What `import proc3s` gives, read from the source: classes with fields and methods, functions."""

import ast
import inspect
import itertools
import textwrap
from collections.abc import Iterator
from typing import Any

import proc3s
from proc3s.specs.base import Spec

_WORDS = {
    "FloatArray": "A numpy array of floats.",
    "Plan": "A tuple of ground actions.",
    "hookimpl": "Marks a function of a plugin as a hook: `@hookimpl`.",
}
"""Names that are neither classes nor functions, and so have no text of their own."""


def public() -> list[dict[str, Any]]:
    """What authors of plugins import, by name. Fields of specs stand in tables of their own."""
    return [_public(name, getattr(proc3s, name)) for name in sorted(proc3s.__all__, key=str.lower)]


def _public(name: str, thing: Any) -> dict[str, Any]:
    shown = {"name": name, "signature": "", "doc": inspect.getdoc(thing) or "", "fields": [], "methods": []}
    if inspect.isfunction(thing):
        return {**shown, "signature": signature(thing)}
    if not inspect.isclass(thing) or not thing.__module__.startswith("proc3s"):
        return {**shown, "doc": _WORDS.get(name, "")}
    own = [] if issubclass(thing, Spec) else list(fields(thing))
    return {**shown, "fields": own, "methods": list(_methods(thing))}


def fields(cls: type) -> Iterator[dict[str, str]]:
    """Fields that a class declares, in order, each with the text that stands under it, if any."""
    body = _node(cls).body
    for part, after in itertools.zip_longest(body, body[1:]):
        if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name):
            kind = ast.unparse(part.annotation)
            if not part.target.id.startswith("_") and not kind.startswith("ClassVar"):
                default = ast.unparse(part.value) if part.value else "required"
                yield {"name": part.target.id, "type": kind, "default": default, "says": _text(after)}


def _text(node: ast.stmt | None) -> str:
    """What a string that stands alone says."""
    value = node.value if isinstance(node, ast.Expr) else None
    return value.value if isinstance(value, ast.Constant) and isinstance(value.value, str) else ""


def _methods(cls: type) -> Iterator[dict[str, str]]:
    for name, thing in vars(cls).items():
        function = thing.fget if isinstance(thing, property) else getattr(thing, "__func__", thing)
        own = inspect.isfunction(function) and function.__qualname__ == f"{cls.__name__}.{name}"
        if own and not name.startswith("_"):
            call = name if isinstance(thing, property) else signature(function)
            yield {"name": name, "signature": call, "doc": inspect.getdoc(function) or ""}


def signature(function: Any) -> str:
    """Name, parameters and result as they stand in the source."""
    node = _node(function)
    first = [arg for arg in node.args.args[:1] if arg.arg in ("self", "cls")]
    node.args.args = node.args.args[len(first) :]
    for arg in (*node.args.args, *node.args.kwonlyargs):
        arg.annotation = _unquoted(arg.annotation)
    returns = f" -> {ast.unparse(_unquoted(node.returns))}" if node.returns else ""
    return f"{node.name}({ast.unparse(node.args)}){returns}"


def _unquoted(annotation: Any) -> Any:
    """What an annotation in quotes says."""
    is_text = isinstance(annotation, ast.Constant) and isinstance(annotation.value, str)
    return ast.parse(annotation.value, mode="eval").body if is_text else annotation


def _node(thing: Any) -> Any:
    """The definition of a class or function in its source."""
    return ast.parse(textwrap.dedent(inspect.getsource(thing))).body[0]
