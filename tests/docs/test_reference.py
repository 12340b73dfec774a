"""Whatever a person can type, write or import is in the generated reference and says what it is."""

import inspect
import re
import sys
from pathlib import Path

import jinja2
import pytest
import typer
import yaml
from jinja2.sandbox import ImmutableSandboxedEnvironment

import proc3s
from proc3s import specs
from proc3s.cli import app
from proc3s.feedback.parameters import BoundHit, Separation
from proc3s.feedback.report import ConstraintReport, Diagnosis, Failure
from proc3s.llm.call_options import CallOptions
from proc3s.planning import summary
from proc3s.planning.options import run_options
from proc3s.planning.setup import make_problem, make_prompter
from proc3s.plugins import hookspecs
from proc3s.plugins.part_options import options_model
from proc3s.plugins.registry import KINDS, open_registry
from proc3s.prompts import prompter
from proc3s.runs import events
from proc3s_tabletop.catalogue.body_specs import SHAPES
from proc3s_tabletop.tasks.scenes import Entry
from proc3s_tabletop.tasks.selection import Selector

sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "hooks"))

import names
import reference

ROOT = Path(__file__).parents[2]
HOOKS = [name for name, value in vars(hookspecs).items() if hasattr(value, "proc3s_spec")]
SPECS = {
    spec
    for name in specs.__all__
    if inspect.isclass(spec := getattr(specs, name)) and issubclass(spec, specs.Spec)
}
SPECS = sorted((SPECS | set(KINDS.values())) - {specs.Spec}, key=lambda spec: spec.__name__)
EVENTS = [
    value
    for value in vars(events).values()
    if inspect.isclass(value) and issubclass(value, events.Event) and not value.__subclasses__()
]
UNITS = re.compile(
    r"\b(m|mm|metres|rad|radians|s|seconds|dollars|units?|shape|columns|probability|likeliest)\b|\[0, 1",
    re.IGNORECASE,
)


@pytest.fixture(scope="module")
def pages():
    return reference.pages()


@pytest.fixture(scope="module")
def public():
    return {entry["name"]: entry for entry in names.public()}


def section(page, heading):
    """The part of a page under a heading of the second order."""
    parts = re.split(r"^## (.+)$", page, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))[heading]


def commands(group, above=""):
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands(command, f"{above}{name} ")
        else:
            yield pytest.param(f"{above}{name}", command, id=f"{above}{name}")


@pytest.mark.parametrize(("name", "command"), list(commands(typer.main.get_command(app))))
def test_every_command_argument_and_option_is_in_the_reference(pages, name, command):
    part = section(pages["reference/cli.md"], f"proc3s {name}")
    assert command.help
    assert command.help in part
    for param in command.params:
        assert param.help, f"{param.name} of proc3s {name} does not say what it is for"
        for written in (*param.opts, *param.secondary_opts):
            shown = written if written.startswith("-") else param.metavar or written.upper()
            assert re.search(rf"(>|, |/ ){re.escape(shown)}(<|,| )", part), f"{shown} of proc3s {name}"


@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.__name__)
def test_every_field_of_a_spec_is_described_in_the_reference(pages, spec):
    written = pages["reference/domain-yaml.md"] + pages["reference/hooks.md"]
    part = "".join(re.findall(rf"^##+ {spec.__name__}$(.*?)(?=^##|\Z)", written, re.MULTILINE | re.DOTALL))
    for name, info in spec.model_fields.items():
        assert info.description, f"{spec.__name__}.{name} does not say what it is for"
        assert f"<code>{name}</code>" in part, f"{spec.__name__}.{name}"


@pytest.mark.parametrize("spec", [*SHAPES.values(), Entry, Selector], ids=lambda spec: spec.__name__)
def test_every_field_of_the_toolbox_is_described(pages, spec):
    for name, info in spec.model_fields.items():
        assert info.description, f"{spec.__name__}.{name} does not say what it is for"
        assert f"<code>{name}</code>" in pages["reference/table-top.md"]


def test_every_option_of_a_solver_or_model_is_described(pages):
    registry = open_registry([])
    entries = [spec for kind in (specs.SolverSpec, specs.LLMSpec) for spec in registry.all(kind).values()]
    models = [CallOptions, *filter(None, map(options_model, entries))]
    assert len(models) > 3
    for model in models:
        for name, info in model.model_fields.items():
            assert info.description, f"{model.__name__}.{name} does not say what it is for"
            assert f"{name}=…" in pages["reference/plugins.md"]


@pytest.mark.parametrize("document", [summary.Summary, *EVENTS], ids=lambda document: document.__name__)
def test_every_field_of_the_summary_and_the_log_is_described(pages, document):
    for name, info in document.model_fields.items():
        if name != "event":
            assert info.description, f"{document.__name__}.{name} does not say what it is"
            assert f"<code>{name}</code>" in pages["reference/run-folder.md"]


def _handed_to_templates(monkeypatch):
    """What each template of a prompt is given, by the name of the template."""
    given = {}
    render = jinja2.Template.render

    def spy(template, **variables):
        given.setdefault(template.name, set()).update(variables)
        return render(template, **variables)

    monkeypatch.setattr(jinja2.Template, "render", spy)
    registry, options = open_registry([]), run_options(task="drawing/star")
    problem = make_problem(registry, options)
    make_prompter(registry, options, problem).rehearse(problem)
    return given


def test_the_variables_of_a_prompt_are_those_that_it_gets(pages, monkeypatch):
    page = pages["reference/prompt-templates.md"]

    def named(heading):
        return set(
            re.findall(r"^\| <code>(\w+)</code> \| .+ \| .+ \|$", section(page, heading), re.MULTILINE)
        )

    shared = named("Every template")
    assert _handed_to_templates(monkeypatch) == {
        "methods/proc3s.j2": shared,
        "partials/task.j2": shared | named("partials/task.j2"),
        "feedback.j2": shared | named("feedback.j2"),
    }


def test_the_filters_of_a_prompt_are_those_of_its_environment(pages, monkeypatch):
    made = []
    monkeypatch.setattr(
        prompter,
        "ImmutableSandboxedEnvironment",
        lambda **given: made.append(ImmutableSandboxedEnvironment(**given)) or made[-1],
    )
    _handed_to_templates(monkeypatch)
    own = set(made[0].filters) - set(jinja2.defaults.DEFAULT_FILTERS)
    listed = section(pages["reference/prompt-templates.md"], "Filters")
    assert own == set(re.findall(r"^### (\w+)$", listed, re.MULTILINE))
    assert all(f"{name}(" in listed for name in own)


@pytest.mark.parametrize("model", [Diagnosis, Failure, ConstraintReport, Separation, BoundHit])
def test_every_field_of_a_diagnosis_is_described(pages, model):
    for name, info in model.model_fields.items():
        assert info.description, f"{model.__name__}.{name} does not say what it is"
        assert f"<code>{name}</code>" in pages["reference/prompt-templates.md"]


def test_every_hook_is_in_the_reference(pages):
    assert len(HOOKS) == 12
    for name in HOOKS:
        text = inspect.getdoc(getattr(hookspecs, name))
        assert text
        assert text in section(pages["reference/hooks.md"], name)


@pytest.mark.parametrize("name", sorted(proc3s.__all__))
def test_every_public_name_has_a_text(pages, public, name):
    shown = public[name]
    assert shown["doc"], f"{name} has no docstring"
    assert shown["doc"] in section(pages["reference/python.md"], name)
    for method in shown["methods"]:
        assert method["doc"], f"{name}.{method['name']} has no docstring"


@pytest.mark.parametrize("name", sorted(proc3s.__all__))
def test_numbers_of_public_names_have_a_unit(public, name):
    shown = public[name]
    for field in shown["fields"]:
        if re.search(r"\bfloat\b|FloatArray", field["type"]):
            assert UNITS.search(f"{shown['doc']} {field['says']}"), f"{name}.{field['name']} has no unit"
    for method in [shown, *shown["methods"]]:
        if re.search(r"\bfloat\b|FloatArray", method["signature"]):
            assert UNITS.search(f"{shown['doc']} {method['doc']}"), f"{name}: {method['signature']}"


def entries(nav):
    for entry in nav:
        value = next(iter(entry.values())) if isinstance(entry, dict) else entry
        yield from [value] if isinstance(value, str) else entries(value)


def test_every_page_is_in_the_menu(pages):
    settings = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    listed = set(entries(settings["nav"]))
    written = {path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")}
    lacking = sorted(written - listed)
    assert not lacking, f"nav in mkdocs.yml must list {lacking}"
    extra = sorted(listed - written - set(pages) - {"gallery.md", "security.md", "changelog.md"})
    assert not extra, f"nav in mkdocs.yml lists {extra}, which are not there"
