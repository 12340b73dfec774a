"""Checks of this installation. They ask no model and spend nothing; `question` does."""

import platform
import re
import site
import sysconfig
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, metadata, requires, version
from pathlib import Path
from typing import Literal

from packaging.markers import Marker
from packaging.requirements import Requirement

from proc3s.checks.finding import Finding
from proc3s.errors import Proc3sError, blame
from proc3s.llm.config import ChosenLLM
from proc3s.planning.llm_backend import Chosen, find_llm, open_llm
from proc3s.plugins.registry import KINDS, Registry
from proc3s.sandbox.box import BoxedSketch, Program
from proc3s.sandbox.errors import SandboxUnavailable, SketchError
from proc3s.sandbox.limits import Limits
from proc3s.specs.base import Target
from proc3s.specs.parts import LLMSpec

_FOR_DEVELOPERS = Marker('extra == "dev"')
_USUAL_PTH = re.compile(r"distutils-precedence|__editable__.*|_virtualenv|.*-nspkg|a1_coverage|pywin32")
"""Files with code that packaging tools leave behind."""


def examine(registry: Registry, llm: ChosenLLM) -> Iterator[Finding]:
    """Findings in the order of a person's questions: does it run, is it whole, can it ask."""
    yield _sandbox()
    yield from _packages()
    yield from _startup_files()
    yield from _plugins(registry)
    yield from _llms(registry, llm)


def _sandbox() -> Finding:
    """A box is opened on an empty program, which it refuses once it is locked."""
    try:
        BoxedSketch(Program("", "program", "", "None", (), ()), Limits()).close()
    except SketchError:
        return Finding(level="ok", subject="sandbox", text="programs run locked in")
    except SandboxUnavailable as error:
        return Finding(level="error", subject="sandbox", text=str(error))
    return Finding(level="error", subject="sandbox", text="an empty program was taken for a plan")


def _packages() -> Iterator[Finding]:
    """Compare every requirement with the installed version."""
    needs = map(Requirement, requires("proc3s") or ())
    wanted = (need for need in needs if need.name != "proc3s" and need.marker != _FOR_DEVELOPERS)
    for need in {need.name: need for need in wanted}.values():
        yield _package(need)


def _package(need: Requirement) -> Finding:
    advice = f"pip install '{need.name}{need.specifier}'"
    try:
        found = version(need.name)
    except PackageNotFoundError:
        if need.marker and not any(need.marker.evaluate({"extra": extra}) for extra in _extras()):
            return _not_for_this_python(need)
        level: Literal["note", "error"] = "note" if need.marker else "error"  # parts of extras may be missing
        return Finding(level=level, subject=need.name, text="is not installed", advice=advice)
    if need.specifier.contains(found, prereleases=True):
        return Finding(level="ok", subject=need.name, text=found)
    text = f"{found} is installed, but only {need.specifier} is known to do"
    return Finding(level="error", subject=need.name, text=text, advice=advice)


def _extras() -> list[str]:
    return metadata("proc3s").get_all("Provides-Extra") or []


def _not_for_this_python(need: Requirement) -> Finding:
    text = f"is not installed: it needs another Python than {platform.python_version()} ({need.marker})"
    advice = "where you need it, make an environment of Python 3.11: uv venv --python 3.11 --seed"
    return Finding(level="note", subject=need.name, text=text, advice=advice)


def _startup_files() -> Iterator[Finding]:
    """`.pth` files that run code whenever Python starts: a place where malicious packages hide."""
    folders = {sysconfig.get_path("purelib"), *site.getsitepackages(), site.getusersitepackages()}
    strange = [
        path
        for folder in sorted(folders)
        for path in sorted(Path(folder).glob("*.pth"))
        if not _USUAL_PTH.fullmatch(path.stem) and _runs_code(path)
    ]
    for path in strange:
        yield Finding(
            level="note",
            subject=".pth files",
            text=f"{path} runs code whenever Python starts",
            advice="look at it; remove it unless you know where it is from",
        )
    if not strange:
        yield Finding(level="ok", subject=".pth files", text="none that runs code of its own")


def _runs_code(path: Path) -> bool:
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return False  # Python cannot read it either
    return any(line.startswith(("import ", "import\t")) for line in lines)


def _plugins(registry: Registry) -> Iterator[Finding]:
    for spec in KINDS.values():
        registry.all(spec)
    failures = registry.plugins.failures
    for status in failures:
        text = f"({status.source}) did not load: {status.error}"
        advice = "fix or uninstall it"
        yield Finding(level="error", subject=f"plugin {status.name}", text=text, advice=advice)
    loaded = len(registry.plugins.statuses) - len(failures)
    yield Finding(level="ok", subject="plugins", text=f"{loaded} loaded")


def _llms(registry: Registry, llm: ChosenLLM) -> Iterator[Finding]:
    """The LLM that is asked by default, then what every backend has to say."""
    chosen: Chosen | None = None
    try:
        chosen = find_llm(registry, llm.name, llm.options)
        open_llm(chosen)
        yield Finding(level="ok", subject="llm", text=f"{llm.name} ({llm.by})")
    except Proc3sError as error:
        yield Finding(level="error", subject="llm", text=f"{llm.name} ({llm.by}): {error}")
    for backend in registry.all(LLMSpec).values():
        if backend.check is None:
            continue
        mine = chosen if chosen and chosen.spec.name == backend.name else None
        try:
            check = Target(target=backend.check).load()
            with blame(f"llm {backend.name}"):
                found = list(check(mine.model, mine.own) if mine else check(None, None))
        except Proc3sError as error:
            found = [Finding(level="error", subject=f"llm {backend.name}", text=str(error))]
        yield from found
