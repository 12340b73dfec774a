import contextlib
import sys
import textwrap

import pytest

from proc3s import MethodSpec, SpecError, UsageError
from proc3s.plugins.manager import PluginManager
from proc3s.plugins.registry import open_registry

IMPORTS = "from proc3s import MethodSpec, hookimpl\n"
METHOD = """
@hookimpl
def register_methods(register):
    register(MethodSpec(name="{name}", summary="", template="proc3s", answer="sketch"))
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def write(folder, name, text):
    path = folder / f"{name}.py"
    path.write_text(IMPORTS + textwrap.dedent(text), encoding="utf-8")
    return path


def install(folder, dist, **entry_points):
    """A distribution that is installed as far as its metadata go."""
    info = folder / f"{dist}-1.2.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {dist}\nVersion: 1.2\n")
    lines = "".join(f"{name} = {module}\n" for name, module in entry_points.items())
    (info / "entry_points.txt").write_text(f"[proc3s]\n{lines}")


def status(manager, name):
    return next(s for s in manager.statuses.values() if s.name == name)


def test_the_built_in_plugins_load(folder):
    manager = PluginManager()
    assert not manager.failures
    assert status(manager, "methods").source == "proc3s"
    assert status(manager, "methods").version


def test_an_entry_point_of_a_stranger(folder):
    write(folder, "toy_entry_good", METHOD.format(name="theirs"))
    install(folder, "stranger", theirs="toy_entry_good")
    registry = open_registry()
    assert "theirs" in registry.all(MethodSpec)
    assert status(registry.plugins, "theirs").source == "stranger"
    assert status(registry.plugins, "theirs").version == "1.2"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("import toy_not_there", "ModuleNotFoundError: No module named 'toy_not_there'"),
        ("def broken(:", "SyntaxError"),
        ("1 / 0", "ZeroDivisionError"),
        ("raise SystemExit(7)", "SystemExit"),
        (
            "@hookimpl\ndef register_method(register): ...",
            "no hook 'register_method'; did you mean 'register_methods'?",
        ),
        ("@hookimpl\ndef on_event(happening): ...", "happening"),
    ],
)
def test_a_broken_entry_point_stops_nobody(folder, text, words):
    write(folder, f"toy_entry_{abs(hash(text))}", text)
    install(folder, "stranger", theirs=f"toy_entry_{abs(hash(text))}")
    registry = open_registry()
    assert words in status(registry.plugins, "theirs").error
    assert {"proc3s", "cap", "llm3"} <= set(registry.all(MethodSpec))


def test_an_entry_point_that_is_not_there_stops_nobody(folder):
    install(folder, "stranger", theirs="toy_entry_nowhere", mine="json:nothing")
    manager = PluginManager()
    assert {s.name for s in manager.failures} == {"theirs", "mine"}


@pytest.mark.parametrize("text", ["1 / 0", "register('a name')", "register(None)", "register()"])
def test_a_hook_that_raises_stops_nobody(folder, text):
    write(folder, "proc3s_plugins", f"@hookimpl\ndef register_methods(register):\n    {text}\n")
    registry = open_registry()
    assert "proc3s" in registry.all(MethodSpec)
    (failure,) = registry.plugins.failures
    assert failure.name == "proc3s_plugins"
    assert "Error" in failure.error


def test_what_a_failing_hook_had_registered_before_is_not_kept(folder):
    write(folder, "proc3s_plugins", METHOD.format(name="half") + "    1 / 0\n")
    assert "half" not in open_registry().all(MethodSpec)


def test_the_file_in_the_working_directory_is_a_plugin(folder):
    write(folder, "proc3s_plugins", METHOD.format(name="local"))
    registry = open_registry()
    assert "local" in registry.all(MethodSpec)
    assert status(registry.plugins, "proc3s_plugins").source == str(folder / "proc3s_plugins.py")


def test_naming_the_file_in_the_working_directory_loads_it_once(folder):
    path = write(folder, "proc3s_plugins", METHOD.format(name="local"))
    assert "local" in open_registry([path]).all(MethodSpec)


def test_naming_one_file_twice_loads_it_once(folder):
    path = write(folder, "toy_twice", METHOD.format(name="local"))
    assert "local" in open_registry([path, path]).all(MethodSpec)


def test_loose_files_name_their_own_functions(folder):
    path = write(
        folder,
        "toy_loose",
        """
        from proc3s import SolverSpec
        class Lazy: ...
        @hookimpl
        def register_solvers(register):
            register(SolverSpec(name="lazy", summary="", target="toy_loose:Lazy"))
        """,
    )
    from proc3s import SolverSpec

    assert open_registry([path]).get(SolverSpec, "lazy").load().__name__ == "Lazy"


def test_a_loose_file_does_not_take_the_place_of_an_imported_module(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "textwrap", textwrap)  # put back whatever happens
    path = write(folder, "textwrap", METHOD.format(name="local"))
    with contextlib.suppress(UsageError):  # refusing the file would do as well
        open_registry([path])
    assert sys.modules["textwrap"] is textwrap


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("import toy_not_there", "toy_not_there"),
        ("def broken(:", "SyntaxError"),
        ("@hookimpl\ndef register_solver(register): ...", "did you mean 'register_solvers'"),
    ],
)
def test_a_broken_file_that_was_named_is_said_at_once(folder, text, words):
    path = write(folder, "toy_named", text)
    with pytest.raises((SpecError, UsageError), match=words):
        PluginManager([path])


def test_a_file_that_was_named_must_be_there(folder):
    with pytest.raises(UsageError, match=r"there is no file .*missing\.py"):
        PluginManager([folder / "missing.py"])


def test_a_listener_that_raises_is_recorded_and_not_told_again(folder):
    write(
        folder,
        "proc3s_plugins",
        """
        from pathlib import Path
        @hookimpl
        def on_event(event):
            with Path("told").open("a") as file:
                file.write(event)
            raise KeyError("ear")
        """,
    )
    manager = PluginManager()
    manager.on_event("one")
    manager.on_event("two")
    assert (folder / "told").read_text() == "one"
    assert "KeyError" in status(manager, "proc3s_plugins").error


@pytest.mark.parametrize("hook", ["resolve_llm(model)", "prompt_context(problem, method)"])
def test_other_hooks_that_raise_stop_nobody_either(folder, hook):
    write(folder, "proc3s_plugins", f"@hookimpl\ndef {hook}:\n    raise KeyError('oops')\n")
    manager = PluginManager()
    assert manager.prompt_context(None, None) == {}
    assert manager.resolve_llm("openai/gpt").name == "litellm"


def test_what_plugins_add_to_the_prompt(folder):
    write(
        folder, "proc3s_plugins", "@hookimpl\ndef prompt_context(problem, method):\n    return {'extra': 1}\n"
    )
    assert PluginManager().prompt_context(None, None) == {"extra": 1}
