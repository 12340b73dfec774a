"""Options of a plugin, validated by the plugin's own model."""

from collections.abc import Mapping

from pydantic import BaseModel

from proc3s import specs
from proc3s.errors import UsageError, blame
from proc3s.specs.yaml_files import validate


def options_model(spec: specs.SolverSpec | specs.LLMSpec) -> type[BaseModel] | None:
    """The pydantic model of the options of a solver or backend. Raises SpecError if it cannot be imported."""
    if spec.options is None:
        return None
    found: type[BaseModel] = specs.Target(target=spec.options).load()
    return found


def part_options(spec: specs.SolverSpec | specs.LLMSpec, given: Mapping[str, str]) -> BaseModel | None:
    """The options of a solver or backend, validated by its own model. Raises SpecError or UsageError."""
    where = f"{spec.kind.removesuffix('s')} {spec.name}"
    model = options_model(spec)
    if model is None:
        if given:
            raise UsageError(f"{where} takes no option {next(iter(given))!r}")
        return None
    with blame(where):  # validators of its own may raise anything
        return validate(model, given, where)
