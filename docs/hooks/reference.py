"""The pages of the reference, made from the command line, the specs, the hooks and what plugins register."""

import inspect
from collections.abc import Iterator
from typing import Any

import models
import names
import prompt_templates
import toolbox
import typer
from pydantic import BaseModel
from words import render

from proc3s import specs
from proc3s.cli import app
from proc3s.llm.call_options import CallOptions
from proc3s.planning import summary
from proc3s.plugins import hookspecs
from proc3s.plugins.part_options import options_model
from proc3s.plugins.registry import KINDS, Registry, open_registry
from proc3s.runs import events


def pages() -> dict[str, str]:
    """Markdown by its place in the site."""
    registry, registered = open_registry([]), _registered()
    return {
        "reference/cli.md": render("cli.md.j2", commands=commands()),
        "reference/domain-yaml.md": render("specs.md.j2", specs=models.tables(specs.DomainSpec)),
        "reference/hooks.md": render("hooks.md.j2", hooks=hooks(), specs=registered),
        "reference/prompt-templates.md": prompt_templates.page(registered),
        "reference/python.md": render("python.md.j2", names=names.public()),
        "reference/run-folder.md": render(
            "run_folder.md.j2", events=_events(), summary=_described(summary.Summary)
        ),
        "reference/plugins.md": render("plugins.md.j2", **_plugins(registry)),
        **{f"reference/{name}.md": text for name, text in _domains(registry)},
        **toolbox.pages(),
    }


def commands() -> list[dict[str, Any]]:
    """Every command with its arguments and options, as its `--help` has them."""
    return [
        {
            "name": name,
            "help": command.help,
            "arguments": [_argument(p) for p in command.params if p.param_type_name == "argument"],
            "options": [_option(p) for p in command.params if p.param_type_name == "option"],
        }
        for name, command in _leaves(typer.main.get_command(app), "")
    ]


def _leaves(group: Any, above: str) -> Iterator[tuple[str, Any]]:
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from _leaves(command, f"{above}{name} ")
        else:
            yield f"{above}{name}", command


def _argument(param: Any) -> dict[str, Any]:
    name = param.metavar or (param.name or "").upper()
    return {"name": name, "help": param.help or "", "required": param.required}


def _option(param: Any) -> dict[str, Any]:
    """An option; one that stands for yes or no takes no value."""
    names = " / ".join([", ".join(param.opts), *param.secondary_opts])
    value = "" if param.is_flag else param.metavar or param.name.upper()
    return {"name": f"{names} {value}".strip(), "help": param.help or ""}


def hooks() -> list[dict[str, str]]:
    """Every hook with its signature and what it is for."""
    found = [f for name, f in vars(hookspecs).items() if inspect.isfunction(f) and hasattr(f, "proc3s_spec")]
    return [
        {"name": f.__name__, "signature": names.signature(f), "doc": inspect.getdoc(f) or ""} for f in found
    ]


def _registered() -> list[dict[str, Any]]:
    """The specs that hooks take, beside those of a domain."""
    in_domains = {spec["name"] for spec in models.tables(specs.DomainSpec)}
    return [spec for spec in models.tables(*KINDS.values()) if spec["name"] not in in_domains]


def _events() -> list[dict[str, Any]]:
    """Events by the name that they have in the log."""
    classes = [c for c in vars(events).values() if inspect.isclass(c) and issubclass(c, events.Event)]
    return [
        {
            "name": cls.model_fields["event"].default,
            "says": inspect.getdoc(cls),
            "fields": [field for field in _described(cls) if field["name"] != "event"],
        }
        for cls in classes
        if isinstance(cls.model_fields["event"].default, str)
    ]


def _described(model: type[BaseModel]) -> list[dict[str, str]]:
    """Fields of a document with the types that they have in Python."""
    bases = model.__mro__[:-2]  # up to pydantic's own
    kinds = {field["name"]: field["type"] for cls in reversed(bases) for field in names.fields(cls)}
    return [
        {"name": name, "type": kinds[name], "says": info.description or ""}
        for name, info in model.model_fields.items()
    ]


def _plugins(registry: Registry) -> dict[str, Any]:
    """What is installed, by kind; solvers and backends with their options."""
    kinds = [cls for cls in KINDS.values() if cls is not specs.DomainSpec]
    found = {cls.kind: [_listed(spec) for spec in registry.all(cls).values()] for cls in kinds}
    return {
        "kinds": found,
        "call": _options(CallOptions),
        "domains": list(registry.all(specs.DomainSpec).values()),
    }


def _listed(spec: Any) -> dict[str, Any]:
    model = options_model(spec) if isinstance(spec, specs.SolverSpec | specs.LLMSpec) else None
    summary = spec.summary if hasattr(spec, "summary") else f"A violation says: {spec.says}."
    usage = getattr(spec, "usage", "")
    return {"name": spec.name, "summary": summary, "usage": usage, "options": _options(model)}


def _options(model: type[BaseModel] | None) -> list[dict[str, str]]:
    return [
        {
            "name": name,
            "default": "required" if info.is_required() else models.default(info.default),
            "says": info.description or "",
        }
        for name, info in (model.model_fields.items() if model else ())
    ]


def _domains(registry: Registry) -> Iterator[tuple[str, str]]:
    for name in registry.all(specs.DomainSpec):
        domain = registry.domain(name)
        samplers = [sampler.name for sampler in domain.samplers]
        yield f"domain-{name}", render("domain.md.j2", domain=domain.spec, samplers=samplers)
