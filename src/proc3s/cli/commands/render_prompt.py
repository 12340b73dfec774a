"""`proc3s render-prompt`."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


class Format(StrEnum):
    """Formats of a rendering."""

    text = "text"
    markdown = "markdown"
    json = "json"


def render_prompt(
    *,
    task: Annotated[
        str | None,
        typer.Argument(metavar="TASK", help="domain/task; with --check also a domain, or nothing"),
    ] = None,
    given: Annotated[
        a.Given,
        a.fields(
            *("method", "method_options", "preset", "template_dir"),
            *("seed", "domain_options", "goal", "plugins"),
        ),
    ],
    round_: Annotated[
        int | None,
        typer.Option("--round", metavar="N", min=0, help="feedback round; needs --from or --failure"),
    ] = None,
    from_: Annotated[
        Path | None, typer.Option("--from", metavar="RUN", help="run folder that has the earlier rounds")
    ] = None,
    failure: Annotated[
        str | None,
        typer.Option(
            "--failure",
            metavar="NAME",
            help="round 1 after a typical failure: of a constraint, goal, timeout, …",
        ),
    ] = None,
    format_: Annotated[
        Format | None,
        typer.Option(
            "--format",
            metavar="FORMAT",
            help="text, markdown or json (default: text, or that of the --diff file)",
        ),
    ] = None,
    diff: Annotated[
        Path | None,
        typer.Option("--diff", metavar="PATH", help="compare with a rendering (file or pipe) or a run"),
    ] = None,
    check: Annotated[
        Path | None,
        typer.Option(
            "--check", metavar="DIR", help="compare all renderings with approved files; exit 2 if they differ"
        ),
    ] = None,
    update: Annotated[bool, typer.Option("--update", help="with --check: approve the renderings")] = False,
) -> None:
    """Print exactly what the LLM would be asked. Calls nobody."""
    from proc3s.cli.failures import say, warn_of_failures
    from proc3s.cli.handlers import approve_prompts as approval
    from proc3s.cli.handlers import render_prompt as renderings
    from proc3s.errors import UsageError
    from proc3s.planning.own_templates import unused_templates
    from proc3s.plugins.registry import open_registry

    registry = open_registry(given.get("plugins", []))
    if check is not None:
        if diff or from_ or round_ or failure or format_:
            raise UsageError(
                "--check compares whole renderings: "
                "it takes no --diff, --from, --round, --failure or --format"
            )
        code = approval.check(registry, check, task, update, given)
        say(unused_templates(registry, given.get("template_dir")))
        raise typer.Exit(code)
    if update:
        raise UsageError("--update goes with --check")
    if task is None:
        raise UsageError("name a task, e.g. drawing/star")
    renderings.require_one_source(round_, from_, failure)
    shown = 1 if failure else round_ or 0
    options = renderings.options_of(task, given, from_)
    messages = renderings.render(registry, options, shown, from_, failure)
    renderings.show(messages, format_.value if format_ else None, diff, shown)
    say(unused_templates(registry, options.template_dir))
    warn_of_failures(registry)
