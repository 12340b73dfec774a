"""Caches the first steps of plans that were carried out, and the states they led to."""

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from proc3s.domain.margins import Violation
from proc3s.domain.room import Room
from proc3s.domain.state import State
from proc3s.domain.values import Action, Plan


@dataclass(frozen=True, eq=False)
class Prefix:
    """The first steps of a plan, carried out without a violation: where they led, and what they left."""

    snapshot: Any
    state: State
    margins: tuple[Mapping[str, float], ...]
    room: Room | None


@dataclass(frozen=True)
class Failed:
    """The first steps of a plan of which the last violates something; it will do so in every such plan."""

    violations: tuple[Violation, ...]
    state: State
    margins: tuple[Mapping[str, float], ...]


class Prefixes:
    """The prefixes used last in one world and from one initial state, at most `size` of them.

    A prefix is known by the one before it and its last action, so no action of a plan is hashed twice.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._known: OrderedDict[tuple[Prefix | None, Action], Prefix] = OrderedDict()
        self._failed: OrderedDict[tuple[Prefix | None, Action], Failed] = OrderedDict()

    def longest(self, plan: Plan) -> Prefix | None:
        """The longest known beginning of a plan, but never the whole plan."""
        found: Prefix | None = None
        for action in plan[:-1] if self._known else ():
            key = (found, action)
            if (longer := self._known.get(key)) is None:
                break
            self._known.move_to_end(key)
            found = longer
        return found

    def keep(self, before: Prefix | None, action: Action, prefix: Prefix) -> None:
        """Store where an action led; the least recently used prefix goes."""
        if self._size:
            self._known[before, action] = prefix
            if len(self._known) > self._size:
                self._known.popitem(last=False)

    def failure(self, before: Prefix | None, action: Action) -> Failed | None:
        """The violation that an action causes after a prefix, if it is known."""
        return self._failed.get((before, action))

    def keep_failure(self, before: Prefix | None, action: Action, failed: Failed) -> None:
        """Store the violation of an action; the oldest failure goes."""
        if self._size:
            self._failed[before, action] = failed
            if len(self._failed) > self._size:
                self._failed.popitem(last=False)
