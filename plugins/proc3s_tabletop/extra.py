"""Packages that come with the extra `tabletop` alone."""

import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from proc3s import UsageError

_OLDER_PYTHON = {"pybullet": (3, 12)}
"""The first Python for which the package has no wheel, so that the extra leaves it out there."""


@contextmanager
def extra() -> Iterator[None]:
    """Around an import of such a package: where it is not installed, UsageError says how to get it."""
    try:
        yield
    except ModuleNotFoundError as error:
        raise UsageError(f"the table-top needs {error.name}{_way_out(error.name or '')}") from error


def _way_out(package: str) -> str:
    if sys.version_info < _OLDER_PYTHON.get(package, (sys.maxsize,)):
        return ": pip install 'proc3s[tabletop]'"
    return (
        f", which has no wheel for Python {platform.python_version()}: make an environment of Python 3.11 "
        "(`uv venv --python 3.11 --seed`) and install proc3s[tabletop] there"
    )
