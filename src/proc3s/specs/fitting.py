"""Whether what a spec names takes what it is called with, and says what a sentence asks for."""

import functools
import inspect
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from proc3s.errors import SpecError, did_you_mean
from proc3s.specs.base import Target, placeholders
from proc3s.specs.domain import ConstraintSpec

_WORD = re.compile(r"[A-Za-z_]\w*")


def misfits(target: Target, given: int, args: Mapping[str, Any] | None = None) -> Iterator[tuple[str, str]]:
    """(field, what is wrong) with a target that is called with so many values and its arguments by name."""
    try:
        named = target.load()
    except SpecError as error:
        yield from (("target", issue.message) for issue in error.issues)
        return
    if not callable(named):
        yield "target", f"{target.target} is no function or class, but {named!r}"
        return
    try:
        signature = inspect.signature(named)
    except (TypeError, ValueError):
        return  # of some functions in C nobody knows what they take
    try:
        signature.bind(*[None] * given, **(target.args if args is None else args))
    except TypeError as error:
        yield "args" if target.args else "target", f"{target.target} is called with others: {error}"


def unfit_constraint(spec: ConstraintSpec) -> list[tuple[str, str]]:
    """(field, what is wrong) with the margin function of a constraint, or with its sentence."""
    return [*misfits(spec, 1)] or [*_missing_details(spec)]


def _missing_details(spec: ConstraintSpec) -> Iterator[tuple[str, str]]:
    """Placeholders of a sentence that are misspelled: not in the code of the margin, and nearly a word of it.

    A detail may be named in code that is not found, so a name that is near to nothing is let pass.
    """
    module = inspect.getmodule(spec.load())
    own = _words_in(Path(getattr(module, "__file__", None) or ""))
    for name in placeholders(spec.says):
        if name in own or name in (known := _words(_packages(module))):
            continue
        if "did you mean" in (hint := did_you_mean(name, known)):
            yield "says", f"no margin of {spec.target} carries a detail {name!r}{hint}"


def _packages(module: ModuleType | None) -> frozenset[str]:
    """The package of a module, and those that it takes something from."""
    taken = (getattr(value, "__module__", None) for value in vars(module).values()) if module else ()
    names = {module.__name__ if module else "", *taken}
    return frozenset(name.partition(".")[0] for name in names if name)


@functools.cache
def _words(packages: frozenset[str]) -> frozenset[str]:
    """Every word in the code of those packages that are plugins: that name proc3s where they begin."""
    files = (Path(getattr(sys.modules.get(package), "__file__", None) or "") for package in packages)
    plugins = [file for file in files if "proc3s" in _text(file)]
    sources = [s for f in plugins for s in (f.parent.rglob("*.py") if f.name == "__init__.py" else [f])]
    return frozenset(word for path in sources for word in _words_in(path))


def _words_in(path: Path) -> set[str]:
    return set(_WORD.findall(_text(path)))


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
