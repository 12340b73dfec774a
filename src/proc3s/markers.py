"""The pluggy markers of proc3s: how a plugin declares a hook implementation."""

import pluggy

hookspec = pluggy.HookspecMarker("proc3s")


hookimpl = pluggy.HookimplMarker("proc3s")
