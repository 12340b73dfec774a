"""Whether what a spec names takes what it is called with, and says what a sentence asks for."""

import inspect
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
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
    """Placeholders of a sentence whose name stands nowhere in the code that the margin comes from."""
    wanted = placeholders(spec.says)
    if not wanted or not (known := _words(spec)):
        return
    for name in wanted:
        if name not in known:
            yield "says", f"no margin of {spec.target} carries a detail {name!r}{_near(name, known)}"


def _near(name: str, known: set[str]) -> str:
    hint = did_you_mean(name, known)
    return hint if "did you mean" in hint else ""


def _words(spec: ConstraintSpec) -> set[str]:
    """Every word in the code of the target's package, and of the plugins that its module imports."""
    module = inspect.getmodule(spec.load())
    if module is None:
        return set()
    near = {module.__name__, *(getattr(value, "__module__", None) for value in vars(module).values())}
    packages = {name.partition(".")[0] for name in near if name}
    own = {p for p in packages if p.startswith("proc3s_") or p == module.__name__.partition(".")[0]}
    return {word for path in sorted(_sources(own)) for word in _WORD.findall(_text(path))}


def _sources(packages: set[str]) -> Iterator[Path]:
    for package in packages:
        file = getattr(sys.modules.get(package), "__file__", None)
        path = Path(file or "")
        yield from path.parent.rglob("*.py") if path.name == "__init__.py" else [path]


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
