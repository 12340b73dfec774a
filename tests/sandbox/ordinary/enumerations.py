# Enumerations and sets.
# expect: plan: look((1, 2, 3), far); repeat(2)
# answer: program
from enum import Enum, auto

class Mode(str, Enum):
    NEAR = "near"
    FAR = "far"

class Side(Enum):
    LEFT = auto()
    RIGHT = auto()

def gen_plan(state):
    names = {o.name for o in state.obstacles} | {"object_0"}
    return [Action("look", [(1, 2, 3), Mode.FAR.value]), Action("repeat", [len(names)])]
