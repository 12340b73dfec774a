import pytest
from pydantic import ValidationError

import toy_world
from proc3s import MethodSpec, SpecError, load_domain
from proc3s.specs.base import Target
from proc3s.specs.domain import FieldSpec, ParamSpec, TypeSpec


def test_specs_are_frozen(tmp_path):
    spec = load_domain(toy_world.write(tmp_path))
    with pytest.raises(ValidationError):
        spec.name = "other"


def test_specs_refuse_unknown_keys():
    with pytest.raises(ValidationError, match="rouns"):
        MethodSpec(name="m", summary="", template="t", answer="plan", rouns=1)


def test_a_field_is_required_unless_it_has_a_default_even_none():
    assert FieldSpec(type="str").required
    assert not FieldSpec(type="str", default=None).required


def test_fields_with_a_default_come_after_those_without():
    fields = {"color": {"type": "str", "default": ""}, "x": {"type": "float"}}
    with pytest.raises(ValidationError, match="'x' has no default: it must stand before 'color'"):
        TypeSpec(summary="A thing.", fields=fields)


@pytest.mark.parametrize(
    "data",
    [
        {"type": "str"},
        {"min": 2, "max": 1},
        {"noise": -1},
        {"type": "Pose"},
        {"type": "object", "noise": 1},
        {"type": "point", "turn_noise": 1},
    ],
)
def test_a_parameter_that_cannot_be(data):
    with pytest.raises(ValidationError):
        ParamSpec(**data)


def test_a_target_loads_what_it_names():
    assert Target(target="toy_world:slide").load() is toy_world.slide


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ("toy_world:slyde", "did you mean 'slide'"),
        ("toy_nowhere:slide", "cannot be imported"),
        ("toy_world.sub:slide", "cannot be imported"),
    ],
)
def test_a_target_that_is_not_there(target, words):
    with pytest.raises(SpecError, match=words):
        Target(target=target).load()


@pytest.mark.parametrize("text", ["toy_world", "toy world:x", "toy_world:", ":x", "a:b:c", "a:b.c"])
def test_a_target_is_module_and_name(text):
    with pytest.raises(ValidationError):
        Target(target=text)


def test_a_module_that_breaks_on_import_is_a_spec_error(tmp_path, monkeypatch):
    (tmp_path / "toy_syntax.py").write_text("def broken(:\n")
    (tmp_path / "toy_raises.py").write_text("1 / 0\n")
    monkeypatch.syspath_prepend(tmp_path)
    for module in ("toy_syntax", "toy_raises"):
        with pytest.raises(SpecError, match="cannot be imported"):
            Target(target=f"{module}:name").load()


@pytest.mark.parametrize(("old", "new"), [("  slide:", "  goal:"), ("  on_wire:", "  rehearsal:")])
def test_names_that_verdicts_of_the_loop_have_are_taken(tmp_path, old, new):
    path = toy_world.write(tmp_path)
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(SpecError, match=rf"{path.name}:\d+: .*'{new.strip(' :')}' is a name that proc3s"):
        load_domain(path)
