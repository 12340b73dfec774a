"""`proc3s doctor`."""

from typing import Annotated

import typer

from proc3s.cli import arguments as a


def doctor(
    *,
    given: Annotated[a.Given, a.fields("llm", "llm_options")],
    ask: Annotated[
        bool, typer.Option("--ask", help="ask the LLM one small question: key, model, options, price")
    ] = False,
    more: Annotated[a.Given, a.fields("max_cost", "max_tokens", "max_calls", "plugins")],
    json: a.Json = False,
) -> None:
    """Check this installation: sandbox, packages, keys (never shown), servers. Asks no one without --ask."""
    from proc3s.cli.handlers.doctor import diagnose

    if code := diagnose(given | more, ask, json):
        raise typer.Exit(code)
