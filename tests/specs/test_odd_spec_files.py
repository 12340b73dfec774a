"""Spec files that are too large or deep, no YAML, or say what nothing can fulfil: refused, with the place."""

import time

import pytest

import toy_world
from proc3s import ConstraintSpec, SpecError, load_domain
from proc3s.specs.domain import ParamSpec


def refusal(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(SpecError) as raised:
        load_domain(path)
    return str(raised.value)


def bomb():
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 10)]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("a: b\nx: " + "[" * 5000, ["d.yaml:2", "nested more than 64 deep"]),
        ("\n".join(" " * n + "a:" for n in range(800)), ["d.yaml:6", "nested more than 64 deep"]),
        (bomb(), ["d.yaml:1", "aliases repeat more than 10,000 values"]),
        ("x" * 2_000_000, ["d.yaml", "more than 1,000,000 bytes"]),
        ("base: &b {name: toy}\nother:\n  <<: *b\n", ["d.yaml:3", "merge keys (`<<`) are not supported"]),
        ("a: 1\n? [b, c]\n: 2\n", ["d.yaml:2", "a key must be a word"]),
        ("a: 1\nb: \0\n", ["d.yaml:2", "not valid YAML", "'\\x00'"]),
        ("a:\n\t- b\n", ["d.yaml:2", "not valid YAML"]),
        ("a: 1\n---\na: 2\n", ["d.yaml:2", "not valid YAML"]),
        (b"a: 1\nb: \xff\n", ["d.yaml:2", "not UTF-8 (byte 0xff)"]),
        ("", ["d.yaml:1", "name", "is missing"]),
        ("name: " + "9" * 5000, ["d.yaml:1", "name"]),
    ],
)
def test_what_no_spec_file_is(tmp_path, content, words):
    begun = time.perf_counter()
    text = refusal(tmp_path / "d.yaml", content)
    assert time.perf_counter() - begun < 3.0
    for word in words:
        assert word in text


def test_a_folder_in_the_place_of_a_file(tmp_path):
    with pytest.raises(SpecError, match="cannot be read"):
        load_domain(tmp_path)


def test_a_quoted_key_is_no_merge_key(tmp_path):
    text = toy_world.DOMAIN.replace("constants:", 'constants:\n  TABLE: {value: {"<<": 1}}')
    path = tmp_path / "d.yaml"
    path.write_text(text if "TABLE" in text else text + 'constants: {TABLE: {value: {"<<": 1}}}\n')
    assert load_domain(path).constants["TABLE"].value == {"<<": 1}


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ("{type: float, max: .nan}", ["d.yaml:9", "max", ".nan is no number"]),
        ("{type: float, min: 2, max: 1}", ["d.yaml:9", "min 2.0 is above max 1.0"]),
        ("{type: float, min: .inf}", ["d.yaml:9", "no legal value"]),
        ("{type: float, noise: .inf}", ["d.yaml:9", "noise", "finite"]),
        ("{type: float, noise: -1}", ["d.yaml:9", "noise", "greater than or equal to 0"]),
    ],
)
def test_numbers_that_leave_nothing(tmp_path, spec, words):
    text = refusal(tmp_path / "d.yaml", DOMAIN.replace("SPEC", spec))
    for word in words:
        assert word in text


DOMAIN = """\
spec_version: 1
name: toy
summary: Dots.
world: {target: "proc3s:World"}
state: Dots
types: {Dots: {summary: Dots., fields: {count: {type: int}}}}
skills:
  add: {summary: Adds., target: "json:loads", params: {
    by: SPEC}}
samplers: [ContinuousSampler]
constraints:
  few: {says: "too many", target: "json:loads"}
tasks: {three: {instruction: Three., initial: {target: "json:loads"}}}
budget: {paper: 10}
"""
PLAIN = DOMAIN.replace("SPEC", "{type: float}")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("paper: 10", "paper: 0", ["d.yaml:14", "budget.paper", "greater than or equal to 1"]),
        ('"too many"', '"{book overlaps"', ["d.yaml:12", "constraints.few.says", "expected '}'"]),
        ('"too many"', '"{} overlaps"', ["d.yaml:12", "constraints.few.says"]),
        ('"too many"', '"{0} overlaps"', ["d.yaml:12", "constraints.few.says"]),
        ('"too many"', '"{a b} overlaps"', ["d.yaml:12", "a detail has a name, not 'a b'"]),
        ('"too many", ', '"too many", tolerance: -1, ', ["d.yaml:12", "tolerance"]),
        ('"too many", ', '"too many", tolerance: .inf, ', ["d.yaml:12", "tolerance", "finite"]),
        ('{target: "json:loads"}}}', '{target: "no_colon"}}}', ["d.yaml:13", "no_colon"]),
        ('{target: "json:loads"}}}', '{target: "json:loads", args: {x: .nan}}}}', ["d.yaml:13", ".nan"]),
    ],
)
def test_what_the_file_itself_shows_is_found_at_load(tmp_path, old, new, words):
    assert old in PLAIN
    text = refusal(tmp_path / "d.yaml", PLAIN.replace(old, new))
    for word in words:
        assert word in text


def test_the_plain_one_loads(tmp_path):
    path = tmp_path / "d.yaml"
    path.write_text(PLAIN.replace('"too many"', '"{{too}} many"'))
    assert load_domain(path).constraints["few"].says == "{{too}} many"


@pytest.mark.parametrize(
    "make",
    [
        lambda: ParamSpec(max=float("nan")),
        lambda: ConstraintSpec(name="few", says="{", target="json:loads"),
        lambda: ConstraintSpec(name="few", says="few", tolerance=float("nan"), target="json:loads"),
    ],
)
def test_specs_that_python_makes_are_no_exception(make):
    with pytest.raises(ValueError, match="validation error"):
        make()
