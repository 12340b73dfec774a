"""Addresses of objects that are given in place of an import string: a function, a class."""

import itertools
import sys
from typing import Any

_NUMBERS = itertools.count()


def address(target: Any) -> Any:
    """The import string of a callable, as a spec has it; anything else as it is.

    What no module has by that name, a lambda say, is kept in this module: the address holds in this process.
    """
    if not callable(target):
        return target
    module, name = getattr(target, "__module__", ""), getattr(target, "__qualname__", "")
    if getattr(sys.modules.get(module), name, None) is target:
        return f"{module}:{name}"
    key = f"given_{next(_NUMBERS)}"
    globals()[key] = target
    return f"{__name__}:{key}"


def importable(target: str) -> bool:
    """Whether other processes can import an address, too."""
    return target.partition(":")[0] not in ("__main__", __name__)
