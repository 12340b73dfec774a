"""The plan of a run carried out again: a line for each time, and how often it reached the goal."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.markup import escape

from proc3s.cli.console.lines import print_line
from proc3s.cli.failures import say
from proc3s.cli.streams import print_document
from proc3s.domain.world_options import world_used
from proc3s.planning.known_plan import KnownPlan, plan_of
from proc3s.planning.options import plain_options
from proc3s.planning.repetition import Repetition, repeat, repetitions, require_error
from proc3s.plugins.registry import open_registry
from proc3s.suites.statistics import wilson
from proc3s.wording import count

TIMES = 10
"""How often a plan is carried out with errors."""
_WORDS = {True: "reached", False: "missed", None: "not judged"}


def execute_run(run: Path, given: dict[str, Any], error: float, times: int | None, as_json: bool) -> None:
    """Carry out, print, and end the process: 0 if the goal was reached every time, or nobody judges."""
    require_error(error)
    changes = plain_options(given)
    world_options = changes.pop("world_options", {})
    known = plan_of(run, **changes)
    registry = open_registry(known.options.plugins)
    problem = known.problem(registry, world_options)
    say(known.changes(registry))
    if (times or 1) > repetitions(times or 1, error):
        say(["without an --error every time is the same; the plan is carried out once"])
    done, console = list[Repetition](), Console(highlight=False, quiet=as_json)
    for one in repeat(problem, known.plan, times or TIMES, error):
        reason = "" if done and done[-1].reason == one.reason else one.reason
        done.append(one)
        print_line(console, f"{len(done):>3}  {_WORDS[one.reached]:<7}  {escape(reason)}".rstrip())
    world = world_used(problem.domain)
    if as_json:
        print_document(json.dumps(_document(run, known, world, error, done), indent=2, ensure_ascii=False))
    else:
        print_line(console, escape(_total(world, error, done)))
    raise typer.Exit(int(any(one.reached is False for one in done)))


def _total(world: dict[str, str], error: float, done: Sequence[Repetition]) -> str:
    """How often the goal was reached, in which world, with which error."""
    parts = [
        _verdict(done, intervals=bool(error)),
        world.get("execution"),
        f"{error:g} mm" if error else None,
    ]
    return ", ".join(part for part in parts if part)


def _verdict(done: Sequence[Repetition], intervals: bool) -> str:
    reached = [one.reached for one in done if one.reached is not None]
    if not reached:
        return f"carried out {count(len(done), 'time')}, not judged"
    text = f"{sum(reached)} of {len(reached)} {'reaches' if len(reached) == 1 else 'reach'} the goal"
    share = wilson(sum(reached), len(reached))
    return f"{text} (95 % interval {100 * share.low:.0f} to {100 * share.high:.0f} %)" if intervals else text


def _document(
    run: Path, known: KnownPlan, world: dict[str, str], error: float, done: Sequence[Repetition]
) -> dict[str, Any]:
    reached = [one.reached for one in done if one.reached is not None]
    share = wilson(sum(reached), len(reached)) if reached else None
    return {
        "run_dir": str(run),
        "task": known.options.task,
        "seed": known.options.seed,
        "world": world,
        "error_mm": error,
        "times": len(done),
        "reached": sum(reached) if reached else None,
        "share": share._asdict() if share else None,
        "repetitions": [asdict(one) for one in done],
    }
