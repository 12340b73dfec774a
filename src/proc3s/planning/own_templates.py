"""Finds files of a folder of templates that change no prompt, so that the user is told."""

from collections.abc import Iterator
from pathlib import Path

from proc3s import specs
from proc3s.errors import did_you_mean
from proc3s.planning.setup import template_folders
from proc3s.plugins.registry import Registry
from proc3s.prompts.template_files import template_files

_SUFFIXES = {".j2", ".jinja", ".jinja2"}
_COPY = "`proc3s new templates` copies out those that there are"


def unused_templates(registry: Registry, own: Path | None) -> Iterator[str]:
    """A sentence for every template in `own` that no prompt of any domain or method is rendered from."""
    if own is None:
        return
    found = [p for p in sorted(own.rglob("*")) if p.is_file() and p.suffix in _SUFFIXES]
    if not found:
        yield f"--template-dir changes nothing: no template (*.j2) is in {own}; {_COPY}"
        return
    used, computed = _used(registry, [own])
    known, _ = _used(registry, [])
    unused = [p.relative_to(own).as_posix() for p in found if p not in used.values()]
    if computed or not unused:
        return
    for name in unused:
        hint = "; none of yours includes it" if name in known else did_you_mean(name, known)
        more = f"\n  {_COPY}" if name == unused[-1] else ""
        yield f"--template-dir: no prompt uses {name}{hint}{more}"


def _used(registry: Registry, own: list[Path]) -> tuple[dict[str, Path], bool]:
    """Templates of all prompts of all domains, and whether there may be others."""
    methods = registry.all(specs.MethodSpec).values()
    domains = registry.all(specs.DomainSpec).values()
    used: dict[str, Path] = {}
    computed = False
    for folders in {(*own, *template_folders(registry, spec)) for spec in domains}:
        found = template_files(folders, methods)
        used |= found.files
        computed |= found.computed
    return used, computed
