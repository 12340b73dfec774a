# Annotated to the last line, with names that were never imported.
# expect: plan: repeat(2)
from __future__ import annotations
from typing import Callable, Dict, List, Optional, Protocol, Tuple, TypeVar

T = TypeVar("T")
Table = Dict[str, Tuple[float, Optional[int]]]

class Maker(Protocol):
    def __call__(self, n: int) -> Action: ...

def first(items: List[T], key: Callable[[T], bool]) -> T:
    return next(i for i in items if key(i))

def gen_plan(initial: Scene, times: float) -> List[Action]:
    table: Table = {"a": (1.0, None)}
    maker: Maker = lambda n: Action("repeat", [n])
    return [maker(round(times) + first([0, 1], lambda i: i > 0) - len(table))]

def gen_domain(initial: Scene) -> Dict[str, ContinuousSampler | DiscreteSampler]:
    return {"times": ContinuousSampler(min=2, max=2)}
