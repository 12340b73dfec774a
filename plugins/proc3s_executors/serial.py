"""Rollouts one after the other in this process."""

from collections.abc import Iterable, Iterator
from typing import Any

from proc3s import Domain, Plan, Problem, Trial, World, rollout


class Serial:
    """Keeps one world, made when the first plan comes."""

    def __init__(self) -> None:
        self._domain: Domain | None = None
        self._world: World[Any] | None = None

    def map(self, problem: Problem, plans: Iterable[Plan]) -> Iterator[Trial]:
        """The trial of every plan, in order, computed when it is taken."""
        for plan in plans:
            yield rollout(self._world_of(problem.domain), problem, plan)

    def _world_of(self, domain: Domain) -> World[Any]:
        if self._world is None or self._domain is not domain:
            self.close()
            self._domain, self._world = domain, domain.make_world()
        return self._world

    def close(self) -> None:
        """Close the world."""
        if self._world is not None:
            self._world.close()
            self._world = None
