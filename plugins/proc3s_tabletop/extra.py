"""Packages that come with an extra alone."""

import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from proc3s import UsageError

_OLDER_PYTHON = {"pybullet": (3, 12)}
"""The first Python for which the package has no wheel, so that the extra leaves it out there."""


@contextmanager
def extra(name: str = "tabletop") -> Iterator[None]:
    """Around an import of a package of an extra: where it is not installed, UsageError says how to get it."""
    try:
        yield
    except ModuleNotFoundError as error:
        raise UsageError(f"the table-top needs {error.name}{_way_out(error.name or '', name)}") from error


def _way_out(package: str, extra: str) -> str:
    if sys.version_info < _OLDER_PYTHON.get(package, (sys.maxsize,)):
        return f": pip install 'proc3s[{extra}]'"
    return (
        f", which has no wheel for Python {platform.python_version()}: take another engine by "
        "pip install 'proc3s[mujoco]', or make an environment of Python 3.11 "
        "(`uv venv --python 3.11 --seed`) and install proc3s[tabletop] there"
    )
