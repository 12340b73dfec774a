"""`proc3s schema`."""

from typing import Annotated

import typer


def schema(
    kind: Annotated[str, typer.Argument(metavar="KIND", help="domain, method, solver, …")] = "domain",
) -> None:
    """Print the JSON schema of a spec, for editors and checkers."""
    import json

    from proc3s.errors import UsageError, did_you_mean
    from proc3s.plugins.registry import KINDS

    known = {name.removesuffix("s"): cls for name, cls in KINDS.items()}
    if kind.removesuffix("s") not in known:
        raise UsageError(f"there is no spec {kind!r}{did_you_mean(kind, known)}")
    typer.echo(json.dumps(known[kind.removesuffix("s")].model_json_schema(), indent=2))
