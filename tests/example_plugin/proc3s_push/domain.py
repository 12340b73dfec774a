"""Scene, skill, constraints and judge of the domain."""

import math
from dataclasses import replace

import numpy as np

from proc3s import Margin, Score

RADIUS, HALF = 0.05, 0.5


def scattered(rng, count):
    spots = np.array([(x, y) for x in (-0.36, -0.12, 0.12, 0.36) for y in (-0.36, -0.12, 0.12, 0.36)])
    chosen = rng.permutation(spots)[:count] + rng.uniform(-0.05, 0.05, (count, 2))
    pucks = [{"name": f"puck_{k}", "x": x, "y": y} for k, (x, y) in enumerate(chosen.tolist())]
    return {"half": HALF, "pucks": pucks}


def push(world, puck, dx, dy):
    moved = [replace(p, x=p.x + dx, y=p.y + dy) if p.name == puck else p for p in world.state.pucks]
    world.state = replace(world.state, pucks=tuple(moved))


def ends(transition):
    return [
        next(p for p in s.pucks if p.name == transition.action.args[0])
        for s in (transition.before, transition.after)
    ]


def on_table(transition):
    _, puck = ends(transition)
    return Margin(transition.after.half - max(abs(puck.x), abs(puck.y)), {"puck": puck.name})


def apart(transition):
    a, b = (np.array([p.x, p.y]) for p in ends(transition))
    name, along = transition.action.args[0], (b - a) / max(np.linalg.norm(b - a), 1e-9)
    gaps = []
    for other in (p for p in transition.before.pucks if p.name != name):
        at = np.array([other.x, other.y])
        near = a + along * np.clip((at - a) @ along, 0, np.linalg.norm(b - a))
        gaps.append((float(np.linalg.norm(at - near)) - 2 * RADIUS, other.name))
    return Margin(min(gaps)[0], {"puck": name, "other": min(gaps)[1]}) if gaps else None


def gathered(state, plan, reach):
    far = max(state.pucks, key=lambda p: math.hypot(p.x, p.y))
    return Score(
        math.hypot(far.x, far.y) <= reach, f"{far.name} is {math.hypot(far.x, far.y):.2f} m from the middle"
    )
