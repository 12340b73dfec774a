"""Plugins that are not installed: a Python file, a `domain.yaml`, or a folder of one or of a package."""

import importlib.metadata
import importlib.util
import re
import sys
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError
from proc3s.markers import hookimpl
from proc3s.plugins.loose_files import import_loose_file
from proc3s.plugins.versions import GROUP
from proc3s.specs.domain import DomainSpec
from proc3s.specs.yaml_files import load_domain
from proc3s.textfiles import read_text

DOMAIN_FILE = "domain.yaml"
_PROJECT = "pyproject.toml"
_PACKAGE = "__init__.py"
_ENTRY = re.compile(r"[\w.]+(:[\w.]+)?")


@dataclass(frozen=True)
class LoosePlugin:
    """A plugin that a path has: what it is called, and how it is loaded."""

    name: str
    load: Callable[[], object]


class DomainFile:
    """A plugin that is a `domain.yaml`; its targets may name modules beside it, or the package around it."""

    def __init__(self, path: Path) -> None:
        if not path.is_file():
            raise UsageError(f"there is no file or folder {path}")
        self._path = path

    @hookimpl
    def register_domains(self, register: Callable[[DomainSpec], None]) -> None:
        """The domain that the file describes."""
        folder = self._path.parent.resolve()
        root, package = _root(folder)
        _append(root)
        spec = load_domain(self._path)
        named = {target.partition(":")[0].partition(".")[0] for target in _targets(spec.model_dump())}
        for module in sorted(named):
            beside = (root / f"{module}.py").is_file() or (root / module / _PACKAGE).is_file()
            if beside or package.partition(".")[0] == module:
                _require_in(root, module)
        register(spec)


def loose_plugins(path: Path) -> list[LoosePlugin]:
    """The plugins at a path, not loaded yet. Raises UsageError for a folder that has none."""
    if path.is_dir():
        return _in_folder(path.resolve())
    if path.suffix in (".yaml", ".yml"):
        name = path.resolve().parent.name if path.stem == "domain" else path.stem
        return [LoosePlugin(name, partial(DomainFile, path))]
    return [LoosePlugin(path.stem, partial(import_loose_file, path))]


def _in_folder(folder: Path) -> list[LoosePlugin]:
    if entries := list(_entry_points(folder)):
        return [LoosePlugin(entry.name, partial(_load_entry, folder, entry)) for entry in entries]
    if (folder / _PACKAGE).is_file():
        return [LoosePlugin(folder.name, partial(_load_package, folder))]
    if (folder / DOMAIN_FILE).is_file():
        return [LoosePlugin(folder.name, partial(DomainFile, folder / DOMAIN_FILE))]
    below = sorted(
        {path.parent.name for name in (_PROJECT, DOMAIN_FILE) for path in folder.glob(f"*/{name}")}
    )
    hint = f"; did you mean {folder / below[0]}?" if below else ""
    raise UsageError(
        f"the folder {folder} is no plugin: it has neither a {_PROJECT} with "
        f"[project.entry-points.{GROUP}], nor an {_PACKAGE}, nor a {DOMAIN_FILE}{hint}"
    )


def _entry_points(folder: Path) -> Iterator[importlib.metadata.EntryPoint]:
    """Those of proc3s that the project in a folder would have if it were installed."""
    path = folder / _PROJECT
    if not path.is_file():
        return
    try:
        data: Any = tomllib.loads(read_text(path))
    except (OSError, ValueError) as error:
        raise UsageError(f"{path}: {error}") from error
    for key in ("project", "entry-points", GROUP):
        data = data.get(key) if isinstance(data, Mapping) else None
    for name, value in data.items() if isinstance(data, Mapping) else ():
        if not _ENTRY.fullmatch(str(value)):
            raise UsageError(f"{path}: the entry point {name} = {str(value)!r} names no module")
        yield importlib.metadata.EntryPoint(name, str(value), GROUP)


def _load_entry(folder: Path, entry: importlib.metadata.EntryPoint) -> object:
    """What an entry point names, from the project's folder or its `src`."""
    module = entry.module.partition(".")[0]
    for root in (folder / "src", folder):
        if (root / module / _PACKAGE).is_file() or (root / f"{module}.py").is_file():
            _append(root)
            _require_in(root, module)
            return _named(entry, folder / _PROJECT)
    raise UsageError(f"{folder / _PROJECT} names the package {module}, which is neither here nor in src/")


def _named(entry: importlib.metadata.EntryPoint, file: Path) -> object:
    """The module that an entry point names, or what is named in it."""
    found: object = importlib.import_module(entry.module)
    for name in entry.attr.split(".") if entry.attr else ():
        if not hasattr(found, name):
            raise UsageError(f"{file}: {entry.value} is not there: {entry.module} has no {entry.attr!r}")
        found = getattr(found, name)
    return found


def _load_package(folder: Path) -> object:
    """The package with its hooks; the `domain.yaml` in it, if no hook brings a domain."""
    root, name = _root(folder)
    _append(root)
    _require_in(root, name.partition(".")[0])
    package = importlib.import_module(name)
    if not hasattr(package, "register_domains") and (folder / DOMAIN_FILE).is_file():
        return DomainFile(folder / DOMAIN_FILE)
    if not any(hasattr(getattr(package, one), "proc3s_impl") for one in dir(package)):
        raise UsageError(f"the package {folder} has no hook: a function register_… marked by @hookimpl")
    return package


def _root(folder: Path) -> tuple[Path, str]:
    """Where Python must look to find the package that a folder is, and its dotted name; else the folder."""
    names: list[str] = []
    while (folder / _PACKAGE).is_file():
        names.insert(0, folder.name)
        folder = folder.parent
    return folder, ".".join(names)


def _append(root: Path) -> None:
    """Have Python, and the workers that it starts, look here too; last, so that this hides nothing."""
    if str(root) not in sys.path:
        sys.path.append(str(root))
    importlib.invalidate_caches()


def _require_in(root: Path, module: str) -> None:
    """Raises UsageError if Python finds this module elsewhere."""
    place = _place(module)
    if place is not None and not place.is_relative_to(root):
        raise UsageError(
            f"Python finds {module} in {place} already, so that in {root} is not used; "
            "uninstall that one, rename this one, or leave --plugin out"
        )


def _place(module: str) -> Path | None:
    """The file or folder that a module is, or would be, imported from."""
    try:
        spec = importlib.util.find_spec(module)
    except ValueError:  # it is imported and has none
        return None
    places = [spec.origin, *(spec.submodule_search_locations or ())] if spec else []
    return next((Path(place).resolve() for place in places if place), None)


def _targets(value: Any) -> Iterator[str]:
    """All import strings in plain data."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from [item] if key == "target" and isinstance(item, str) else _targets(item)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _targets(item)
