"""`proc3s explain`."""

import json as json_module

import typer

from proc3s.cli import arguments as a


def explain(
    run: a.Run = None,
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """Say in plain words, round by round, what failed in a run, what changed, and where to look."""
    from proc3s.cli.handlers.runs import chosen_run
    from proc3s.cli.streams import print_document
    from proc3s.plugins.registry import folders_of, open_registry
    from proc3s.reporting.explanation import explain, explained
    from proc3s.reporting.history import read_story

    story, folders = read_story(chosen_run(run)), folders_of(open_registry(plugin or []))
    if json:
        print_document(json_module.dumps(explained(story, folders), indent=2))
    else:
        typer.echo(explain(story, folders), nl=False)
