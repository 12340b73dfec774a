"""Answers that a language model might give."""

import pytest

from sample_answers import OUTSIDE, STAR

LITERAL = """
```python
gen_plan = [Action("draw_line", [1, 1, 2, 1]), Action("draw_line", [LEFT, 1, 3, 1])]
```
"""


def literal(left):
    """A plan in full whose second line starts at `left`."""
    return LITERAL.replace("LEFT", str(left))


@pytest.fixture
def answers():
    """STAR is solved, OUTSIDE never is, literal(-1) violates and literal(1) does not."""
    from types import SimpleNamespace

    return SimpleNamespace(star=STAR, outside=OUTSIDE, literal=literal)
