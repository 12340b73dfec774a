"""Help is read in a terminal of 80 columns: options stand in panels, and have room for their words."""

import re

import pytest


@pytest.fixture
def help_of(cli, monkeypatch):
    """The help of a command as a terminal of 80 columns shows it."""
    monkeypatch.setenv("COLUMNS", "80")

    def shown(command):
        result = cli(*command.split(), "--help")
        assert result.code == 0, result.stderr
        return result.stdout

    return shown


def panels(text):
    return re.findall(r"^╭─ (.+?) ─+╮$", text, re.MULTILINE)


@pytest.mark.parametrize(
    ("command", "named"),
    [
        ("run", ["Arguments", "LLM", "Search", "World", "Output"]),
        ("solve", ["Arguments", "Search", "World", "Output"]),
        ("render-prompt", ["Arguments", "Search", "LLM", "World", "Output"]),
        ("replay", ["Arguments", "Search", "World", "Output"]),
        ("bench", ["Arguments", "Episodes", "LLM", "Search", "World", "Output"]),
        ("bench ccsp", ["Episodes", "Search", "World", "Output"]),
        ("bench execution", ["Episodes", "Search", "World", "Output"]),
        ("bench command", ["Episodes", "Search", "World", "Output"]),
        ("explain", ["Arguments", "Options"]),
    ],
)
def test_options_stand_in_panels(help_of, command, named):
    assert panels(help_of(command)) == named


@pytest.mark.parametrize(
    "command", ["run", "solve", "render-prompt", "bench", "bench ccsp", "check", "new domain"]
)
def test_the_words_of_an_option_have_half_a_line(help_of, command):
    """The column of the words begins in the left half, so that a line holds more than a few of them."""
    text = help_of(command)
    assert max(map(len, text.splitlines())) <= 80
    begins = [found.start(1) for found in re.finditer(r"(?<=  )(one JSON document|Show this message)", text)]
    starts = [place - text.rindex("\n", 0, place) for place in begins]
    assert starts
    assert max(starts) <= 42
    assert not re.search(r"<(bool|int range|float range|list)", text)


def test_defaults_are_not_taken_for_markup(help_of):
    text = " ".join(re.sub(r"[│\s]+", " ", help_of("run")).split())
    assert "stub:FILE (default: PROC3S_LLM, proc3s.toml, replay)" in text
    assert "open (default: best)" in text


def test_a_benchmark_that_is_no_suite_has_a_help_of_its_own(help_of):
    suite, ccsp, execution = map(help_of, ("bench", "bench ccsp", "bench execution"))
    assert "proc3s bench ccsp" in suite
    assert "proc3s bench execution" in suite
    assert ("--methods" in suite, "--throughput" in suite) == (True, False)
    assert ("--methods" in ccsp, "--throughput" in ccsp, "--times" in ccsp) == (False, True, False)
    assert ("--llm" in execution, "--times" in execution, "--robust" in execution) == (False, True, True)
