"""The text behind `proc3s list` and `proc3s show`."""

import contextlib
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from proc3s.cli.console.lines import print_line
from proc3s.cli.failures import warn_of_failures
from proc3s.cli.streams import json_of, print_document
from proc3s.errors import SpecError, UsageError, did_you_mean
from proc3s.llm.call_options import CallOptions
from proc3s.plugins.part_options import options_model
from proc3s.plugins.registry import KINDS, Registry, open_registry
from proc3s.specs.base import Spec
from proc3s.specs.domain import DomainSpec, ParamSpec, TaskSpec
from proc3s.specs.parts import LLMSpec, SolverSpec

if TYPE_CHECKING:
    from proc3s.domain.domain import Domain


def print_list(kind: str | None, plugins: Sequence[Path], as_json: bool) -> None:
    """Names and summaries by kind. Raises UsageError for an unknown kind."""
    registry = open_registry(plugins)
    kinds = [*KINDS, "tasks"]
    if kind is not None and kind.rstrip("s") not in [k.rstrip("s") for k in kinds]:
        raise UsageError(f"there is no kind {kind!r}{did_you_mean(kind, kinds)}")
    chosen = [k for k in kinds if kind is None or k.rstrip("s") == kind.rstrip("s")]
    rows = {k: dict(_rows(registry, k)) for k in chosen}
    warn_of_failures(registry)
    if as_json:
        print_document(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    out = Console(highlight=False)
    for name, entries in rows.items():
        if entries:
            table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2))
            table.add_column(no_wrap=True)
            table.add_column(overflow="fold")
            for entry, summary in entries.items():
                table.add_row("  " + escape(entry), escape(summary))
            out.print(f"[bold]{name}[/]")
            out.print(table)


def _rows(registry: Registry, kind: str) -> Iterator[tuple[str, str]]:
    if kind == "tasks":
        for domain in registry.all(DomainSpec).values():
            for task in domain.tasks.values():
                yield f"{domain.name}/{task.name}", task.instruction or "(your own instruction: --goal)"
        return
    for name, spec in registry.all(KINDS[kind]).items():
        yield name, str(getattr(spec, "summary", getattr(spec, "says", "")))


def print_spec(name: str, plugins: Sequence[Path], as_json: bool) -> None:
    """The specs of a name; with `as_json` the first, of kinds that share it. Raises UsageError if none is."""
    registry = open_registry(plugins)
    specs = _find(registry, name)
    warn_of_failures(registry)
    if as_json:
        print_document(json_of(specs[0]))
        return
    out = Console(soft_wrap=True, highlight=False)
    for spec in specs:
        for line in _describe(registry, spec):
            print_line(out, line)


def _find(registry: Registry, name: str) -> list[Spec]:
    """Registered specs, a preset and a suite of one name, say; else a part of a domain."""
    known: dict[str, list[Spec]] = {}
    for cls in KINDS.values():
        for spec_name, spec in registry.all(cls).items():
            known.setdefault(spec_name, []).append(spec)
    for domain in registry.all(DomainSpec).values():
        for part in (domain.tasks, domain.skills, domain.constraints):
            for spec in part.values():
                known.setdefault(f"{domain.name}/{spec.name}", [spec])
                known.setdefault(spec.name, [spec])
    if name not in known:
        raise UsageError(f"there is no {name!r}{did_you_mean(name, known)}")
    return known[name]


def _describe(registry: Registry, spec: Spec) -> Iterator[str]:
    yield f"[bold]{escape(str(getattr(spec, 'name', '')))}[/]  ({spec.kind.removesuffix('s')})"
    if isinstance(spec, DomainSpec):
        yield from _describe_domain(registry.domain(spec.name))
        yield from _describe_programs(registry, spec)
        return
    for field in type(spec).model_fields:
        value = getattr(spec, field)
        if field not in ("name", "args", "options", "check") and value not in ((), {}, None, ""):
            yield f"  {field:10} {escape(_text(value))}"
    if isinstance(spec, LLMSpec) or (isinstance(spec, SolverSpec) and spec.objective == "progress"):
        yield from _describe_options(spec)


def _text(value: Any) -> str:
    if isinstance(value, Spec):
        return value.model_dump_json(exclude_defaults=True)
    if isinstance(value, tuple):
        return ", ".join(map(_text, value))
    if isinstance(value, dict):
        return ", ".join(f"{k}: {_text(v)}" for k, v in value.items())
    return str(value)


def _describe_options(spec: SolverSpec | LLMSpec) -> Iterator[str]:
    """Own options first, then those that every LLM takes."""
    flag = "-S" if isinstance(spec, SolverSpec) else "-L"
    for model in (options_model(spec), CallOptions if isinstance(spec, LLMSpec) else None):
        yield from _options(flag, model) if model else ()


def _options(flag: str, model: type[BaseModel]) -> Iterator[str]:
    for field, info in model.model_fields.items():
        default = "required" if info.is_required() else f"default {info.default}"
        more = "" if info.default is None else f" ({default})"  # what None means, the description says
        yield escape(f"    {flag} {field}=…  {info.description or ''}{more}")


def _describe_domain(domain: "Domain") -> Iterator[str]:
    spec = domain.spec
    yield f"  {escape(spec.summary)}"
    if spec.folder:
        yield f"  folder  {escape(str(spec.folder))}"
    yield "  [bold]types[/]"
    for name, type_spec in spec.types.items():
        fields = ", ".join(f"{n}: {f.type}" for n, f in type_spec.fields.items())
        yield escape(f"    {name}({fields})  {type_spec.summary}")
    yield "  [bold]skills[/]"
    for skill in spec.skills.values():
        params = ", ".join(_param(n, p) for n, p in skill.params.items())
        yield escape(f"    {skill.name}({params})  {skill.summary}")
    yield f"  [bold]samplers[/] {', '.join(s.name for s in domain.samplers)}"
    yield "  [bold]constraints[/]"
    for constraint in spec.constraints.values():
        yield escape(f"    {constraint.name}: {constraint.says}  (tolerance {constraint.tolerance:g})")
    yield "  [bold]tasks[/]"
    for task in spec.tasks.values():
        yield from _describe_task(spec.name, task)
    yield from _describe_world(domain)
    yield f"  [bold]budget[/] {escape(_text(spec.budget))} samples"
    for credit in spec.credits:
        yield f"  [bold]credit[/] {escape(credit)}"


def _describe_programs(registry: Registry, spec: DomainSpec) -> Iterator[str]:
    """The programs that benchmarks run, which `--tasks` takes."""
    from proc3s.benchmark.cases import find_cases  # with NumPy, too

    cases = [case.label for case in find_cases(registry) if case.task.partition("/")[0] == spec.name]
    if cases:
        yield f"  [bold]programs of `proc3s bench`[/] {escape(', '.join(cases))}"


def _describe_world(domain: "Domain") -> Iterator[str]:
    """The options of the world; none of one that cannot be imported, which `proc3s check` says."""
    from proc3s.domain.world_options import options_of  # with NumPy, which a list of names does not need

    with contextlib.suppress(SpecError):
        if options := [*_options("-W", options_of(domain))]:
            yield "  [bold]world[/]"
            yield from options


def _param(name: str, spec: ParamSpec) -> str:
    return f"{name}: {spec.type}" + (f" [{spec.unit}]" if spec.unit else "")


def _describe_task(domain: str, task: TaskSpec) -> Iterator[str]:
    judged = "judged" if task.judge else "not judged"
    yield escape(f"    {domain}/{task.name}  {task.instruction or '(needs --goal)'}  ({judged})")
