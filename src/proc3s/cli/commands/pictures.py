"""`proc3s pictures`."""

from proc3s.cli import arguments as a


def pictures(run: a.Run = None, plugin: a.Plugins = None, json: a.Json = False) -> None:
    """Draw what a run has not drawn yet of its plan: the outcome, and the world after every step."""
    from proc3s.cli.handlers.pictures import print_pictures
    from proc3s.cli.handlers.runs import chosen_run

    print_pictures(chosen_run(run), plugin or [], json)
