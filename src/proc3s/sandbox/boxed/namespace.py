"""What a program finds around it: names, imports, builtins, and a place to print to.

None of this is the boundary (`lock` is); it makes mistakes readable.
"""

import builtins
import contextlib
import dataclasses
import importlib
import math
import random
import sys
import types
import typing
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from .stubs import Ticks, sys_module, time_module

IMPORTABLE = (
    "__future__", "abc", "bisect", "cmath", "collections", "contextlib", "copy", "dataclasses", "decimal",
    "enum", "fractions", "functools", "graphlib", "heapq", "itertools", "json", "math", "numbers", "numpy",
    "operator", "pprint", "random", "re", "statistics", "string", "sys", "textwrap", "time", "types",
    "typing", "warnings",
)  # fmt: skip
"""Modules that a program may import, besides shapely where it is installed; of `sys` and `time` stand-ins."""
_INSTEAD = {
    "a program has no files": "csv glob io os pathlib pickle shutil tempfile",
    "a program has no processes or threads": "asyncio concurrent multiprocessing signal subprocess threading",
    "a program has no network": "aiohttp http httpx requests socket urllib",
    "a program has no clock": "calendar datetime zoneinfo",
    "print what you want to have logged": "logging traceback",
    "numpy does arithmetic here": "jax matplotlib networkx pandas scipy shapely sklearn sympy torch",
}
"""What to say of modules that programs ask for and cannot have."""
_SUBMODULES = (
    "collections.abc", "encodings.ascii", "encodings.latin_1", "encodings.unicode_escape", "encodings.utf_8",
    "inspect", "numpy.fft", "numpy.linalg", "numpy.ma", "numpy.polynomial", "numpy.random", "numpy.typing",
    "unicodedata",  # the parser asks for it where a name is not ASCII
)  # fmt: skip
_OPTIONAL = ("shapely", "shapely.geometry", "shapely.ops", "shapely.affinity")
_USELESS = ("open", "input", "breakpoint", "exit", "quit", "help")
_TYPING = (
    "Any", "Callable", "Dict", "Iterable", "Iterator", "List", "Literal", "NamedTuple", "Optional",
    "Sequence", "Set", "Tuple", "Union",
)  # fmt: skip


def import_everything() -> tuple[str, ...]:
    """Load all that a program may import, since nothing can be opened later; returns the names."""
    for name in (*IMPORTABLE, *_SUBMODULES):
        importlib.import_module(name)
    available: tuple[str, ...] = IMPORTABLE
    with contextlib.suppress(ImportError):
        for name in _OPTIONAL:
            importlib.import_module(name)
        available += ("shapely",)
    _settle_numpy()
    _make_repeatable()
    return tuple(sorted(available))


def _settle_numpy() -> None:
    """Touch what numpy loads and allocates at first use; keep it quiet and repeatable."""
    np.linalg.norm(np.array([1.0, 2.0]) @ np.eye(2))
    repr(np.zeros(2))
    warnings.simplefilter("ignore")


def _make_repeatable() -> None:
    """Whoever asks for a random seed gets one from `random`, which is seeded for every sample."""
    np.random.bit_generator.randbits = random.getrandbits  # type: ignore[attr-defined]
    seed = random.Random.seed

    def seed_from_random(self: random.Random, a: Any = None, version: int = 2) -> None:
        seed(self, random.getrandbits(64) if a is None else a, version)

    random.Random.seed = seed_from_random  # type: ignore[method-assign]
    random.seed = types.MethodType(seed_from_random, random._inst)


def new_module(name: str, names: dict[str, Any]) -> dict[str, Any]:
    """The namespace of a fresh module; it is registered, because dataclasses look their module up."""
    module = sys.modules[name] = types.ModuleType(name)
    vars(module).update(names)
    return vars(module)


def program_names(
    prelude: dict[str, Any], importable: tuple[str, ...], friendly: bool, ticks: Ticks
) -> dict[str, Any]:
    """What a program may use without import; the names of the prelude win.

    `friendly` leaves out builtins that cannot work here, says what can be imported, and gives stand-ins for
    `sys` and `time`, whose clock is `ticks`.
    """
    names: dict[str, Any] = {"np": np, "numpy": np, "math": math, "random": random}
    names |= {name: getattr(typing, name) for name in _TYPING}
    names |= {"dataclass": dataclasses.dataclass, "field": dataclasses.field}
    names |= {name: value for name, value in prelude.items() if not name.startswith("__")}
    return names | {"__builtins__": _builtins(importable, ticks) if friendly else vars(builtins)}


def _builtins(importable: tuple[str, ...], ticks: Ticks) -> dict[str, Any]:
    stubs = {"sys": sys_module(), "time": time_module(ticks)}

    def limited_import(name: str, *args: Any) -> Any:
        wanted, level = args[2:] if len(args) > 3 else ((), 0)
        # C code, such as numpy's, imports in the program's name, and gives a list
        internal = isinstance(wanted, list)
        if not internal and (level or name.partition(".")[0] not in importable):
            raise ImportError(f"{name!r} cannot be imported here; available: {_available(name, importable)}")
        if not internal and name in stubs:
            return stubs[name]
        return builtins.__import__(name, *args)

    kept = {name: value for name, value in vars(builtins).items() if name not in _USELESS}
    return kept | {"__import__": limited_import}


def _available(name: str, importable: tuple[str, ...]) -> str:
    """What can be imported, and what to do without a module."""
    wanted = name.partition(".")[0]
    hint = next((f" ({says})" for says, names in _INSTEAD.items() if wanted in names.split()), "")
    return ", ".join(importable) + hint


class Output:
    """Where `print` goes: the first `limit` characters are kept until they are taken."""

    encoding = "utf-8"

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.length = 0
        self._parts: list[str] = []

    def write(self, text: str) -> int:
        """Keep what still fits."""
        if self.length < self.limit:
            self._parts.append(text[: self.limit - self.length])
        self.length += len(text)
        return len(text)

    def flush(self) -> None:
        """Nothing to do: the output leaves with the next reply."""

    def isatty(self) -> bool:
        """Never a terminal."""
        return False

    def take(self) -> str:
        """What was printed since the last time."""
        text = "".join(self._parts)
        self._parts.clear()
        self.length = 0
        return text


@contextlib.contextmanager
def noting_lines(action: Any, filename: str, spread: bool) -> Iterator[dict[int, int]]:
    """Note, by id, the line on which the program made each action.

    `spread` also takes the values one by one, as in `Action("draw_line", 1, 2, 3, 4)`.
    """
    lines: dict[int, int] = {}
    make = action.__init__

    def noting_init(self: Any, *args: Any, **kwargs: Any) -> None:
        lines[id(self)] = _line_in(filename, sys._getframe(1))
        make(self, *(_gathered(args) if spread else args), **kwargs)

    action.__init__ = noting_init
    try:
        yield lines
    finally:
        action.__init__ = make


def _gathered(args: tuple[Any, ...]) -> tuple[Any, ...]:
    if len(args) > 2 or (len(args) == 2 and not isinstance(args[1], list | tuple | np.ndarray)):
        return args[0], list(args[1:])
    return args


def _line_in(filename: str, frame: types.FrameType | None) -> int:
    while frame is not None and frame.f_code.co_filename != filename:
        frame = frame.f_back
    return frame.f_lineno if frame is not None else 0
