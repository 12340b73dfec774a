"""Plans that are there already, with what they were made for: of runs, read from their folders."""

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from proc3s.domain.values import Action, Plan
from proc3s.errors import UsageError
from proc3s.planning.limits import make_limits
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import Registry
from proc3s.plugins.versions import versions
from proc3s.runs.reading import events_of, options_of, started
from proc3s.search.problem import Problem
from proc3s.specs.yaml_files import validate


@dataclass(frozen=True)
class KnownPlan:
    """A plan, and the options of the run or search that it comes from.

    `begun` is the first event of its run, which has the scene, the goal and the versions of then.
    """

    options: RunOptions
    plan: Plan
    accepted: bool = True
    """Whether the world accepted it; False for a fallback."""
    begun: Mapping[str, Any] = field(default_factory=dict)
    room: float | None = None
    """In expected errors, as the run had it; None where nothing limits the plan, or nobody knows."""

    def problem(self, registry: Registry, world_options: Mapping[str, str] | None = None) -> Problem:
        """The problem that it is for, in the scene of its run; options of the world replace those of the run.

        Raises UsageError for an option that the world does not have, or a skill that is gone.
        """
        options = self.options.model_copy(
            update={"world_options": {**self.options.world_options, **(world_options or {})}}
        )
        made = make_problem(registry, options, goal_needed=False)
        if gone := {action.skill for action in self.plan} - {*made.domain.spec.skills}:
            raise UsageError(f"{options.task} has no skill {sorted(gone)[0]!r} any more, which the plan uses")
        _, clock = make_limits(options.limits)
        return dataclasses.replace(made, scene=self.begun.get("scene", made.scene), step_limit=clock.step)

    def changes(self, registry: Registry) -> Iterator[str]:
        """What is not as it was when the run began, a sentence each; whatever options its world has."""
        plain = self.options.model_copy(update={"world_options": {}})
        now = make_problem(registry, plain, goal_needed=False)
        if self.begun.get("scene", now.scene) != now.scene:
            yield f"{now.name} has another scene for this seed now; that of the run is used"
        if self.begun.get("goal", now.goal) != now.goal:
            yield f"{now.name} has another instruction now: {now.goal}"
        if self.begun.get("versions", versions()) != versions():
            yield "other versions are installed than when the run began"


def plan_of(run: Path, **changes: Any) -> KnownPlan:
    """The plan that a run carried out; `changes` replace fields of its options. Raises UsageError without."""
    options = validate(RunOptions, {**options_of(run), **changes}, str(run))
    executed = events_of(run, "plan_executed")
    if not executed:
        raise UsageError(f"{run} has no plan to carry out; `proc3s explain {run}` says why")
    plan = tuple(Action.from_json(action) for action in executed[-1]["plan"])
    room = (executed[-1].get("room") or {}).get("value")
    return KnownPlan(options, plan, executed[-1]["executed"] == "solution", started(run), room)
