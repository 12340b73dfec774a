"""Functions of a plugin that return something else than they must."""

import numpy as np

from proc3s import Margin, Score

WRONG = {
    "bool": True,
    "none": None,
    "string": "yes",
    "pair": (True, "yes"),
    "mapping": {"reached": True},
    "unsure": Score(None, "who knows"),
    "speechless": Score(True, None),
    "numpy": Score(np.bool_(True), "all well"),
    "lost": Score(True, "all well", float("nan")),
    "off": Score(True, "all well", "1"),
    "wide": Score(True, "far off", 2),
    "narrow": Score(True, "near", np.float32(0.25)),
    "nan": Margin(float("nan")),
    "no number": Margin("1"),
    "nameless": Margin(-1.0, "why"),
}


def judge(state, plan, answer):
    return WRONG[answer]


def initial(rng, answer):
    return WRONG[answer]


def margin(transition, answer):
    return WRONG[answer]


def screen(state, batch, answer):
    return [WRONG[answer]] * len(batch) if answer in ("string", "mapping") else WRONG[answer]


class Stateful:
    def __init__(self, domain, answer):
        self._answer = answer

    def check(self, state, plan):
        return WRONG[self._answer]


def skill(world, *args):
    return None


def beads(rng, names):
    return {"beads": [{"name": name, "place": 0.0} for name in names]}


def nameless_block(rng):
    pose = {"x": 0.0, "y": -0.5, "z": 0.02, "roll": 0.0, "pitch": 0.0, "yaw": 0.0}
    return {"objects": {"": {"category": "block", "color": "red", "pose": pose, "body": ""}}}
