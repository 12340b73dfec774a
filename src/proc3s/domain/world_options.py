"""Options of a world (`-W key=value`): what they change in the two worlds of a domain."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict

from proc3s.domain.domain import Domain
from proc3s.errors import UsageError, blame, did_you_mean
from proc3s.specs.base import Target
from proc3s.specs.yaml_files import validate


class WorldOptions(BaseModel):
    """Options that a world takes on the command line, a field each; by default none.

    The class of the reference world names its model as `options`, for both worlds of a domain.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    def reference_args(self) -> dict[str, Any]:
        """Arguments of the world that accepts plans, in place of those in the domain."""
        return {}

    def execution_args(self) -> dict[str, Any]:
        """Arguments of the world in which accepted plans are carried out."""
        return {}

    @classmethod
    def used(cls, reference: Mapping[str, Any], execution: Mapping[str, Any]) -> dict[str, str]:
        """What two worlds with these arguments really use, by the names of the options.

        The summary of a run says it, and the run keeps to it when it is resumed or replayed.
        """
        return {}


def options_of(domain: Domain) -> type[WorldOptions]:
    """The model of the options of a domain's world. Raises SpecError if the world cannot be imported."""
    model: type[WorldOptions] = getattr(domain.spec.world.load(), "options", WorldOptions)
    return model


def with_world_options(domain: Domain, given: Mapping[str, str]) -> Domain:
    """The domain whose worlds have these options; without any, the same.

    Raises UsageError for an option that the world does not have, SpecError for an unfit value.
    """
    if not given:
        return domain
    spec, model = domain.spec, options_of(domain)
    for name in given:
        if name not in model.model_fields:
            hint = did_you_mean(name, model.model_fields) or "; it takes none"
            raise UsageError(f"the world of {spec.name} has no option {name!r}{hint}")
    where = f"world of {spec.name}"
    with blame(where):  # validators of its own may raise anything
        options = validate(model, given, where)
        world = _with_args(spec.world, options.reference_args())
        execution = _with_args(spec.execution or spec.world, options.execution_args())
    changes = {"world": world, "execution": execution if spec.execution or execution != world else None}
    return Domain(spec.model_copy(update=changes), domain.samplers)


def _with_args(target: Target, args: Mapping[str, Any]) -> Target:
    return target.model_copy(update={"args": {**target.args, **args}})


def world_used(domain: Domain) -> dict[str, str]:
    """What the worlds of a domain really use, e.g. for which simulator; empty where they do not say."""
    spec = domain.spec
    with blame(f"world of {spec.name}"):
        return options_of(domain).used(spec.world.args, (spec.execution or spec.world).args)
