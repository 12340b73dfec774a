# Dataclasses of its own, frozen, ordered, with methods and defaults.
# expect: plan: draw_line(1, 2, 4, 6)
# answer: program
from dataclasses import asdict, dataclass, field, replace

@dataclass(frozen=True, order=True)
class Point:
    x: float
    y: float = 0.0
    tags: list = field(default_factory=list, compare=False)

    def __add__(self, other):
        return Point(self.x + other.x, self.y + other.y)

def gen_plan(state):
    a = replace(Point(1), y=2)
    b = a + Point(3, 4)
    assert a < b and asdict(a) == {"x": 1, "y": 2, "tags": []}
    return [Action("draw_line", [a.x, a.y, b.x, b.y])]
