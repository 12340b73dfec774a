"""The constraints of the table-top: what the world measured in an action, as margins in metres."""

import math
from collections.abc import Iterator
from typing import Any, TypeAlias

from proc3s import Margin, Transition
from proc3s_tabletop import sentences
from proc3s_tabletop.robot.hand_profile import WIDEST
from proc3s_tabletop.robot.settings import LEVER, ReferenceSettings
from proc3s_tabletop.telemetry import TABLE, Displacement, Telemetry

Step: TypeAlias = Transition[Telemetry]

SETTINGS = ReferenceSettings()
PAD_WIDTH = 0.018
"""What the grid of rays between the pads spans, m: turns its share that is met into a distance."""
UNMEASURED = 1e-3
"""By how much a rule is broken where nothing says by how much, m."""


def kinematic(step: Step) -> Margin | None:
    """How much nearer to its line the grasp point keeps than it must; negative is the miss."""
    residual = step.telemetry.ik_residual
    if residual is None:
        return None
    return Margin(SETTINGS.ik_tolerance - residual)


def collision(step: Step, highest: float) -> Margin | None:
    """The smallest clearance of robot and held object, negative in contact.

    What is set down must not meet a support more than `highest` above the commanded z either.
    """
    measured = step.telemetry
    found = [*_contact(step), *_met_too_early(step, highest), *_squeezed(step)]
    if found:
        return min(found, key=lambda margin: margin.value)
    if measured.ended and measured.clearance is None:
        return None
    return _passes(step) or Margin(SETTINGS.near)


def grasp(step: Step) -> Margin | None:
    """How far a pick is from losing its object, by what lies between the pads and by its slip; negative if
    nothing was grasped, or it slipped."""
    measured = step.telemetry
    if measured.attempted != "pick" or (measured.ended and not _is_bad_grasp(step)):
        return None
    if measured.ended:
        return Margin(-_lack(step), {"why": _why_no_grasp(step)})
    if measured.held is None:
        return Margin(-UNMEASURED, {"why": sentences.COMES_UP_EMPTY})
    if measured.wanted not in (None, measured.held):
        other, wanted = thing(step, measured.held), thing(step, str(measured.wanted))
        return Margin(-UNMEASURED, {"why": sentences.closes_on_other(other, wanted)})
    spare, what = min(_spare(measured)), thing(step, measured.held)
    return Margin(spare, {"why": sentences.slips(what)}, sentences.could_slip(what, spare))


def _spare(measured: Telemetry) -> Iterator[float]:
    """How much of what was measured could be lost without losing the object."""
    yield SETTINGS.max_slip - (measured.slip or 0.0)
    yield (SETTINGS.max_slip_angle - (measured.slip_angle or 0.0)) * LEVER
    if measured.cover is not None:
        yield (measured.cover - SETTINGS.min_cover) * PAD_WIDTH


def placement(step: Step, moved: float, turned: float, lowest: float) -> Margin | None:
    """How far everything not in hand is from having moved too far (m, rad) and from leaving the table, and
    how much higher the support was met than `lowest` below the commanded z; all negative when violated."""
    measured = step.telemetry
    placing = measured.attempted == "place"
    if placing and measured.target is None and measured.ended in (None, "hand"):
        return Margin(-UNMEASURED, {"why": sentences.NOTHING_TO_SET_DOWN})
    if placing and measured.ended == "hand":
        why = sentences.holds_other(*(thing(step, str(name)) for name in (measured.target, measured.wanted)))
        return Margin(-max(UNMEASURED, measured.grasp_apart or 0.0), {"why": why})
    if measured.ended and measured.ended != "support":
        return None
    height = measured.support_height
    found = [_bounds(step)]
    if height is not None:
        found.append(_drop(step, lowest + height))
    if measured.at_rest is False:
        found.append(Margin(-UNMEASURED, {"why": sentences.RESTLESS}))
    found += [_stays(step, d, moved, turned) for d in measured.displacements or ()]
    least = min(found, key=lambda margin: margin.value)
    why = ", and ".join(m.details["why"] for m in found if m.value < 0)
    return Margin(least.value, {"why": why}, least.says)


def thing(step: Step, name: str) -> str:
    """A body for people: `object_3 (the red block)`, `the table`, `the gripper`."""
    return sentences.called(getattr(step.before, "objects", {}), name)


def _contact(step: Step) -> Iterator[Margin]:
    """The contact that ended the action, unless it is the fault of the grasp."""
    measured = step.telemetry
    if measured.ended not in sentences.COLLISIONS or measured.clearance is None or _is_bad_grasp(step):
        return
    body, other = measured.clearance.body, measured.clearance.other
    what = sentences.in_hand(thing(step, body)) if body == measured.target else thing(step, body)
    details = sentences.collides(what, thing(step, other), sentences.COLLISIONS[measured.ended])
    yield Margin(min(measured.clearance.distance, -SETTINGS.touch), details)


def _passes(step: Step) -> Margin | None:
    """How near robot or load come to anything, without a contact."""
    clearance = step.telemetry.clearance
    if clearance is None:
        return None
    one, other = thing(step, clearance.body), thing(step, clearance.other)
    return Margin(max(0.0, clearance.each), says=sentences.passes(one, other, max(0.0, clearance.distance)))


def _squeezed(step: Step) -> Iterator[Margin]:
    """A contact in an action that came to its end: where the arm yields, that does not stop it."""
    clearance = step.telemetry.clearance
    if not step.telemetry.ended and clearance and clearance.distance < -SETTINGS.penetration:
        body, other = thing(step, clearance.body), thing(step, clearance.other)
        yield Margin(clearance.distance, sentences.collides(body, other, sentences.SQUEEZED))


def _met_too_early(step: Step, highest: float) -> Iterator[Margin]:
    """A support well above the commanded z: a stack that nobody asked for."""
    height, support = step.telemetry.support_height, step.telemetry.support
    if height is not None and support is not None and height > highest:
        held = sentences.in_hand(thing(step, str(step.telemetry.target)))
        details = sentences.collides(held, thing(step, support), sentences.MET_TOO_EARLY)
        yield Margin(highest - height, details)


def _is_bad_grasp(step: Step) -> bool:
    """Whether a pick ended because of how it grasps, and not because of what is in the way."""
    measured = step.telemetry
    if measured.attempted != "pick":
        return False
    if measured.ended == "approach" and measured.clearance:
        return measured.clearance.other == _meant(step)[0]
    slipped = measured.ended == "close" and measured.grip_force is not None
    return slipped or measured.ended in ("hand", "grasp", "lift")


def _why_no_grasp(step: Step) -> str:
    measured = step.telemetry
    meant = _meant(step)[0]
    if measured.ended == "hand":
        return sentences.holds_already(thing(step, str(measured.held)))
    if measured.too_wide:
        return sentences.too_wide(thing(step, measured.too_wide), WIDEST)
    if measured.ended == "grasp" and not measured.cover:
        if measured.wanted:
            return sentences.misses(thing(step, measured.wanted))
        return sentences.nothing_between(thing(step, meant) if meant else None)
    if measured.ended == "approach":
        return sentences.comes_down_on(thing(step, str(meant)))
    what = thing(step, str(measured.target))
    if measured.ended == "grasp":
        return sentences.too_little(what)
    if measured.ended == "close":
        return sentences.one_sided(what)
    return sentences.slips_out(what)


def _lack(step: Step) -> float:
    """By how much a grasp failed, as far as the stage at which it did measured that."""
    measured = step.telemetry
    if measured.ended == "grasp" and measured.cover:
        return max(UNMEASURED, (SETTINGS.min_cover - measured.cover) * PAD_WIDTH)
    if measured.ended == "grasp":
        return max(SETTINGS.min_cover * PAD_WIDTH, _meant(step)[1])
    if measured.ended == "lift":
        return max(SETTINGS.touch, -min(_spare(measured)))
    if measured.ended == "approach" and measured.clearance:
        return max(SETTINGS.touch, -measured.clearance.distance)
    return UNMEASURED


def _meant(step: Step) -> tuple[str | None, float]:
    """The object that the action names, or whose centre is nearest to the commanded point, and how far that
    is from it, m."""
    objects: Any = getattr(step.before, "objects", {})
    point, wanted = step.telemetry.commanded, step.telemetry.wanted
    if point is None:
        return wanted, PAD_WIDTH
    found = {name: math.dist(point, (o.pose.x, o.pose.y, o.pose.z)) for name, o in objects.items()}
    name = wanted or min(found, key=lambda n: found[n], default=None)
    return name, found[name] if name else PAD_WIDTH


def _bounds(step: Step) -> Margin:
    bound = step.telemetry.bounds
    if bound is None:
        return Margin(SETTINGS.near, {"why": ""})
    what = sentences.TARGET if bound.name == "target" else thing(step, bound.name)
    says = sentences.inside(what, bound.distance)
    return Margin(bound.distance, {"why": sentences.out_of_bounds(what)}, says)


def _drop(step: Step, margin: float) -> Margin:
    """How much higher what is set down might be let go."""
    what, below = thing(step, str(step.telemetry.target)), thing(step, step.telemetry.support or TABLE)
    return Margin(margin, {"why": sentences.drops(what, below)}, sentences.supported(what, below, margin))


def _stays(step: Step, d: Displacement, moved: float, turned: float) -> Margin:
    """How much less than allowed an object moved."""
    if d.name == step.telemetry.target:
        says = sentences.does_not_stay
    elif d.name in (step.telemetry.knocked_over or ()):
        says = sentences.knocked_over
    else:
        says = sentences.moved_along
    left, what = min(moved - d.shift, (turned - d.turned) * LEVER), thing(step, d.name)
    return Margin(left, {"why": says(what)}, sentences.stays(what, left))
