import textwrap

import pytest

import toy_world
from proc3s import DomainSpec, MethodSpec, SamplerSpec, SkillSpec, SolverSpec, SpecError, UsageError
from proc3s.plugins.registry import open_registry

IMPORTS = """\
from pathlib import Path
from proc3s import ConstraintSpec, MethodSpec, SamplerSpec, SkillSpec, hookimpl, load_domain
HERE = Path(__file__).parent
"""
BRING_DOMAIN = """
@hookimpl
def register_domains(register):
    register(load_domain(HERE / "domain.yaml"))
"""
BRING_PARTS = """
@hookimpl
def register_skills(register):
    register(SkillSpec(name="tap", summary="Taps.", params={}, target="toy_world:slide"DOMAINS))

@hookimpl
def register_constraints(register):
    register(ConstraintSpec(name="quiet", says="loud", target="toy_world:answer"DOMAINS))

@hookimpl
def register_samplers(register):
    register(SamplerSpec(name="Coin", summary="A coin.", params={"values": "list"}, gives="choice",
                         target="proc3s.domain.samplers:DiscreteSampler"DOMAINS))
"""


@pytest.fixture
def plugin(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def write(name, text):
        path = tmp_path / f"{name}.py"
        path.write_text(IMPORTS + textwrap.dedent(text), encoding="utf-8")
        return path

    return write


def parts(registry):
    domain = registry.domain("toy")
    return {*domain.spec.skills}, {*domain.spec.constraints}, {s.name for s in domain.samplers}


PLAIN = ({"slide"}, {"on_wire"}, {"ContinuousSampler"})
ATTACHED = ({"slide", "tap"}, {"on_wire", "quiet"}, {"ContinuousSampler", "Coin"})


@pytest.mark.parametrize(
    ("domains", "expected"),
    [
        ("", PLAIN),
        (', domains=("toy",)', ATTACHED),
        (', domains=("*",)', ATTACHED),
        (', domains=("wood",)', PLAIN),
    ],
)
def test_parts_attach_to_the_domains_they_name(tmp_path, plugin, domains, expected):
    toy_world.write(tmp_path)
    registry = open_registry(
        [plugin("toy_plugin", BRING_DOMAIN), plugin("toy_parts", BRING_PARTS.replace("DOMAINS", domains))]
    )
    assert parts(registry) == expected


def test_a_domain_uses_parts_by_name(tmp_path, plugin):
    toy_world.write(tmp_path, toy_world.DOMAIN + "use: [tap, Coin]\n")
    registry = open_registry(
        [plugin("toy_plugin", BRING_DOMAIN), plugin("toy_parts", BRING_PARTS.replace("DOMAINS", ""))]
    )
    assert parts(registry) == ({"slide", "tap"}, {"on_wire"}, {"ContinuousSampler", "Coin"})


def test_using_what_nobody_brings(tmp_path, plugin):
    toy_world.write(tmp_path, toy_world.DOMAIN + "use: [tapp]\n")
    registry = open_registry(
        [plugin("toy_plugin", BRING_DOMAIN), plugin("toy_parts", BRING_PARTS.replace("DOMAINS", ""))]
    )
    with pytest.raises(UsageError, match=r"'tapp'.*did you mean 'tap'\?"):
        registry.domain("toy")


@pytest.mark.parametrize(
    ("made", "words"),
    [("Pose", r"makes a Pose, a type that the domain does not have"), ("Bead", r"not of floats alone")],
)
def test_a_sampler_of_a_type_that_the_domain_cannot_make(tmp_path, plugin, made, words):
    toy_world.write(tmp_path)
    domain, parts = plugin("domain", BRING_DOMAIN), BRING_PARTS.replace("DOMAINS", ', domains=("toy",)')
    registry = open_registry([domain, plugin("parts", parts.replace('"choice"', f'"{made}"'))])
    with pytest.raises(SpecError, match=words):
        registry.domain("toy")


def test_a_sampler_that_is_not_there(tmp_path, plugin):
    toy_world.write(tmp_path, toy_world.DOMAIN.replace("[ContinuousSampler]", "[ContinousSampler]"))
    registry = open_registry([plugin("toy_plugin", BRING_DOMAIN)])
    with pytest.raises(UsageError, match=r"'ContinousSampler'; did you mean 'ContinuousSampler'\?"):
        registry.domain("toy")


def test_a_plugin_must_not_replace_a_part_of_a_domain_in_silence(tmp_path, plugin):
    toy_world.write(tmp_path)
    clash = BRING_PARTS.replace("DOMAINS", ', domains=("toy",)').replace('"tap"', '"slide"')
    registry = open_registry([plugin("toy_plugin", BRING_DOMAIN), plugin("toy_parts", clash)])
    with pytest.raises((SpecError, UsageError), match="slide"):
        registry.domain("toy")


METHOD = """
@hookimpl
def register_methods(register):
    register(MethodSpec(name="{}", summary="", template="proc3s", answer="sketch"))
"""


def test_two_plugins_with_one_name_are_told_apart(plugin):
    files = [plugin("toy_one", METHOD.format("same")), plugin("toy_two", METHOD.format("same"))]
    registry = open_registry(files)
    with pytest.raises(SpecError, match=r"'same' is registered by both toy_one \(.*\) and toy_two"):
        registry.all(MethodSpec)


@pytest.mark.parametrize(
    ("cls", "name", "words"),
    [
        (MethodSpec, "prok3s", r"there is no method 'prok3s'; did you mean 'proc3s'\?"),
        (SolverSpec, "rejektion", r"there is no solver 'rejektion'; did you mean 'rejection'\?"),
        (DomainSpec, "zzz", r"there is no domain 'zzz'; there is .*drawing"),
        (SamplerSpec, "Normal", r"there is no sampler 'Normal'"),
        (SkillSpec, "anything", r"there is no skill 'anything'"),
    ],
)
def test_unknown_names_say_what_exists(plugin, cls, name, words):
    with pytest.raises(UsageError, match=words):
        open_registry().get(cls, name)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("star", "a task is named domain/task, not 'star'"),
        ("drawing/stare", "no task 'stare'; did you mean 'star'"),
        ("drawing/", "no task ''; there is arrow"),
        ("darwing/star", "did you mean 'drawing'"),
    ],
)
def test_unknown_tasks_say_what_exists(plugin, name, words):
    with pytest.raises(UsageError) as error:
        open_registry().task(name)
    assert words in str(error.value)


def test_a_name_that_is_missing_for_a_broken_plugin_says_so(tmp_path, plugin):
    plugin("proc3s_plugins", "import toy_missing_package")
    with pytest.raises(UsageError, match="toy_missing_package"):
        open_registry().get(MethodSpec, "mine")
