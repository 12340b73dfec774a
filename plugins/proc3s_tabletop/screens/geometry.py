"""Vectorised screens of the table-top: what no simulation is needed for to see that it fails.

They look at whole batches of plans of picks and places from above, and reject what is certain to violate a
constraint by more than a band of 2 mm; the rest is for the world.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from proc3s import Domain, FloatArray, PlanBatch, State
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.constraints import kinematic
from proc3s_tabletop.robot import ik
from proc3s_tabletop.robot.grasp_frames import tool_poses, top_down
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.screens.batch import BatchScreening, Skill, Verdicts
from proc3s_tabletop.screens.layout import Bools, Layout, Rows, solids
from proc3s_tabletop.screens.pick import screen_pick
from proc3s_tabletop.screens.place import screen_place
from proc3s_tabletop.skills import pick, place

SETTINGS = ReferenceSettings()
ScreenSkill: TypeAlias = Callable[[BatchScreening, Layout, int, Rows, FloatArray], None]
SKILLS: dict[Skill, ScreenSkill] = {pick: screen_pick, place: screen_place}


def geometry(state: State, batch: PlanBatch, domain: Domain) -> Verdicts:
    """Boxes seen from above: fingers that come down on things, picks of nothing, places without support."""
    bodies = bodies_of(domain.spec.world.args.get("bodies"))
    screening = BatchScreening(state, batch, domain)
    layout = Layout(solids(state.objects, bodies), len(batch))  # type: ignore[attr-defined]
    if not layout.bodies.names:
        return screening.verdicts
    with np.errstate(invalid="ignore"):  # infinite slack
        for step in screening.steps:
            if not screening.leave_all_but(SKILLS, step):
                break
            for skill, screen in SKILLS.items():
                rows, at = screening.at(step, skill)
                if rows.size:
                    screen(screening, layout, step, rows, at)
    return screening.verdicts


def reach(state: State, batch: PlanBatch, domain: Domain) -> Verdicts:
    """The ends of every way down in closed form: what no branch of the arm reaches."""
    screening = BatchScreening(state, batch, domain)
    asked = [
        (step, skill, *screening.at(step, skill))
        for step in screening.steps
        if screening.leave_all_but(SKILLS, step)
        for skill in SKILLS
    ]
    if not asked:
        return screening.verdicts
    low = [at - np.array([0, 0, SETTINGS.press if skill is place else 0.0]) for _, skill, _, at in asked]
    high = [at + np.array([0, 0, SETTINGS.hover]) for *_, at in asked]
    missed = iter(np.split(~_reached(low, high), np.cumsum([len(at) for at in low])[:-1]))
    for step, _, rows, _ in asked:
        fails = next(missed) & screening.open[rows]
        # By how much, only the world measures: at least the next way-point.
        margins = np.full(int(fails.sum()), -SETTINGS.line_spacing)
        screening.reject(step, kinematic, rows[fails], margins, lambda i: {})
    return screening.verdicts


def _reached(*ends: list[FloatArray]) -> Bools:
    """Whether a branch brings the grasp point from above to every one of the ends (lists of (n, 3) points).

    Equal points are solved once.
    """
    points = np.vstack([point for end in ends for point in end])
    different, which = np.unique(points, axis=0, return_inverse=True)
    grasps = np.repeat(top_down(0.0, 0.0, 0.0)[None], len(different), axis=0)
    grasps[:, :3, 3] = different
    _, exists = ik.inverse(tool_poses(grasps))
    reached: Bools = np.asarray(exists.any(axis=1))
    return np.asarray(reached[which.reshape(len(ends), -1)].all(axis=0))
