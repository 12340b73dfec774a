"""What is said of an action or a scene that fails, each sentence written once, whoever finds the failure.

Constraints measure it in a world, screens foresee it, a scene may begin with it. Sentences name what is
involved and leave numbers to the margins, so that the same failure reads the same in every sample; those at
the end say what is left where nothing fails, with the number. `what` is a body as `called` names it, lengths
are metres. What a judge says of a goal is said in that judge alone.
"""

from collections.abc import Mapping
from typing import Any

COLLISIONS = {
    "approach": "on its way to the grasp",
    "close": "while it closes",
    "carry": "on its way",
    "descent": "on its way down to set the object down",
    "release": "while it opens and leaves",
}
"""The stages of an action that end in contact, and what was going on."""
SQUEEZED = "where the fingers close or open"
MET_TOO_EARLY = "far above the z where it should be set down"

COMES_UP_EMPTY = "the hand comes up empty"
NOTHING_TO_SET_DOWN = "there is nothing in the hand to set down"
RESTLESS = "the objects do not come to rest"
TARGET = "the commanded point"


def called(objects: Mapping[str, Any], name: str) -> str:
    """A body for people: `object_3 (the red block)`, an object of a state, or `the table`, `the gripper`."""
    if name not in objects:
        return f"the {name}"
    return f"{name} (the {f'{objects[name].color} {objects[name].category}'.strip()})"


def in_hand(what: str) -> str:
    """A body that the hand carries."""
    return f"{what} in the hand"


def collides(body: str, other: str, when: str) -> dict[str, str]:
    """The details of a collision; the domain has the sentence."""
    return {"body": body, "other": other, "when": when}


def holds_already(what: str) -> str:
    """A pick begins with a full hand."""
    return f"the hand already holds {what}"


def holds_other(what: str, wanted: str) -> str:
    """A place names an object that is not in hand, or a grasp by which it is not held."""
    if what != wanted:
        return f"the hand holds {what}, not {wanted}"
    return f"the hand holds {what} by another grasp than the place names"


def too_wide(what: str, widest: float) -> str:
    """A body does not fit between the fingers, which take `widest`."""
    return f"{what} is too wide there for the fingers, which take at most {1000 * widest:.0f} mm"


def comes_down_on(what: str) -> str:
    """The open fingers meet what they are to grasp from above."""
    return f"the fingers come down on {what} instead of around it"


def nothing_between(nearest: str | None) -> str:
    """A pick at a point where there is nothing."""
    hint = f"; the nearest object is {nearest}" if nearest else ""
    return f"nothing is between the fingers{hint}"


def misses(what: str) -> str:
    """Nothing of the object that a pick names is between the fingers."""
    return f"the fingers miss {what}"


def too_little(what: str) -> str:
    """A body is between the fingers, but not well between them."""
    return f"the fingers get too little of {what} between them"


def one_sided(what: str) -> str:
    """Only one side of the closed hand presses a body."""
    return f"the fingers do not hold {what} from both sides"


def slips_out(what: str) -> str:
    """The lift test loses a body."""
    return f"{what} slips out of the fingers"


def slips(what: str) -> str:
    """The lift test keeps a body, but lets it move too far."""
    return f"{what} slips in the fingers"


def closes_on_other(what: str, wanted: str) -> str:
    """The hand holds another body than the pick names."""
    return f"the fingers close on {what} instead of {wanted}"


def drops(what: str, below: str) -> str:
    """A place lets go too high above what is below."""
    return f"{what} would be dropped from high above {below}"


def does_not_stay(what: str) -> str:
    """A body moves from where a place lets it go."""
    return f"{what} does not stay where it is released"


def knocked_over(what: str) -> str:
    """Another body than the target leans over."""
    return f"{what} is knocked over"


def moved_along(what: str) -> str:
    """Another body than the target is not where it was."""
    return f"{what} is moved along"


def out_of_bounds(what: str) -> str:
    """A body, or TARGET, is not above the table."""
    return f"{what} lies outside the bounds of the table"


def deep_in(what: str, other: str, depth: float) -> str:
    """A scene has two bodies in one place."""
    return f"{what} is {1000 * depth:.0f} mm deep in {other}"


def passes(what: str, other: str, distance: float) -> str:
    """A body comes near another without touching it."""
    return f"{what} passes {other} at {1000 * distance:.1f} mm"


def could_slip(what: str, further: float) -> str:
    """A grasp holds, and would at most lose so much more."""
    return f"{what} is held with {1000 * further:.1f} mm to spare"


def inside(what: str, distance: float) -> str:
    """A body, or TARGET, is above the table."""
    return f"{what} is {1000 * distance:.1f} mm inside the bounds of the table"


def stays(what: str, further: float) -> str:
    """A body hardly moves, and might by so much more."""
    return f"{what} stays where it is with {1000 * further:.1f} mm to spare"


def supported(what: str, below: str, further: float) -> str:
    """A place lets go not far above what is below, and might be higher by so much."""
    return f"{what} meets {below} with {1000 * further:.1f} mm to spare"
