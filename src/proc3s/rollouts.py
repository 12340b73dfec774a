"""What one worker keeps to roll out plans of one problem: a world, stateful screens, known prefixes."""

from typing import Any

from proc3s.errors import blame
from proc3s.problem import Prefixes, Problem, Trial, rollout
from proc3s.state import Plan


class Rollouts:
    """Gives the trial of a plan; executors make one in each of their workers. Close it after use."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._screens: list[tuple[str, Any]] = []
        for spec in problem.active_screens(stateful=True):
            with blame(f"screen {spec.name}"):
                self._screens.append((spec.name, spec.load()(problem.domain, **spec.args)))
        with blame("world"):
            self._world = problem.domain.make_world()
        self._prefixes = Prefixes(self._world.most_prefixes if problem.prefixes else 0)

    def __call__(self, plan: Plan) -> Trial:
        """The verdict of the first screen that rejects the plan, else of the world."""
        for name, screen in self._screens:
            with blame(f"screen {name}"):
                violation = screen.check(self._problem.initial, plan)
            if violation is not None:
                return Trial(plan, (violation,), violation.step, screen=name)
        with blame("world"):
            return rollout(self._world, self._problem, plan, self._prefixes)

    def close(self) -> None:
        """Close the world, and the screens that can be closed."""
        for _, screen in self._screens:
            if hasattr(screen, "close"):
                screen.close()
        self._world.close()
