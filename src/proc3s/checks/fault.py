"""What a check says, before it is put into words for a person."""

import inspect
import re
from dataclasses import dataclass

from proc3s.errors import SpecError
from proc3s.specs.base import Target

_TARGET = re.compile(r"[\w.]+:\w+")


@dataclass(frozen=True)
class Fault:
    """What is wrong; a note where `error` is not set. `where`, `mend` and `why` replace the check's own."""

    text: str
    where: str = ""
    mend: str = ""
    error: bool = True
    why: str = ""


class NotCheckedError(Exception):
    """What a check cannot look at, and why; the reason is found by another check."""


def located(where: str) -> str:
    """`file:line` of what an import string names; anything else as it is."""
    if not _TARGET.fullmatch(where):
        return where
    try:
        named = Target(target=where).load()
        return f"{inspect.getsourcefile(named)}:{inspect.getsourcelines(named)[1]}"
    except (SpecError, TypeError, OSError):
        return where
