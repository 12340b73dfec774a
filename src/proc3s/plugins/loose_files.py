"""Plugins in Python files, which need no installation."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

from proc3s.errors import UsageError, blame

LOOSE_FILE = "proc3s_plugins.py"

_LOOSE = "__proc3s_loose__"


def loose_files() -> tuple[Path, ...]:
    """The loose plugin files that this process has imported."""
    modules = [module for module in list(sys.modules.values()) if hasattr(module, _LOOSE)]
    return tuple(dict.fromkeys(Path(str(module.__file__)) for module in modules))


def import_loose_file(path: Path) -> ModuleType:
    """Import a plugin from a file, importable by its stem. Raises UsageError if there is none."""
    if not path.is_file():
        raise UsageError(f"there is no file or folder {path}")
    name = f"proc3s_loose_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise UsageError(f"{path} is not a Python file")
    # A loose file names its own functions as "<file stem>:name", so it is importable by its stem.
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    if _free(path.stem):
        sys.modules[path.stem] = module
    setattr(module, _LOOSE, True)
    with blame(f"plugin {path.stem}"):
        spec.loader.exec_module(module)
    return module


def _free(name: str) -> bool:
    """Whether a loose file may be imported by this name: no module has it, but maybe another loose file."""
    other = sys.modules.get(name)
    if other is not None:
        return hasattr(other, _LOOSE)
    found = importlib.util.find_spec(name)
    return found is None or found.origin is None  # a folder without code, such as that of `shelf/shelf.py`
