"""Keys in the environment: no child process gets them, no message shows them."""

import os
import platform
import re
from collections.abc import Iterator
from contextlib import contextmanager

_NAME = re.compile(r"(KEY|TOKEN|SECRET|PASSWORD|PASSWD|CREDENTIAL)S?(_|$)", re.IGNORECASE)
_SHORTEST = 8
"""Shorter values are no keys, and hiding them would garble messages."""


@contextmanager
def without_secrets() -> Iterator[None]:
    """While processes are started in here, variables with the name of a secret are not in the environment."""
    taken = {name: os.environ.pop(name) for name in list(os.environ) if _NAME.search(name)}
    try:
        yield
    finally:
        os.environ.update(taken)


def platform_name() -> str:
    """What `platform.platform()` says, without the process `uname -p` that Python starts for it once, which
    would have every secret in its environment. Later callers in this process start none either."""
    vars(platform.uname()).setdefault("processor", "")
    return platform.platform()


def redacted(text: str) -> str:
    """The text with the value of every secret in the environment replaced by `***`."""
    values = {value for name, value in os.environ.items() if _NAME.search(name) and len(value) >= _SHORTEST}
    for value in sorted(values, key=len, reverse=True):
        text = text.replace(value, "***")
    return text
