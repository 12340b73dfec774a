"""Options of a world are those that its own model has, and change the arguments of both its worlds."""

import dataclasses
import pickle
from typing import Literal

import pytest

from proc3s import Domain, SpecError, UsageError, World, WorldOptions
from proc3s.domain.world_options import with_world_options, world_used
from proc3s.planning.options import run_options
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import open_registry
from proc3s.specs.base import Target

REGISTRY = open_registry()
DRAWING = REGISTRY.domain("drawing")


class Steps(WorldOptions):
    integrator: Literal["euler", "implicit"] = "euler"
    execution: Literal["euler", "implicit"] | None = None

    def reference_args(self):
        return {"integrator": self.integrator}

    def execution_args(self):
        return {"integrator": self.execution or self.integrator}

    @classmethod
    def used(cls, reference, execution):
        return {"integrator": reference.get("integrator", "euler"), "execution": execution["integrator"]}


class Stepped(World):
    options = Steps


def stepped(**worlds):
    given = {"world": Target(target=Stepped, args={"gravity": 9.8}), **worlds}
    return Domain(DRAWING.spec.model_copy(update=given), DRAWING.samplers)


def test_a_world_without_options_takes_none():
    with pytest.raises(UsageError, match=r"^the world of drawing has no option 'engine'; it takes none$"):
        with_world_options(DRAWING, {"engine": "any"})
    assert world_used(DRAWING) == {}


def test_an_option_that_a_world_does_not_have_is_refused_with_those_that_it_has():
    with pytest.raises(UsageError, match="no option 'integrater'; did you mean 'integrator'"):
        with_world_options(stepped(), {"integrater": "euler"})
    with pytest.raises(UsageError, match="no option 'dt'; there is execution, integrator"):
        with_world_options(stepped(), {"dt": "1"})


def test_a_value_that_does_not_fit_is_named():
    with pytest.raises(SpecError, match=r"world of drawing: integrator: .*'implicit', not 'rk4'"):
        with_world_options(stepped(), {"integrator": "rk4"})


def test_options_become_arguments_beside_those_of_the_domain():
    spec = with_world_options(stepped(), {"integrator": "implicit"}).spec
    assert spec.world.args == {"gravity": 9.8, "integrator": "implicit"}
    assert spec.execution is None
    assert spec.folder == DRAWING.spec.folder


def test_plans_may_be_carried_out_otherwise_than_they_are_accepted():
    one = with_world_options(stepped(), {"execution": "implicit"})
    two = with_world_options(
        stepped(execution=Target(target=Stepped, args={"gravity": 9.7})), {"execution": "implicit"}
    )
    assert one.spec.execution.args == {"gravity": 9.8, "integrator": "implicit"}
    assert two.spec.execution.args == {"gravity": 9.7, "integrator": "implicit"}
    assert world_used(one) == world_used(two) == {"integrator": "euler", "execution": "implicit"}


def test_without_options_a_domain_is_what_it_was():
    assert with_world_options(DRAWING, {}) is DRAWING


def test_options_are_part_of_the_problem_wherever_it_goes():
    plain = make_problem(REGISTRY, run_options(task="drawing/star"))
    first, second = (
        dataclasses.replace(plain, domain=with_world_options(stepped(), {"integrator": name}))
        for name in ("euler", "implicit")
    )
    assert len({plain, first, second}) == len({hash(p) for p in (plain, first, second)}) == 3
    there = pickle.loads(pickle.dumps(second))
    assert there == second
    assert there.domain.spec.world.args["integrator"] == "implicit"
