"""A model that follows a script, asked from the command line."""

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

LOOSE = Path(__file__).with_name("talker.py")
STAR = """
```python
def gen_plan(initial, x, y, radius):
    def corner(k):
        angle = math.pi / 2 + 4 * math.pi * k / 5
        return [x + radius * math.cos(angle), y + radius * math.sin(angle)]
    return [Action("draw_line", corner(k) + corner(k + 1)) for k in range(5)]

def gen_domain(initial):
    where = ContinuousSampler(10, 90)
    return {"x": where, "y": where, "radius": ContinuousSampler(8, 20)}
```
"""
OUTSIDE = """
```python
def gen_plan(initial, x):
    return [Action("draw_line", [50, 1, 51, 1]), Action("draw_line", [-1, 1, x, 1])]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 1)}
```
"""
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
