"""A vectorised screen of grasps: what fails for a lone body fails beside others, too."""

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np

from proc3s import Domain, FloatArray, PlanBatch, State
from proc3s_tabletop import sentences
from proc3s_tabletop.catalogue.body_specs import bodies_of, body_of
from proc3s_tabletop.constraints import PAD_WIDTH, UNMEASURED, grasp
from proc3s_tabletop.robot.hand_profile import WIDEST
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.screens.batch import BatchScreening, Verdicts, skill_of
from proc3s_tabletop.screens.layout import Bools
from proc3s_tabletop.screens.lone_grasps import LoneGrasps, lone_grasps
from proc3s_tabletop.skills import pick_object, place_object

SETTINGS = ReferenceSettings()
KNOWN = (pick_object, place_object)
"""What a plan does before a pick may be these only: another skill may tip things over."""
NEAR = 2e-4
"""A hand that is deeper in the body than the world allows by less than this may pass, m."""
SPARE = 0.05
"""A cover by this much under the least may be enough in the world: one ray more."""


def grasps(state: State, batch: PlanBatch, domain: Domain) -> Verdicts:
    """Picks of things that no step before has picked, by grasps that do not hold them where they stand alone.

    Others may be in the way besides, so nothing is known of a grasp that passes. A grasp follows its thing,
    so it does not matter if that has been pushed along, as long as it has not been tipped over.
    """
    screening = BatchScreening(state, batch, domain)
    picks = [s for s in batch.signatures if skill_of(domain, s) is pick_object]
    if picks:
        alone = _Alone(state, domain, picks[0].params[0].choices)
        # lift tests are dear: they are for plans of which no grasp fails otherwise
        for reject in (_misfits, _slips):
            _screen(screening, alone, reject)
    return screening.verdicts


Rejected: TypeAlias = tuple[Bools, FloatArray, list[str]]
"""Which of some grasps fail, by what margins (m, negative where they do), and why."""
Reject: TypeAlias = Callable[[LoneGrasps, FloatArray, str], Rejected]


class _Alone:
    """The objects of a scene by their number in the columns of a skill, each with its lone grasps."""

    def __init__(self, state: State, domain: Domain, names: tuple[str, ...]) -> None:
        self._bodies = bodies_of(domain.spec.world.args.get("bodies"))
        self._engine: str | None = domain.spec.world.args.get("engine")
        self._objects: Mapping[str, Any] = state.objects  # type: ignore[attr-defined]
        self.names = names

    def of(self, number: int) -> LoneGrasps:
        """What is known of grasping an object."""
        name = self.names[number]
        thing = self._objects[name]
        body = body_of(self._bodies, name, thing.category)
        return lone_grasps(body, round(thing.pose.roll, 4), round(thing.pose.pitch, 4), self._engine)


def _screen(screening: BatchScreening, alone: _Alone, reject: Reject) -> None:
    """Put the first pick of every object in every plan to a test."""
    picked = np.zeros((len(screening.open), len(alone.names)), bool)
    known = screening.first_other(KNOWN)
    for step in screening.steps:
        rows, values = screening.at(step, pick_object, 7)
        rows, values = rows[step < known[rows]], values[step < known[rows]]
        which, wanted = values[:, 0].astype(int), values[:, 1:]
        new = ~picked[rows, which]
        picked[rows, which] = True
        for number in np.unique(which[new]):
            mine = new & (which == number)
            bad, margins, whys = reject(alone.of(number), wanted[mine], screening.called(alone.names[number]))
            told = [{"why": why} for why, is_bad in zip(whys, bad, strict=True) if is_bad]
            screening.reject(step, grasp, rows[mine][bad], margins[bad], told.__getitem__)


def _misfits(known: LoneGrasps, wanted: FloatArray, what: str) -> Rejected:
    """Fingers that come down on the body, or get too little of it between them."""
    depth, cover = known.fits(wanted).T
    meets: Bools = depth > SETTINGS.penetration + NEAR
    poor: Bools = ~meets & (cover < SETTINGS.min_cover - SPARE)
    margins = np.where(meets, -depth, np.minimum((cover - SETTINGS.min_cover) * PAD_WIDTH, -UNMEASURED))
    words = sentences.comes_down_on(what), sentences.too_little(what), sentences.misses(what)
    whys = [words[0 if m else 1 if share else 2] for m, share in zip(meets, cover, strict=True)]
    bad = np.flatnonzero(meets | poor)
    for i in bad[known.too_wide(wanted[bad])].tolist():
        whys[i] = sentences.too_wide(what, WIDEST)
    return meets | poor, margins, whys


def _slips(known: LoneGrasps, wanted: FloatArray, what: str) -> Rejected:
    """Grasps that do not hold the body."""
    lost: Bools = known.holds(wanted) < 1
    return lost, np.full(len(lost), -UNMEASURED), [sentences.slips_out(what)] * len(lost)
