"""Run folders of every kind, made once, and words about them."""

import json
from types import SimpleNamespace

import pytest

from sample_answers import OUTSIDE

WIDER = OUTSIDE.replace("ContinuousSampler(0, 1)", "ContinuousSampler(0, 2)").replace("-1, 1, x", "0.5, y, x")
WIDER = WIDER.replace("initial, x", "initial, x, y").replace('{"x"', '{"y": ContinuousSampler(-3, 1), "x"')
BROKEN = """
```python
def gen_plan(initial, x):
    return [Action("draw_line", [initial.nothing, 1, 2, 3])]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 1)}
```
"""


@pytest.fixture
def failing():
    """OUTSIDE never is accepted, WIDER is now and then, BROKEN is no usable program."""
    return SimpleNamespace(outside=OUTSIDE, wider=WIDER, broken=BROKEN)


@pytest.fixture
def two_rounds(cli, stub, here):
    """A run whose second program is accepted."""
    done = cli(
        *("run", "drawing/free", "--goal", "two lines", "--samples", 60),
        *("--llm", stub(OUTSIDE, WIDER), "--out", "two"),
    )
    assert done.code == 0, done.stderr
    return here / "two"


@pytest.fixture
def rewrite():
    """Changes every event of a log, as an earlier version might have written it."""

    def change(run, function):
        log = run / "events.jsonl"
        events = [function(json.loads(line)) for line in log.read_text().splitlines()]
        log.write_text("".join(json.dumps(event) + "\n" for event in events if event))

    return change
