"""The engine that table-tops are simulated with; it is imported when it is first asked for."""

import functools
import importlib

from proc3s_tabletop.engine.protocol import Engine

ENGINES = {"bullet": "proc3s_tabletop.bullet.engine:BulletEngine"}
"""Import strings of the engines by name."""


@functools.cache
def engine(name: str = "bullet") -> Engine:
    """An engine by name."""
    module, _, attribute = ENGINES[name].partition(":")
    made: Engine = getattr(importlib.import_module(module), attribute)()
    return made
