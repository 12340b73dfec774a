"""A plugin that brings what another has brought is refused as a whole and named; everything else works."""

import sys

import pytest

SPECS = {
    "domains": """(load_domain(__file__.replace(".py", ".yaml")))""",
    "skills": '(SkillSpec(name="same", summary="", params={}, target="json:loads"))',
    "samplers": '(SamplerSpec(name="DiscreteSampler", summary="", params={}, target="json:loads"))',
    "constraints": '(ConstraintSpec(name="same", says="", target="json:loads"))',
    "methods": '(MethodSpec(name="cap", summary="", template="cap", answer="program"))',
    "methods (preset)": '(PresetSpec(name="best", summary="", budget="paper"))',
    "methods (suite)": '(SuiteSpec(name="smoke", summary="", tasks=["drawing/star"], methods=["cap"]))',
    "solvers": '(SolverSpec(name="cma", summary="", target="json:loads"))',
    "llms": '(LLMSpec(name="replay", summary="", usage="", target="json:loads"))',
    "executors": '(ExecutorSpec(name="serial", summary="", target="json:loads"))',
    "templates": '(TemplatesSpec(name="NAME", summary="", folder="."))',
}
DOMAIN = """
spec_version: 1
name: drawing
summary: Another.
world: {target: "proc3s:World"}
state: Dots
types: {Dots: {summary: Dots., fields: {count: {type: int}}}}
skills: {}
samplers: []
constraints: {}
tasks: {}
budget: {paper: 10}
"""


@pytest.fixture
def install(here, monkeypatch):
    """Installs a distribution with one plugin, as far as its metadata go."""
    monkeypatch.syspath_prepend(here)

    def write(dist, text):
        module = dist.replace("-", "_")
        monkeypatch.setitem(sys.modules, module, None)  # whatever another test imported is forgotten
        del sys.modules[module]
        info = here / f"{dist}-1.2.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {dist}\nVersion: 1.2\n")
        (info / "entry_points.txt").write_text(f"[proc3s]\n{module} = {module}\n")
        (here / f"{module}.py").write_text(f"from proc3s import *\n{text}")
        (here / f"{module}.yaml").write_text(DOMAIN)

    return write


def hook(kind, text):
    return f"@hookimpl\ndef register_{kind.partition(' ')[0]}(register):\n    register{text}\n"


OWN = hook("solvers", '(SolverSpec(name="hermit", summary="", target="json:loads"))')


@pytest.mark.slow
@pytest.mark.parametrize("kind", SPECS)
def test_a_duplicate_is_refused_as_a_whole_whatever_it_is(cli, install, kind):
    known = "bundled" if kind in ("skills", "constraints") else "proc3s"
    if known == "bundled":
        install("aaa-first", hook(kind, SPECS[kind]))
    text = SPECS[kind].replace("NAME", next(iter(cli("list", "templates", "--json").json["templates"])))
    own = OWN if kind != "solvers" else hook("methods", SPECS["methods"].replace("cap", "hermit", 1))
    install("zzz-clash", hook(kind, text) + own)
    assert cli("run", "drawing/star", "--llm", "replay").code == 0
    listed = cli("list")
    assert listed.code == 0
    assert "hermit" not in listed.stdout
    assert listed.stderr.count("zzz_clash (zzz-clash) failed") == 1
    assert "registered by both" in listed.stderr
    assert ("(aaa-first)" if known == "bundled" else "(proc3s)") in listed.stderr
    assert cli("plugins").code == 0
    assert cli("plugins", "--strict").code == 2


def test_the_list_of_plugins_says_in_full_why_one_is_broken(cli, install, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    reason = " ".join(["the calibration file of the gripper on the bench of the laboratory is missing"] * 3)
    install("zzz-a-plugin-with-a-name-longer-than-those-of-others", f"raise ValueError({reason!r})")
    told = cli("plugins").stdout
    assert "failed: zzz_a_plugin_with_a_name_longer_than_those_of_others: " in told
    assert reason in told
    assert "…" not in told


def test_the_first_by_name_wins_whatever_was_installed_first(cli, install):
    for dist in ("ccc-other", "bbb-other", "aaa-other"):
        install(dist, hook("solvers", f'(SolverSpec(name="same", summary="of {dist}", target="json:loads"))'))
    assert cli("list", "solvers", "--json").json["solvers"]["same"] == "of aaa-other"
    failed = [status["name"] for status in cli("plugins", "--json").json if status["error"]]
    assert failed == ["bbb_other", "ccc_other"]


def test_a_plugin_that_brings_a_name_twice_is_refused(cli, install):
    install("zzz-twice", OWN + "    " + OWN.splitlines()[-1].strip() + "\n")
    listed = cli("list")
    assert "hermit" not in listed.stdout
    assert "'hermit' is registered by both zzz_twice" in listed.stderr


@pytest.mark.parametrize(
    "args", [("render-prompt", "drawing/star"), ("show", "drawing"), ("run", "drawing/star")]
)
def test_it_is_said_once_by_every_command(cli, install, args):
    install("zzz-clash", hook("domains", SPECS["domains"]))
    result = cli(*args)
    assert result.code == 0
    assert result.stderr.count("zzz_clash (zzz-clash) failed") == 1
