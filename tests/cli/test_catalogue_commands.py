import json

import pytest

TASKS = {f"drawing/{t}" for t in ("star", "arrow", "letters", "enclosed", "free")}
TASKS |= {f"blocks/{t}" for t in ("pyramid", "line", "packing", "unstack")}
TASKS |= {f"ycb/{t}" for t in ("packing", "stacking", "line")}
TASKS |= {f"drawing/{t}" for t in ("word", "spiral", "enclose-three")}
TASKS |= {f"blocks/{t}" for t in ("pyramid-six", "tower", "sort", "reverse", "grid")}


def test_help_names_every_command(cli):
    text = cli("--help").stdout
    for name in ("run", "solve", "render-prompt", "replay", "list", "show", "plugins", "schema"):
        assert name in text


@pytest.mark.parametrize(
    "command", ["run", "solve", "render-prompt", "replay", "list", "show", "plugins", "schema"]
)
def test_every_command_has_help(cli, command):
    result = cli(command, "--help")
    assert result.code == 0
    assert "Usage" in result.stdout


def test_no_command_is_help(cli):
    assert "Usage" in cli().stdout + cli().stderr


def test_the_version(cli):
    from importlib.metadata import version

    assert cli("--version").stdout == f"proc3s {version('proc3s')}\n"


def test_everything_is_listed(cli):
    text = cli("list").stdout
    for word in (
        "drawing",
        "proc3s-nf",
        "llm3-gaussian",
        "rejection",
        "replay",
        "serial",
        "paper",
        "drawing/star",
    ):
        assert word in text


def test_a_list_as_json(cli):
    rows = cli("list", "--json").json
    assert set(rows["tasks"]) == TASKS
    assert len(rows["methods"]) == 7
    assert set(rows["solvers"]) == {"rejection", "gaussian", "backtracking", "cma", "portfolio", "roomier"}
    assert set(rows["llms"]) == {"replay", "recorded", "manual", "stub", "litellm"}
    assert set(rows["presets"]) == {"paper", "release", "best"}
    assert all(isinstance(summary, str) and summary for kind in rows.values() for summary in kind.values())


@pytest.mark.parametrize("kind", ["methods", "method"])
def test_one_kind(cli, kind):
    rows = cli("list", kind, "--json").json
    assert list(rows) == ["methods"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("drawing", ["Obstacle", "draw_line", "ContinuousSampler", "collision", "drawing/star", "10000"]),
        ("drawing/star", ["Draw a star", "is_star"]),
        ("ycb", ["pick(o: object, g: grasp)", "CC BY 4.0", "Calli, Walsman", "ycb/packing.open"]),
        ("proc3s", ["sketch", "5"]),
        ("rejection", ["first", "64", "largest"]),
        ("manual", ["wait", "manual:DIR"]),
        ("litellm", ["temperature", "PROVIDER/MODEL"]),
        ("draw_line", ["p1_x", "straight line"]),
        ("drawing/collision", ["line touches {obstacle}"]),
        ("ContinuousSampler", ["uniformly", "min"]),
        ("paper", ["budget", "paper  (suite)", "blocks/unstack"]),
        ("serial", ["process"]),
    ],
)
def test_show(cli, name, words):
    result = cli("show", name)
    assert result.code == 0
    for word in words:
        assert word in result.stdout
    assert isinstance(cli("show", name, "--json").json, dict)


def test_plugins_say_where_they_are_from(cli):
    rows = {row["name"]: row for row in cli("plugins", "--json").json}
    assert {
        "methods",
        "solvers",
        "executors",
        "litellm",
        "replay",
        "drawing",
        "templates",
        "samplers",
    } <= set(rows)
    assert all(row["error"] is None for row in rows.values())
    assert cli("plugins", "--strict").code == 0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1 / 0", "ZeroDivisionError"),
        ("from proc3s import hookimpl\n@hookimpl\ndef register_method(register): ...", "did you mean"),
        ("from proc3s import hookimpl\n@hookimpl\ndef register_llms(register): 1 / 0", "ZeroDivisionError"),
    ],
)
def test_a_broken_plugin_is_listed_and_strict_is_strict(cli, here, text, words):
    (here / "proc3s_plugins.py").write_text(text)
    (row,) = [r for r in cli("plugins", "--json").json if r["error"]]
    assert words in row["error"]
    assert row["source"].endswith("proc3s_plugins.py")
    assert cli("plugins").code == 0
    assert cli("plugins", "--strict").code == 2
    listed = cli("list")
    assert listed.code == 0
    assert "drawing" in listed.stdout


@pytest.mark.parametrize(
    "kind", ["domain", "method", "solver", "llm", "preset", "skill", "constraint", "sampler"]
)
def test_schemas_are_schemas(cli, kind):
    schema = cli("schema", kind).json
    assert schema["type"] == "object"
    assert schema["additionalProperties"] is False


def test_the_schema_of_a_domain_knows_the_keys_of_a_domain(cli):
    import yaml

    from proc3s.plugins.registry import open_registry

    schema = cli("schema", "domain").json
    path = open_registry().domain("drawing").spec.folder / "domain.yaml"
    assert set(yaml.safe_load(path.read_text())) <= set(schema["properties"])
    assert "name" in schema["required"]
    assert "folder" not in schema["properties"]  # not a key of the file


def test_the_schema_accepts_parts_that_are_named_by_their_key(cli):
    schema = cli("schema", "domain").json
    skill = schema["$defs"]["SkillSpec"]
    assert "name" not in skill["required"]  # a skill in a domain file is named by its key


def test_show_json_of_a_domain_is_plain(cli):
    spec = cli("show", "drawing", "--json").json
    assert spec["name"] == "drawing"
    assert json.dumps(spec, allow_nan=False)
