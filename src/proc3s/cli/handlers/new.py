"""A plugin begun: a folder of templates rendered into a package."""

import keyword
import re
from collections.abc import Mapping
from pathlib import Path

import typer

from proc3s.errors import UsageError
from proc3s.plugins.registry import Registry, folders_of, open_registry
from proc3s.reporting.templates import ReportTemplates
from proc3s.specs.base import Spec
from proc3s.specs.domain import DomainSpec
from proc3s.specs.parts import LLMSpec, SolverSpec

SUFFIX = ".j2"
KINDS: Mapping[str, tuple[type[Spec], str, tuple[str, ...]]] = {
    "domain": (
        DomainSpec,
        "A domain for proc3s.",
        ("proc3s check {folder}", "proc3s run {name}/gather --plugin {folder}"),
    ),
    "solver": (
        SolverSpec,
        "A solver for proc3s.",
        ("proc3s run drawing/star --solver {name} --plugin {folder}",),
    ),
    "llm": (LLMSpec, "A language-model backend for proc3s.", ("proc3s show {name} --plugin {folder}",)),
}
"""Kind, description of the package, and what to try first."""


def begin(kind: str, name: str, folder: Path) -> None:
    """Write the package. Raises UsageError for a name that cannot be one, or is taken, or a folder in use."""
    spec, says, first = KINDS[kind]
    registry = open_registry()
    _require_name(registry, spec, name)
    refuse_in_use(folder)
    source = next((f / "new" / kind for f in folders_of(registry) if (f / "new" / kind).is_dir()), None)
    if source is None:
        raise UsageError(f"no plugin brings templates for a {kind} (new/{kind}/)")
    package = f"proc3s_{name}"
    words = {"name": name, "package": package, "distribution": package.replace("_", "-"), "says": says}
    renderer = ReportTemplates([source])
    for path in sorted(p for p in source.rglob(f"*{SUFFIX}")):
        inside = path.relative_to(source).as_posix()
        target = folder / inside.removesuffix(SUFFIX).replace("PACKAGE", package).replace("NAME", name)
        text = renderer.render(inside, **words).rstrip("\n") + "\n"
        write(target, text.encode())
    typer.echo(f"{folder} is a package that installs and passes its tests:")
    typer.echo(f"  pip install -e '{folder}[dev]' && pytest {folder}")
    for command in first:
        typer.echo(f"  {command.format(name=name, folder=folder)}")


def _require_name(registry: Registry, spec: type[Spec], name: str) -> None:
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name):
        raise UsageError(
            f"{name!r} is no name of a package: lower-case letters, digits and _, a letter first"
        )
    if name in registry.all(spec):
        raise UsageError(f"there is a {spec.kind.removesuffix('s')} {name!r} already; choose another name")


def refuse_in_use(folder: Path) -> None:
    """Raises UsageError for a folder that has something in it, or a file."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise UsageError(f"{folder} is there already and not empty; name another folder by --dir")


def write(path: Path, data: bytes) -> None:
    """Write a file and make the folders above it. Raises UsageError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    except OSError as error:
        raise UsageError(f"{path} cannot be written: {error.strerror}") from error
