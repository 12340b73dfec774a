"""What some samples show and others do not: when a program is given up for it, and when only the sample."""

import re

from proc3s.sandbox.errors import SketchError
from proc3s.sandbox.protocol import Problems

_FIRST = 3
_ONE_IN = 20
_NUMBER = re.compile(r"\d+")


class Restarts:
    """How often a program may begin again in a fresh process after a sample that hung or killed the last.

    It may so three times; then while this is less than one sample in twenty, and never more than `most`
    times. Only samples are counted, no seconds.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._spent = 0

    def spend(self, error: SketchError, sample: int) -> None:
        """Sample number `sample`, from 0, failed. Raises the error if that is the end of the program."""
        before, self._spent = self._spent, self._spent + 1
        rare = self._spent <= _FIRST or self._spent * _ONE_IN <= sample + 1
        if not error.alone or self._spent > self._most or not rare:
            raise _worded(error, f"{error.message}, as {before} samples had before" if before else "")


def told_of_all(error: SketchError, draws: int) -> SketchError:
    """The error of a program that fails so in all draws."""
    return _worded(error, f"{error.message}, in all of {draws} samples" if draws > 1 else "")


def _worded(error: SketchError, text: str) -> SketchError:
    return type(error)(text or error.message, error.line, error.source, error.issues, error.done)


def in_both(shared: Problems | None, found: Problems) -> Problems:
    """The problems so far that this draw shows, too; numbers in their words make no difference."""
    if shared is None:
        return found
    kinds = {_NUMBER.sub("#", text) for text, _ in found}
    return [(text, line) for text, line in shared if _NUMBER.sub("#", text) in kinds]
