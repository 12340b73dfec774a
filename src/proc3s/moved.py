"""Old addresses of modules: what was written for an earlier layout goes on loading."""

import importlib
import sys
from collections.abc import Mapping, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any


class MovedModules:
    """A finder and loader of modules that are nowhere else, under the names that they used to have.

    `moved` maps an old name in a package to the modules, in the same package, that have its contents now.
    """

    def __init__(self, package: str, moved: Mapping[str, Sequence[str]]) -> None:
        self._moved = {
            f"{package}.{old}": [f"{package}.{module}" for module in new] for old, new in moved.items()
        }

    def install(self) -> None:
        """Ask here last, after every other finder."""
        sys.meta_path.append(self)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """A spec for a name that moved; None for any other."""
        loader: Any = self  # by its methods: importlib.abc imports half of the standard library
        return ModuleSpec(fullname, loader) if fullname in self._moved else None

    def create_module(self, spec: ModuleSpec) -> None:
        """As Python does by itself."""

    def exec_module(self, module: ModuleType) -> None:
        """Let every attribute be looked up where it is now; whoever imports the old name is warned."""
        import warnings  # not above: nothing may be imported while the working directory is on the path

        homes = self._moved[module.__name__]
        text = f"{module.__name__} has moved to {', '.join(homes)}; the old name will be removed"
        warnings.warn(text, DeprecationWarning, stacklevel=2)

        def look_up(name: str) -> Any:
            for home in homes:
                found = vars(importlib.import_module(home))
                if name in found:
                    return found[name]
            raise AttributeError(
                f"{module.__name__} has moved to {', '.join(homes)}, and has no {name!r} there"
            )

        module.__dict__["__getattr__"] = look_up
