"""The pluggy markers of proc3s: how a plugin declares a hook implementation."""

from typing import TYPE_CHECKING

import pluggy

if TYPE_CHECKING:
    pass


hookspec = pluggy.HookspecMarker("proc3s")


hookimpl = pluggy.HookimplMarker("proc3s")
