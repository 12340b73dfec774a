"""The pages of the reference, made from the command line, the specs, the hooks and what plugins register."""

import inspect
from collections.abc import Iterator
from typing import Any

import typer
from pydantic import BaseModel
from words import render

import proc3s
from proc3s import events, hookspecs, specs, summary
from proc3s.asking import CallOptions
from proc3s.cli import app
from proc3s.options import options_model
from proc3s.registry import Registry, open_registry


def pages() -> dict[str, str]:
    """Markdown by its place in the site."""
    registry = open_registry([])
    return {
        "reference/cli.md": render("cli.md.j2", commands=commands()),
        "reference/domain-yaml.md": render("specs.md.j2", specs=tables(specs.DomainSpec)),
        "reference/hooks.md": render("hooks.md.j2", hooks=hooks(), specs=_registered()),
        "reference/python.md": render("python.md.j2", names=public_names()),
        "reference/run-folder.md": render("run_folder.md.j2", events=_events(), summary=_summary()),
        "reference/plugins.md": render("plugins.md.j2", **_plugins(registry)),
        **{f"reference/{name}.md": text for name, text in _domains(registry)},
    }


def commands() -> list[dict[str, Any]]:
    """Every command with its arguments and options, as its `--help` has them."""
    group: Any = typer.main.get_command(app)
    return [
        {
            "name": name,
            "help": command.help,
            "arguments": [_argument(p) for p in command.params if p.param_type_name == "argument"],
            "options": [_option(p) for p in command.params if p.param_type_name == "option"],
        }
        for name, command in group.commands.items()
    ]


def _argument(param: Any) -> dict[str, Any]:
    name = param.metavar or (param.name or "").upper()
    return {"name": name, "help": param.help or "", "required": param.required}


def _option(param: Any) -> dict[str, Any]:
    """An option; one that stands for yes or no takes no value."""
    names = " / ".join([", ".join(param.opts), *param.secondary_opts])
    value = "" if param.is_flag else param.metavar or param.name.upper()
    return {"name": f"{names} {value}".strip(), "help": param.help or ""}


def tables(*roots: type[BaseModel]) -> list[dict[str, Any]]:
    """A table of fields for each model and for all that it is made of, in the order of their mention."""
    found: dict[str, dict[str, Any]] = {}
    for root in roots:
        schema = root.model_json_schema()
        parts = {root.__name__: schema, **schema.get("$defs", {})}
        for name in _mentioned(root.__name__, parts):
            found.setdefault(name, _table(name, parts[name]))
    return list(found.values())


def _mentioned(name: str, parts: dict[str, Any]) -> list[str]:
    order = [name]
    for known in order:  # it grows while it is read
        order += [n for n in _references(parts[known].get("properties", {})) if n not in order]
    return list(dict.fromkeys(order))


def _references(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        if "$ref" in schema:
            yield schema["$ref"].rsplit("/", 1)[-1]
        schema = list(schema.values())
    if isinstance(schema, list):
        for part in schema:
            yield from _references(part)


def _table(name: str, schema: dict[str, Any]) -> dict[str, Any]:
    required = schema.get("required", ())
    fields = [
        {
            "name": field,
            "type": _type(part),
            "default": "required" if field in required else _default(part.get("default")),
            "says": part.get("description", ""),
        }
        for field, part in schema.get("properties", {}).items()
    ]
    return {"name": name, "says": schema.get("description", ""), "fields": fields}


def _type(schema: dict[str, Any]) -> str:
    """The type of a field in words; specs link to their table."""
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[-1]
        return f"[{name}](#{name.lower()})"
    if "const" in schema or "enum" in schema:
        return ", ".join(f"`{value}`" for value in schema.get("enum", [schema.get("const")]))
    if "anyOf" in schema:
        return " or ".join(_type(part) for part in schema["anyOf"] if part.get("type") != "null")
    if schema.get("type") == "array":
        return f"list of {_type(schema['items'])}" if schema.get("items") else "list"
    if schema.get("type") == "object":
        inner = schema.get("additionalProperties") or next(
            iter(schema.get("patternProperties", {}).values()), None
        )
        return f"mapping of name to {_type(inner)}" if isinstance(inner, dict) else "mapping"
    return str(schema.get("type", "anything"))


def _default(value: Any) -> str:
    return "" if value in (None, [], {}, "") else str(value)


def hooks() -> list[dict[str, str]]:
    """Every hook with its signature and what it is for."""
    found = [f for name, f in vars(hookspecs).items() if inspect.isfunction(f) and hasattr(f, "proc3s_spec")]
    return [{"name": f.__name__, "signature": _signature(f), "doc": inspect.getdoc(f) or ""} for f in found]


def _registered() -> list[dict[str, Any]]:
    """The specs that hooks take, beside those of a domain."""
    kinds = (specs.SamplerSpec, specs.MethodSpec, specs.PresetSpec, specs.SolverSpec)
    return tables(*kinds, specs.LLMSpec, specs.ExecutorSpec, specs.TemplatesSpec)


def public_names() -> list[dict[str, Any]]:
    """What `import proc3s` gives to authors of plugins."""
    found = []
    for name in sorted(proc3s.__all__, key=str.lower):
        thing = getattr(proc3s, name)
        if inspect.isclass(thing) and inspect.getmodule(thing) and thing.__module__.startswith("proc3s"):
            own = [(n, f) for n, f in vars(thing).items() if not n.startswith("_") and _is_method(f)]
            methods = [{"name": n, "doc": inspect.getdoc(_function(f)) or ""} for n, f in own]
            found.append(
                {"name": name, "signature": "", "doc": inspect.getdoc(thing) or "", "methods": methods}
            )
        elif inspect.isfunction(thing):
            doc = inspect.getdoc(thing) or ""
            found.append({"name": name, "signature": _signature(thing), "doc": doc, "methods": []})
        else:
            found.append({"name": name, "signature": "", "doc": f"`{thing!r}`", "methods": []})
    return found


def _is_method(thing: Any) -> bool:
    return inspect.isfunction(thing) or isinstance(thing, property | classmethod | staticmethod)


def _function(thing: Any) -> Any:
    return thing.fget if isinstance(thing, property) else getattr(thing, "__func__", thing)


def _signature(function: Any) -> str:
    return f"{function.__name__}{inspect.signature(function)}".replace("'", "").replace("proc3s.", "")


def _events() -> list[dict[str, Any]]:
    classes = [c for c in vars(events).values() if inspect.isclass(c) and issubclass(c, events.Event)]
    return [
        {
            "name": cls.model_fields["event"].default,
            "doc": inspect.getdoc(cls) or "",
            "fields": [name for name in cls.model_fields if name != "event"],
        }
        for cls in classes
        if isinstance(cls.model_fields["event"].default, str)
    ]


def _summary() -> list[str]:
    return list(summary.Summary.model_fields)


def _plugins(registry: Registry) -> dict[str, Any]:
    """What is installed, by kind; solvers and backends with their options."""
    kinds = (specs.MethodSpec, specs.PresetSpec, specs.SolverSpec, specs.LLMSpec)
    kinds += (specs.ExecutorSpec, specs.SamplerSpec, specs.TemplatesSpec)
    found = {cls.kind: [_listed(spec) for spec in registry.all(cls).values()] for cls in kinds}
    return {
        "kinds": found,
        "call": _options(CallOptions),
        "domains": list(registry.all(specs.DomainSpec).values()),
    }


def _listed(spec: Any) -> dict[str, Any]:
    model = options_model(spec) if isinstance(spec, specs.SolverSpec | specs.LLMSpec) else None
    usage = getattr(spec, "usage", "")
    return {"name": spec.name, "summary": spec.summary, "usage": usage, "options": _options(model)}


def _options(model: type[BaseModel] | None) -> list[dict[str, str]]:
    return [
        {
            "name": name,
            "default": "required" if info.is_required() else _default(info.default),
            "says": info.description or "",
        }
        for name, info in (model.model_fields.items() if model else ())
    ]


def _domains(registry: Registry) -> Iterator[tuple[str, str]]:
    for name in registry.all(specs.DomainSpec):
        domain = registry.domain(name)
        samplers = [sampler.name for sampler in domain.samplers]
        yield f"domain-{name}", render("domain.md.j2", domain=domain.spec, samplers=samplers)
