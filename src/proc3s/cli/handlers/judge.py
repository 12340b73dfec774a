"""A person's verdicts on the outcomes of a suite, asked for one by one."""

from pathlib import Path

import typer

from proc3s.plugins.registry import open_registry
from proc3s.runs.pictures import OUTCOME
from proc3s.runs.reading import options_of
from proc3s.suites.export import write_files
from proc3s.suites.outcomes import told
from proc3s.suites.results import Result, Results, read_results
from proc3s.suites.store import Store
from proc3s.wording import count

_QUESTION = "reached? [y]es, [n]o, [s]kip, [q]uit"
_QUIT = ("q", "quit")
_ANSWERS = {"y": True, "yes": True, "n": False, "no": False}


def step_through(folder: Path, everything: bool) -> None:
    """Ask for every outcome that has a plan; verdicts are saved at once, tables rewritten at the end."""
    results, store = read_results(folder), Store(folder)
    todo = [r for r in results.all if r.episode.executed != "none" and (everything or r.verdict is None)]
    if unseen := _nothing_to_see(results):
        typer.echo(f"nothing to look at: {unseen}")
    if not todo:
        typer.echo("nothing is left to judge")
        return
    typer.echo(
        f"{count(len(todo), 'outcome')}; look at each picture and say whether the instruction is fulfilled"
    )
    kept = 0
    for result in todo:
        answer = _ask(folder, result)
        if answer in _QUIT:
            break
        if answer in _ANSWERS:
            why = typer.prompt("why", default="", show_default=False)
            store.judge(result.episode.cell, _ANSWERS[answer], why)
            kept += 1
    if kept:
        write_files(read_results(folder), folder, open_registry())
    typer.echo(f"{count(kept, 'verdict')} kept in {folder}")


def _nothing_to_see(results: Results) -> str:
    """How many episodes have no outcome to look at, by what they have instead."""
    left = [one.word for one in results.unfinished]
    return told([*(r.word for r in results.all if r.episode.executed == "none"), *left])


def _ask(folder: Path, result: Result) -> str:
    """What a person answers; the end of the input is the wish to stop."""
    episode, run = result.episode, folder / result.episode.run_dir
    typer.echo(f"\n{episode.cell.folder}")
    typer.echo(f"  goal     {_goal(run)}")
    typer.echo(f"  machine  {_machine(result)}")
    typer.echo(f"  picture  {run / OUTCOME}")
    try:
        return str(typer.prompt(_QUESTION)).strip().lower()
    except typer.Abort:
        return "q"


def _goal(run: Path) -> str:
    options = options_of(run)
    if options.get("goal"):
        return str(options["goal"])
    _, task = open_registry(tuple(map(Path, options.get("plugins", ())))).task(str(options["task"]))
    return task.instruction or ""


def _machine(result: Result) -> str:
    episode = result.episode
    word = Result(episode).word
    return f"{word}: {episode.goal_reason}" if episode.goal_reason else word
