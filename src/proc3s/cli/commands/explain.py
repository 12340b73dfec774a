"""`proc3s explain`."""

import json as json_module

from proc3s.cli import arguments as a


def explain(
    run: a.Run = None,
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """Say in plain words, round by round, what failed in a run, what changed, and where to look."""
    from rich.console import Console
    from rich.markup import escape

    from proc3s.cli.console.lines import print_line
    from proc3s.cli.handlers.runs import chosen_run
    from proc3s.cli.streams import print_document
    from proc3s.plugins.registry import folders_of, open_registry
    from proc3s.reporting.explanation import explain, explained
    from proc3s.reporting.history import read_story

    story, folders = read_story(chosen_run(run)), folders_of(open_registry(plugin or []))
    if json:
        print_document(json_module.dumps(explained(story, folders), indent=2))
    else:
        out = Console(highlight=False)
        for line in explain(story, folders).splitlines():
            print_line(out, escape(line))
