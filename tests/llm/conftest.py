"""A model that follows a script, asked from the command line."""

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from sample_answers import OUTSIDE, STAR

LOOSE = Path(__file__).with_name("talker.py")
HOPELESS = OUTSIDE.replace("[50, 1, 51, 1]", "[-9, 1, 51, 1]")


@pytest.fixture
def texts():
    """STAR is solved; OUTSIDE fails at its second step, HOPELESS at its first."""
    return SimpleNamespace(star=STAR, outside=OUTSIDE, hopeless=HOPELESS)


@pytest.fixture
def script(here):
    """`script(*entries)` is the `--llm` and `--plugin` of a model that says these things."""

    def write(*entries):
        (here / "script.json").write_text(json.dumps(entries))
        return ("--llm", "talker:script.json", "--plugin", LOOSE)

    return write


@pytest.fixture
def asked(here):
    """Every request that the model got, in order."""

    def read():
        path = here / "script.asked"
        return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []

    return read
