"""Packages that come with the extra `tabletop` alone."""

from collections.abc import Iterator
from contextlib import contextmanager

from proc3s import UsageError


@contextmanager
def extra() -> Iterator[None]:
    """Around an import of such a package: where it is not installed, UsageError says how to get it."""
    try:
        yield
    except ModuleNotFoundError as error:
        message = f"the table-top needs {error.name}: pip install 'proc3s[tabletop]'"
        raise UsageError(message) from error
