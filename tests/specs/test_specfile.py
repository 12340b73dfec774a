import pytest

import toy_world
from proc3s import DomainSpec, SpecError, load_domain
from proc3s.specs.yaml_reader import scalar


def lines_of(error):
    """(line, rest) of each issue of a spec error."""
    return [(int(str(i).split(":")[1]), ": ".join(str(i).split(": ")[1:])) for i in error.value.issues]


def mistakes(tmp_path, text):
    with pytest.raises(SpecError) as error:
        load_domain(toy_world.write(tmp_path, text))
    return error


def line_number(text, needle):
    return next(n for n, line in enumerate(text.splitlines(), start=1) if needle in line)


def test_a_sound_file_loads(tmp_path):
    spec = load_domain(toy_world.write(tmp_path))
    assert isinstance(spec, DomainSpec)
    assert list(spec.skills["slide"].params) == ["bead", "by"]
    assert spec.constraints["on_wire"].name == "on_wire"
    assert spec.folder == tmp_path


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("1e-3", 0.001),
        ("1E5", 1e5),
        ("-2", -2),
        ("007", 7),
        (".5", 0.5),
        ("3.", 3.0),
        ("no", "no"),
        ("off", "off"),
        ("y", "y"),
        ("true", True),
        ("null", None),
        ("~", None),
        ("1:30", "1:30"),
        ("2026-11-23", "2026-11-23"),
        ("-.inf", float("-inf")),
        ("e5", "e5"),
        ("1_000", "1_000"),
    ],
)
def test_words_are_read_as_people_expect(word, value):
    found = scalar(word)
    assert found == value
    assert type(found) is type(value)


def test_the_same_words_in_a_file(tmp_path):
    text = toy_world.DOMAIN.replace("tolerance: 0.5", "tolerance: 1e-3").replace(
        "budget:", "constants:\n  WORD: {value: no}\n  TEXT: {value: '12'}\n  SMALL: {value: 1e-3}\nbudget:"
    )
    spec = load_domain(toy_world.write(tmp_path, text))
    assert spec.constraints["on_wire"].tolerance == 0.001
    assert [spec.constants[n].value for n in ("WORD", "TEXT", "SMALL")] == ["no", "12", 0.001]


def test_an_explicit_tag_wins_over_the_looks_of_a_word(tmp_path):
    text = toy_world.DOMAIN.replace("budget:", "constants: {WORD: {value: !!str 12}}\nbudget:")
    assert load_domain(toy_world.write(tmp_path, text)).constants["WORD"].value == "12"


def test_five_mistakes_are_five_lines_in_order(tmp_path):
    text = (
        toy_world.DOMAIN.replace("summary: A bead.", "sumary: A bead.")
        .replace("place: {type: float", "place: {type: flaot")
        .replace("toy_world:slide", "toy_wrld:slide")
        .replace("tolerance: 0.5", "tolerance: -1")
        .replace("budget:", "name: again\nbudget:")
    )
    error = mistakes(tmp_path, text)
    found = lines_of(error)
    # a misspelled required key is two mistakes: the key that is too much, and the one that is missing
    assert [line for line, _ in found] == sorted(line for line, _ in found)
    by_line = {}
    for line, rest in found:
        by_line.setdefault(line, []).append(rest)
    assert "did you mean 'summary'?" in " ".join(by_line[line_number(text, "sumary")])
    assert "there is no type 'flaot'; did you mean 'float'?" in by_line[line_number(text, "flaot")][0]
    assert "there is no module 'toy_wrld'" in by_line[line_number(text, "toy_wrld")][0]
    assert "greater than or equal to 0" in by_line[line_number(text, "tolerance")][0]
    assert "second time" in by_line[line_number(text, "name: again")][0]
    assert str(error.value).splitlines() == [str(i) for i in error.value.issues]
    assert all(str(i).startswith(f"{tmp_path / 'domain.yaml'}:") for i in error.value.issues)


@pytest.mark.parametrize(
    ("right", "wrong", "line", "words"),
    [
        ("unit: m}", "unit: m}\n      name: {type: int}", "name: {type: int}", "second time (first in line"),
        ("says:", "sais:", "sais", "unknown key 'sais'; did you mean 'says'?"),
        (
            "spec_version: 1",
            "spec_version: 2",
            "spec_version",
            "--upgrade proc3s` may bring a newer one), not 2",
        ),
        ("spec_version: 1", "spec_version: one", "spec_version", "should be 1, not 'one'"),
        ("state: Scene", "state: Scen", "state:", "did you mean 'Scene'?"),
        ('"toy_world:Wire"', "toy_world.Wire", "toy_world.Wire", "pattern"),
        ("type: object", "type: objekt", "objekt", "'object'"),
        ("noise: 2", "noise: much", "noise", "number"),
        ("budget: {paper: 100", "budget: {paper: many", "budget", "integer"),
        ("type: object", "type: str", "bead: {type: str}", "needs choices"),
        ("noise: 2", "min: 3, max: 2", "min: 3", "above"),
    ],
)
def test_a_mistake_names_its_line_and_what_would_be_right(tmp_path, right, wrong, line, words):
    text = toy_world.DOMAIN.replace(right, wrong, 1)
    found = lines_of(mistakes(tmp_path, text))
    assert any(n == line_number(text, line) and words in rest for n, rest in found), found


def test_a_missing_key_names_the_line_of_what_lacks_it(tmp_path):
    text = toy_world.DOMAIN.replace("    summary: Slides a bead.\n", "")
    (line, rest), *others = lines_of(mistakes(tmp_path, text))
    assert (line, rest) == (line_number(text, "  slide:"), "skills.slide.summary: is missing")
    assert not others


@pytest.mark.parametrize(
    "text",
    [
        "a: [1, 2",
        "a: 'open",
        "\t- x",
        "a: b: c",
        "? {a: 1}\n: 2\n- 3",
        "a: *nothing",
        "- just\n- a list",
        "5",
        "",
    ],
)
def test_what_is_no_domain_at_all_is_said_in_lines(tmp_path, text):
    for line, rest in lines_of(mistakes(tmp_path, text)):
        assert line >= 1
        assert rest


def test_a_file_that_is_no_text(tmp_path):
    path = tmp_path / "domain.yaml"
    path.write_bytes(b"name: \xff\xfe\x00")
    with pytest.raises(SpecError, match="not valid YAML"):
        load_domain(path)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(SpecError, match=r"nowhere\.yaml: cannot be read"):
        load_domain(tmp_path / "nowhere.yaml")


def test_an_alias_that_contains_itself_is_a_mistake_of_the_file(tmp_path):
    mistakes(tmp_path, toy_world.DOMAIN + "constants: &a\n  X: {value: [*a]}\n")


def test_a_package_that_breaks_while_it_is_looked_for_is_a_mistake_of_the_file(tmp_path, monkeypatch):
    package = tmp_path / "toy_broken"
    package.mkdir()
    (package / "__init__.py").write_text("raise RuntimeError('out of order')\n")
    monkeypatch.syspath_prepend(tmp_path)
    text = toy_world.DOMAIN.replace("toy_world:slide", "toy_broken.skills:slide")
    found = lines_of(mistakes(tmp_path, text))
    assert any("toy_broken" in rest for _, rest in found)


def test_a_field_of_objects_that_the_state_lacks_is_a_mistake_of_the_file(tmp_path):
    text = toy_world.DOMAIN.replace("objects: beads", "objects: bead")
    (line, rest), *_ = lines_of(mistakes(tmp_path, text))
    assert line == line_number(text, "objects:")
    assert "did you mean 'beads'?" in rest


def test_types_that_contain_each_other_are_a_mistake_of_the_file(tmp_path):
    text = toy_world.DOMAIN.replace(
        "      name: {type: str}", "      name: {type: str}\n      on: {type: Bead}"
    )
    mistakes(tmp_path, text)


def test_a_path_in_arguments_is_beside_the_file(tmp_path):
    text = toy_world.write(tmp_path).read_text()
    head, _, tail = text.partition("world: {")
    (tmp_path / "domain.yaml").write_text(
        f"{head}world: {{args: {{file: ./a/b.txt, word: a/b, n: [./c]}}, {tail}"
    )
    args = load_domain(tmp_path / "domain.yaml").world.args
    assert args == {"file": str(tmp_path / "a/b.txt"), "word": "a/b", "n": [str(tmp_path / "c")]}
