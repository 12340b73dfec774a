"""Renderings of prompts: of one task, of a later round, compared with earlier or approved ones."""

import difflib
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.session import run_options
from proc3s.conversation import Exchange, conversation
from proc3s.errors import UsageError
from proc3s.feedback import Diagnosis
from proc3s.llms import Message, digest, estimate_tokens
from proc3s.options import RunOptions, make_problem, make_prompter
from proc3s.registry import Registry
from proc3s.runs import LOG, events_of, markdown
from proc3s.specs import DomainSpec, MethodSpec


def render(registry: Registry, options: RunOptions, round_: int, run: Path | None) -> tuple[Message, ...]:
    """The messages of a round; rounds after the first take answers and diagnoses from a run folder."""
    if round_ and run is None:
        raise UsageError("--round needs --from RUN, which has the answers of the earlier rounds")
    problem = make_problem(registry, options)
    history = _history(run, round_) if run else []
    return conversation(make_prompter(registry, options, problem), problem, history)


def _history(run: Path, rounds: int) -> list[Exchange]:
    answers = {e["round"]: e["completion"]["text"] for e in events_of(run, "answer_received")}
    ended = {e["round"]: e["diagnosis"] for e in events_of(run, "round_ended")}
    for n in range(rounds):
        if n not in answers or n not in ended:
            raise UsageError(
                f"{run} has {min(len(answers), len(ended))} failed round(s), so no prompt of round {rounds}"
            )
    return [Exchange(answers[n], Diagnosis.model_validate(ended[n])) for n in range(rounds)]


def show(messages: tuple[Message, ...], format_: str, diff: Path | None) -> None:
    """Print a rendering, or how it differs; its SHA-256 and size go to stderr."""
    text = _formatted(messages, format_)
    if diff is not None:
        typer.echo("".join(_diff(_earlier(diff, format_), text, str(diff), "now")), nl=False)
    else:
        typer.echo(text, nl=False)
    typer.echo(f"sha256 {digest(messages)}  about {estimate_tokens(messages)} tokens", err=True)


def _formatted(messages: tuple[Message, ...], format_: str) -> str:
    if format_ == "json":
        return json.dumps([m.model_dump() for m in messages], indent=2, ensure_ascii=False) + "\n"
    if format_ == "markdown":
        return markdown(messages)
    return "\n".join(f"[{m.role}: {m.kind}]\n{m.text.rstrip()}\n" for m in messages)


def _earlier(path: Path, format_: str) -> str:
    """The text of an earlier rendering: a file, or the first prompt of a run folder."""
    if (path / LOG).is_file():
        prompts = events_of(path, "prompt_rendered")
        if not prompts:
            raise UsageError(f"{path} has no prompt")
        return _formatted(tuple(Message.model_validate(m) for m in prompts[0]["messages"]), format_)
    if not path.is_file():
        raise UsageError(f"there is no rendering or run {path}")
    return path.read_text(encoding="utf-8")


def _diff(old: str, new: str, old_name: str, new_name: str) -> Iterator[str]:
    return difflib.unified_diff(
        old.splitlines(keepends=True), new.splitlines(keepends=True), old_name, new_name, n=2
    )


def check(registry: Registry, folder: Path, within: str | None, update: bool, given: dict[str, Any]) -> int:
    """Compare all renderings with the approved files; the number is the exit code.

    One file for every task and prompt template: `domain/task.TEMPLATE.md`.
    """
    rendered = dict(_all_renderings(registry, within, given))
    stale = [name for name, text in rendered.items() if _read(folder / name) != text]
    for name in stale:
        path = folder / name
        if update:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(rendered[name], encoding="utf-8")
        else:
            typer.echo(
                "".join(_diff(_read(path) or "", rendered[name], f"approved/{name}", f"now/{name}")), nl=False
            )
    orphans = _orphans(folder, rendered) if within is None else []
    for path in orphans:
        if update:
            path.unlink()
        else:
            typer.echo(f"approved, but no longer rendered: {path}")
    changed = len(stale) + len(orphans)
    typer.echo(f"{len(rendered)} renderings, {_verdict(changed, update)}", err=True)
    return 2 if changed and not update else 0


def _verdict(changed: int, update: bool) -> str:
    if not changed:
        return "all as approved"
    return f"{changed} approved" if update else f"{changed} not as approved; approve them with --update"


def _read(path: Path) -> str | None:
    return path.read_text(encoding="utf-8") if path.is_file() else None


def _orphans(folder: Path, rendered: dict[str, str]) -> Sequence[Path]:
    return [path for path in sorted(folder.rglob("*.md")) if str(path.relative_to(folder)) not in rendered]


def _all_renderings(
    registry: Registry, within: str | None, given: dict[str, Any]
) -> Iterator[tuple[str, str]]:
    """Every task of the domain or task `within`, for the first method of every template."""
    if within is not None and "/" in within:
        registry.task(within)
    elif within is not None:
        registry.get(DomainSpec, within)
    methods = {m.template: m.name for m in reversed(registry.all(MethodSpec).values())}
    if given["method"]:
        chosen = registry.get(MethodSpec, given["method"])
        methods = {chosen.template: chosen.name}
    for domain in registry.all(DomainSpec).values():
        for task in domain.tasks.values():
            name = f"{domain.name}/{task.name}"
            if within not in (None, domain.name, name):
                continue
            for template, method in sorted(methods.items()):
                own = {
                    **given,
                    "method": method,
                    "goal": given["goal"] or task.instruction or "(your instruction)",
                }
                messages = render(registry, run_options(task=name, **own), 0, None)
                yield f"{name}.{template}.md", markdown(messages)
