"""The table-top toolbox: a UR5e with a Robotiq 2F-85 over a table, in PyBullet or MuJoCo.

Importing this package loads no simulator; a world loads it when it is made. A domain takes the skills and
constraints by `use: [pick, place, kinematic, collision, grasp, placement]`.
"""

from collections.abc import Callable

from proc3s import ConstraintSpec, SamplerSpec, SkillSpec, hookimpl
from proc3s.moved import MovedModules
from proc3s.specs.domain import ParamSpec
from proc3s_tabletop import sentences

MovedModules(
    __name__,
    {
        "scenes": ["tasks.scenes"],
        "judges": ["tasks.judges"],
        "formations": ["tasks.formations"],
        "standing": ["tasks.standing"],
        "selection": ["tasks.selection"],
        "programs": ["tasks.state_methods"],
        "grasp_sampler": ["tasks.grasp_sampler"],
        "execution": ["world"],
        "grasp_screen": ["screens.grasps"],
        "body_specs": ["catalogue.body_specs"],
    },
).install()

NOISE = 1.0
"""Standard deviation of the Gaussian methods at full scale, m (the paper)."""


@hookimpl
def register_skills(register: Callable[[SkillSpec], None]) -> None:
    """Pick and place from above, at points in metres."""
    register(
        SkillSpec(
            name="pick",
            target="proc3s_tabletop.skills:pick",
            summary="Moves the open hand straight down to (x, y, z), closes it and lifts what is between the "
            "fingers.",
            params=_point("height of the point between the fingertips: the centre of the object"),
            error="picked",
        )
    )
    register(
        SkillSpec(
            name="place",
            target="proc3s_tabletop.skills:place",
            summary="Moves the object in the hand over (x, y), down until it meets what is below, and lets "
            "it go.",
            params=_point("height at which it should meet its support, see above"),
        )
    )


def _point(z: str) -> dict[str, ParamSpec]:
    axes = {"x": "", "y": "", "z": z}
    return {name: ParamSpec(type="float", unit="m", says=says, noise=NOISE) for name, says in axes.items()}


@hookimpl
def register_samplers(register: Callable[[SamplerSpec], None]) -> None:
    """Grasps, for skills that name an object and how to grasp it."""
    register(
        SamplerSpec(
            name="GraspSampler",
            target="proc3s_tabletop.tasks.grasp_sampler:GraspSampler",
            summary="A grasp from above in the frame of an object, as an ArrangePose: at most 0.02 m from "
            "its centre along x and along y, any yaw.",
            params={},
            gives="ArrangePose",
        )
    )


@hookimpl
def register_constraints(register: Callable[[ConstraintSpec], None]) -> None:
    """What every pick and every place must fulfil, in this order."""
    register(
        ConstraintSpec(
            name="kinematic",
            target="proc3s_tabletop.constraints:kinematic",
            says="the arm cannot reach that point and the way straight down to it",
            rule="The arm reaches the point of every pick and place, and the way straight down to it.",
            tolerance=0.0,
            error="none",
        )
    )
    register(
        ConstraintSpec(
            name="collision",
            target="proc3s_tabletop.constraints:collision",
            says="{body} collides with {other} {when}",
            rule="Arm, hand and held object touch nothing on their way; what is set down meets its support "
            "at most 30 mm above the commanded z.",
            tolerance=0.0,
            args={"highest": 0.030},
            example=sentences.collides("the gripper", "the table", sentences.COLLISIONS["descent"]),
        )
    )
    register(
        ConstraintSpec(
            name="grasp",
            target="proc3s_tabletop.constraints:grasp",
            says="the grasp fails: {why}",
            rule="A pick comes with an empty hand, gets an object well between the fingers, and holds "
            "it fast.",
            tolerance=0.0,
            example={"why": sentences.nothing_between(None)},
        )
    )
    register(
        ConstraintSpec(
            name="placement",
            target="proc3s_tabletop.constraints:placement",
            says="{why}",
            rule="A place has something in hand and lets it go at most 25 mm above its support; what is not "
            "in hand stays within 12 mm of its place, and within the bounds of the table.",
            tolerance=0.0,
            args={"moved": 0.012, "turned": 0.25, "lowest": 0.025},
            example={"why": sentences.out_of_bounds(sentences.TARGET)},
        )
    )
