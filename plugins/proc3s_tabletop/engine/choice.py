"""Engines by name; one is imported when it is first asked for."""

import functools
import warnings
from importlib.metadata import EntryPoint, entry_points

from proc3s import UsageError
from proc3s.errors import Notice, did_you_mean
from proc3s_tabletop.engine.protocol import Engine

GROUP = "proc3s_tabletop.engines"
"""Entry points: the name of an engine, and the class that makes its simulations."""

DEFAULT, FALLBACK = "pybullet", "mujoco"
"""The engine of a world that names none, and the one that stands in where the first cannot be imported."""


def names() -> list[str]:
    """The engines that are registered, whether their packages are installed or not."""
    return sorted(point.name for point in entry_points(group=GROUP))


def engine(name: str | None = None) -> Engine:
    """An engine by name, one in a process; the default without.

    Raises UsageError for a name that nobody registered, and where a package is missing that it needs.
    """
    return _made(name or default())


@functools.cache
def default() -> str:
    """The name of the default engine; where its package is missing but not that of the other, a warning."""
    try:
        _made(DEFAULT)
    except UsageError:
        try:
            _made(FALLBACK)
        except UsageError:
            return DEFAULT
        text = f"there is no {DEFAULT} here: table-tops are simulated in {FALLBACK}"
        warnings.warn(text, Notice, stacklevel=3)
        return FALLBACK
    return DEFAULT


@functools.cache
def _made(name: str) -> Engine:
    known = {point.name: point for point in entry_points(group=GROUP)}
    if name not in known:
        raise UsageError(f"there is no physics engine {name!r}{did_you_mean(name, known)}")
    return _loaded(known[name])


def _loaded(point: EntryPoint) -> Engine:
    engine: Engine = point.load()()
    engine.require()
    return engine
