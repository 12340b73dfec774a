"""Plugins: entry points and loose files, each loaded in its own `try`, wrapped in one typed manager."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

import pluggy

from proc3s.errors import Issue, Proc3sError, SpecError, UsageError, blame, did_you_mean
from proc3s.plugins import hookspecs
from proc3s.plugins.loose_files import LOOSE_FILE
from proc3s.plugins.loose_folders import loose_plugins
from proc3s.plugins.versions import GROUP, headers
from proc3s.specs.base import Spec
from proc3s.specs.domain import DomainSpec


@dataclass(frozen=True)
class PluginStatus:
    """What became of one plugin: `error` is None if it loaded."""

    name: str
    source: str
    version: str | None = None
    error: str | None = None


class PluginManager:
    """Loads plugins and calls their hooks; a broken plugin is recorded and never stops the others.

    `files` are loose plugin files named on the command line: those must load, or SpecError / UsageError
    is raised. `proc3s_plugins.py` in the working directory is loaded too.
    """

    def __init__(self, files: Sequence[Path] = (), given: Sequence[object] = ()) -> None:
        self._manager = pluggy.PluginManager(GROUP)
        self._manager.add_hookspecs(hookspecs)
        self._explicit = {str(path) for path in files}
        self.files = tuple(files)
        """What was named on the command line."""
        self._registered: dict[str, list[tuple[str, Spec]]] | None = None
        self.statuses: dict[str, PluginStatus] = {}
        for entry_point, source, version in _installed():
            self._load(PluginStatus(entry_point.name, source, version), entry_point.load)
        loose = Path.cwd() / LOOSE_FILE
        found = [*([loose] if loose.is_file() else []), *files]
        for path in {_itself(path): path for path in found}.values():
            for plugin in loose_plugins(path):
                self._load(PluginStatus(plugin.name, str(path)), plugin.load)
        for number, one in enumerate(given):
            self._load(PluginStatus(f"given {number}", "this process"), partial(_given, one))

    def _load(self, status: PluginStatus, load: Callable[[], Any]) -> None:
        """Load a plugin; nothing happens if it is one that is loaded, installed and named besides, say."""
        other = self.statuses.get(status.name)
        if other is not None:
            status = PluginStatus(f"{status.name} ({status.source})", status.source, status.version)
        try:
            with blame(f"plugin {status.name}"):
                plugin = load()
                if self._manager.is_registered(plugin):
                    return
                if other is not None:
                    raise UsageError(f"the name is taken by the plugin of {other.source}")
                self._refuse_misspelled(plugin)
                self._manager.register(plugin, name=status.name)
                self.statuses[status.name] = status
        except Proc3sError as error:
            self._refuse(status, error)

    def _fail(self, status: PluginStatus, error: Proc3sError | str) -> None:
        """Record a failure; the plugin is not called again."""
        text = str(error)
        self.statuses[status.name] = PluginStatus(status.name, status.source, status.version, text)
        if self._manager.has_plugin(status.name):
            self._manager.unregister(name=status.name)

    def _refuse(self, status: PluginStatus, error: Proc3sError | str) -> None:
        """`_fail`, and a failure in a file that the user named is the user's to see at once."""
        self._fail(status, error)
        if status.source in self._explicit:
            if isinstance(error, SpecError):
                raise error
            raise UsageError(f"plugin {status.source}: {self.statuses[status.name].error}")

    def _refuse_misspelled(self, plugin: Any) -> None:
        known = {name for name in vars(hookspecs) if hasattr(getattr(hookspecs, name), "proc3s_spec")}
        for name in dir(plugin):
            if hasattr(getattr(plugin, name, None), "proc3s_impl") and name not in known:
                raise UsageError(f"there is no hook {name!r}{did_you_mean(name, known)}")

    @property
    def failures(self) -> list[PluginStatus]:
        """The plugins that did not load, or whose hooks raised."""
        return [status for status in self.statuses.values() if status.error is not None]

    def specs(self, kind: str) -> list[tuple[str, Spec]]:
        """(plugin name, spec) of everything that `register_<kind>` brings.

        Each plugin is asked once for all kinds. One that raises, or brings what another has brought before
        it, is refused with all that it brings.
        """
        if self._registered is None:
            self._registered = self._ask_all()
        return self._registered.get(kind, [])

    def _ask_all(self) -> dict[str, list[tuple[str, Spec]]]:
        registered: dict[str, list[tuple[str, Spec]]] = {}
        taken: dict[tuple[str, str], str] = {}
        for name in list(self.statuses):
            try:
                found = [one for one in self._ask(name) if not _known(one[1], registered)]
                mine = self._names(name, found, taken)
            except Proc3sError as error:
                self._refuse(self.statuses[name], error)
                continue
            taken |= mine
            for kind, spec in found:
                registered.setdefault(kind, []).append((name, spec))
        return registered

    def _ask(self, name: str) -> list[tuple[str, Spec]]:
        """(kind of the hook, spec) of all that a plugin brings. Raises Proc3sError."""
        found: list[tuple[str, Spec]] = []
        plugin = self._manager.get_plugin(name)
        for hook in (name for name in vars(hookspecs) if name.startswith("register_")):
            register, kind = getattr(plugin, hook, None), hook.removeprefix("register_")
            if register is not None and hasattr(register, "proc3s_impl"):
                add = partial(_add, found, kind)
                with blame(f"plugin {name}"):
                    register(add)
        return found

    def _names(
        self, plugin: str, found: Sequence[tuple[str, Spec]], taken: Mapping[tuple[str, str], str]
    ) -> dict[tuple[str, str], str]:
        """The names that a plugin takes, by kind. Raises SpecError for one that is taken."""
        mine: dict[tuple[str, str], str] = {}
        for _, spec in found:
            key = spec.kind, str(getattr(spec, "name"))  # noqa: B009 - every registered kind has a name
            if first := {**taken, **mine}.get(key):
                both = " and ".join(f"{n} ({self.statuses[n].source})" for n in (first, plugin))
                message = f"{key[1]!r} is registered by both {both}; the first one counts"
                raise SpecError([Issue(f"plugin {plugin}", key[0], message)])
            mine[key] = plugin
        return mine

    def resolve_llm(self, model: str) -> Spec | None:
        """The spec of the backend that a plugin offers for a model name."""
        return next((spec for spec in self._call("resolve_llm", model=model) if isinstance(spec, Spec)), None)

    def prompt_context(self, problem: Any, method: Any) -> dict[str, Any]:
        """What plugins add to the variables of the prompt."""
        added: dict[str, Any] = {}
        for context in self._call("prompt_context", problem=problem, method=method):
            if isinstance(context, Mapping):
                added.update(context)
        return added

    def on_event(self, event: Any) -> None:
        """Tell every plugin."""
        for _ in self._call("on_event", event=event):
            pass

    def _call(self, hook: str, **arguments: Any) -> Iterator[Any]:
        """The answer of each plugin; one that raises is recorded and never called again."""
        for implementation in reversed(getattr(self._manager.hook, hook).get_hookimpls()):
            try:
                with blame(f"plugin {implementation.plugin_name}"):
                    taken = {name: arguments[name] for name in implementation.argnames}
                    answer = implementation.function(**taken)
            except Proc3sError as error:
                self._fail(self.statuses[implementation.plugin_name], error)
            else:
                yield answer


def _installed() -> list[tuple[EntryPoint, str, str | None]]:
    """Entry points with name and version of their distribution, however it was installed; our own first."""
    points = entry_points(group=GROUP)
    heads = {dist: headers(dist) for dist in {point.dist for point in points} if dist}
    known = {dist: (str(head["Name"]), head["Version"]) for dist, head in heads.items()}
    found = [(point, *(known[point.dist] if point.dist else ("unknown", None))) for point in points]
    return sorted(found, key=lambda one: (one[1] != GROUP, one[1]))


def _add(found: list[tuple[str, Spec]], kind: str, spec: Spec) -> None:
    found.append((kind, _checked(spec, f"register_{kind}")))


def _known(spec: Spec, registered: Mapping[str, list[tuple[str, Spec]]]) -> bool:
    """Whether it is a domain that another plugin read from the same file."""
    if not isinstance(spec, DomainSpec) or spec.folder is None:
        return False
    domains = [one for _, one in registered.get(DomainSpec.kind, []) if isinstance(one, DomainSpec)]
    return any(one.name == spec.name and one.folder and one.folder.samefile(spec.folder) for one in domains)


def _itself(path: Path) -> Path:
    """The path without links, so that one file is loaded once; links in a circle lead nowhere."""
    try:
        return path.resolve()
    except RuntimeError:
        return path.absolute()


def _given(plugin: object) -> object:
    return plugin


def _checked(spec: Any, hook: str) -> Spec:
    if not isinstance(spec, Spec):
        raise TypeError(f"{hook} registers specs, not {type(spec).__name__}")
    if not getattr(spec, "name", None):
        raise TypeError(f"{hook} registers specs with a name, and this {type(spec).__name__} has none")
    return spec
