"""`proc3s replay`."""

from typing import Annotated

from proc3s.cli import arguments as a


def replay(
    *,
    run: a.Run = None,
    given: Annotated[
        a.Given,
        a.fields(
            *("solver", "samples", "improve", "improver", "executor", "solver_options"),
            *("world_options", "plugins"),
        ),
    ],
    out: a.Out = None,
    json: a.Json = False,
) -> None:
    """Solve the last program of a run again, without an LLM. With the same options: the identical plan."""
    from proc3s.cli.handlers.run import replay_run
    from proc3s.cli.handlers.runs import chosen_run

    replay_run(chosen_run(run), given, out, json)
