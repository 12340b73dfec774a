"""Tables with blocks and bowls, random tasks on them, and the verdict that constraints will come to."""

import math

from proc3s_tabletop.actions.reference import Reference
from proc3s_tabletop.objects.body import CATEGORIES
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import ReferenceSettings


def frames_of(positions):
    """Upright frames of named positions (x, y, z) in metres."""
    return {name: Frame(tuple(map(float, xyz)), (0.0, 0.0, 0.0, 1.0)) for name, xyz in positions.items()}


def bodies_of(positions):
    """A bowl for every name that begins with bowl, a block for every other."""
    return {name: CATEGORIES["bowl" if name.startswith("bowl") else "block"] for name in positions}


def world_of(positions, speed=1.0):
    """A reference world with everything upright."""
    return Reference(bodies_of(positions), frames_of(positions), ReferenceSettings(speed=speed))


def verdict(telemetry):
    """Why an action is refused, or None."""
    if telemetry.ended:
        return telemetry.ended
    height = telemetry.support_height
    if height is not None and not -0.025 <= height <= 0.030:
        return "high" if height > 0 else "drop"
    if not telemetry.at_rest:
        return "restless"
    moved = [d for d in telemetry.displacements if d.shift > 0.012 or d.turned > 0.25]
    if moved:
        return "unstable" if telemetry.target in [d.name for d in moved] else "disturbed"
    return None


def carry_out(world, actions):
    """Do actions until one is refused: how many passed, why the next did not, all telemetry."""
    seen = []
    for skill, *point in actions:
        seen.append(getattr(world, skill)(*point))
        reason = verdict(seen[-1])
        if reason:
            return len(seen) - 1, reason, seen
    return len(seen), None, seen


def scattered(rng, count):
    """Places on the table, none near its middle, 0.1 m apart."""
    places = []
    while len(places) < count:
        place = rng.uniform([-0.2, -0.7], [0.2, -0.3])
        if max(abs(place - [0, -0.5])) > 0.12 and all(math.dist(place, p) > 0.1 for p in places):
            places.append(place)
        elif rng.uniform() < 0.01:
            places.clear()
    return places


def pyramid(rng):
    """Six blocks; three of them become a pyramid with random gap and offset of the top."""
    positions = {f"block{k}": (*place, 0.02) for k, place in enumerate(scattered(rng, 6))}
    x, y, pitch = rng.uniform(-0.05, 0.05), rng.uniform(-0.55, -0.45), rng.uniform(0.04, 0.07)
    over_x, over_y = rng.uniform(-0.025, 0.025, 2)
    goals = [(x - pitch / 2, y, 0.02), (x + pitch / 2, y, 0.02), (x + over_x, y + over_y, 0.06)]
    return positions, _actions(rng, positions, goals)


def packing(rng):
    """Five blocks go to two rows in the middle, some of them too close."""
    positions = {f"block{k}": (*place, 0.02) for k, place in enumerate(scattered(rng, 5))}
    slots = [(-0.05, -0.545), (0.0, -0.545), (0.05, -0.545), (-0.03, -0.455), (0.03, -0.455)]
    goals = [(*(slot + rng.normal(0, 0.006, 2)), 0.02) for slot in slots]
    return positions, _actions(rng, positions, goals)


def _actions(rng, positions, goals):
    """Pick the blocks in turn, up to 12 mm off centre, and place them."""
    plan = []
    for (x, y, z), goal in zip(list(positions.values()), goals, strict=False):
        off_x, off_y = rng.uniform(-0.012, 0.012, 2)
        plan += [("pick", x + off_x, y + off_y, z), ("place", *goal)]
    return plan


def jittered(rng, positions, by=0.0005):
    """The same positions, each moved in the plane by at most so much, metres."""
    return {
        name: (x + rng.uniform(-by, by), y + rng.uniform(-by, by), z) for name, (x, y, z) in positions.items()
    }


def moves(telemetry):
    """Displacements by the name of the object."""
    return {d.name: d for d in telemetry.displacements}
