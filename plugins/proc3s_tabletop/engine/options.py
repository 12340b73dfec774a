"""Options of table-top worlds: which engine simulates them."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import AfterValidator

from proc3s import UsageError, WorldOptions
from proc3s_tabletop.engine import choice


def _installed(name: str) -> str:
    """Raises ValueError for an engine that nobody registered, UsageError for one that is not installed."""
    if name not in (known := choice.names()):
        raise ValueError(f"must be {' or '.join(known)}")
    try:
        choice.engine(name)
    except UsageError as error:
        raise UsageError(f"engine {name}: {error}; -W chooses another") from error
    return name


EngineName = Annotated[str, AfterValidator(_installed)]


class TabletopOptions(WorldOptions):
    """The engines of the two worlds."""

    engine: EngineName | None = None
    """physics engine, pybullet or mujoco (default: that of the domain)"""
    execution: EngineName | None = None
    """engine that carries accepted plans out (default: the same)"""

    def reference_args(self) -> dict[str, Any]:
        """The engine that accepts plans."""
        return _args(self.engine)

    def execution_args(self) -> dict[str, Any]:
        """The engine that plans are carried out in."""
        return _args(self.execution or self.engine)

    @classmethod
    def used(cls, reference: Mapping[str, Any], execution: Mapping[str, Any]) -> dict[str, str]:
        """Both engines by name, the default one, too."""
        worlds = {"engine": reference, "execution": execution}
        return {option: args.get("engine") or choice.default() for option, args in worlds.items()}


def _args(engine: str | None) -> dict[str, Any]:
    return {"engine": engine} if engine else {}
