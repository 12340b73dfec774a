"""Where a program defines what."""

import ast
import unicodedata
from collections.abc import Iterator
from typing import Any


def as_python_reads(name: Any) -> Any:
    """A name as Python compares it: what looks alike, such as ｘ and x, is the same (NFKC)."""
    return unicodedata.normalize("NFKC", name) if isinstance(name, str) else name


class Lines:
    """Line numbers from a program's syntax tree; the last definition counts."""

    def __init__(self, tree: ast.Module) -> None:
        self._functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        self._assigned = {
            target.id: node.lineno
            for node in tree.body
            if isinstance(node, ast.Assign | ast.AnnAssign)
            for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
            if isinstance(target, ast.Name)
        }
        self._keys = dict(_keys(self._functions.get("gen_domain")))

    def of(self, name: str) -> int | None:
        """The line of a function or of an assignment to a global name."""
        return self._functions[name].lineno if name in self._functions else self._assigned.get(name)

    def of_parameter(self, name: str) -> int | None:
        """The line of a parameter of gen_plan."""
        if "gen_plan" not in self._functions:
            return None
        args = self._functions["gen_plan"].args
        every = [*args.posonlyargs, *args.args, *args.kwonlyargs, *filter(None, (args.vararg, args.kwarg))]
        return next((arg.lineno for arg in every if arg.arg == name), None)

    def of_key(self, name: Any) -> int | None:
        """The line on which gen_domain gives a parameter its sampler."""
        return self._keys.get(as_python_reads(name), self.of("gen_domain"))


def _keys(function: ast.FunctionDef | None) -> Iterator[tuple[str, int]]:
    for node in ast.walk(function) if function else ():
        if isinstance(node, ast.Dict):
            found: list[ast.expr | None] = list(node.keys)
        elif isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):
            found = [node.slice]
        else:
            found = []
            if isinstance(node, ast.keyword) and node.arg:
                yield as_python_reads(node.arg), node.value.lineno
        for key in found:
            if isinstance(key, ast.Constant) and isinstance(key.value, str):
                yield as_python_reads(key.value), key.lineno
