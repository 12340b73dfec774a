"""Answers that a language model might give, for all tests that need one."""

STAR = """
Some words.

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
    return [
        Action("draw_line", [50, 1, 51, 1]),
        Action("draw_line", [-1, 1, x, 1]),
    ]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 1)}
```
"""
