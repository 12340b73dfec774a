"""The constants of the reference world, with their units and where they come from."""

import math
from dataclasses import dataclass

TABLE_BOUNDS = ((-0.3, 0.3), (-0.8, -0.2))
"""x and y of the table in metres, robot base at the origin, table top at z = 0 (the paper)."""


HOME = (-math.pi / 2, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0)
"""Joint angles, rad: the tool over the middle of the table, pointing down."""


TCP = 0.1455
"""From tool0 to the grasp point, m: 10 mm short of the closed fingertips, which sink 12 to 14 mm while they
close, so that flat objects can be grasped (measured)."""


TOP_DOWN_YAW = math.pi / 2
"""Turn of a top-down grasp about z, rad: the fingers open along y."""


LEVER = 0.04
"""A turn in rad times this is the way of a point at the far side of an object, m."""


SAME_GRASP = 1e-3
"""A place whose grasp is further from that of its pick names another one, m; a rad counts 40 mm."""

INSIDE = 0.85
"""Rays run between the pads from this share of their distance, so that they start off the pads."""


@dataclass(frozen=True)
class ReferenceSettings:
    """How actions are carried out. Measured: with these values the world agrees with itself best.

    Lengths in m, angles in rad, forces in N, torques in Nm, times in ticks.
    """

    speed: float = 1.0
    """Scales the distance of way-points and the speed of the fingers."""
    tick: float = 1 / 240
    """Seconds; another time step changes what the finger linkage does."""

    hover: float = 0.10
    """Above a grasp or a set-down (the paper)."""
    move_spacing: float = 0.02
    """Of way-points in free moves; half a block, so that nothing is passed through."""
    line_spacing: float = 0.0075
    """Of way-points on the straight line down and up."""
    reach: float = 0.7
    """From the base to the hand: turns joint angles into distances."""
    branch_jump: float = 0.3
    """A joint that turns more between way-points of a line has changed its branch."""
    ik_tolerance: float = 1e-3

    penetration: float = 5e-4
    """Depth at which the robot touches something; shallower is within the shapes' margins."""
    touch: float = 2e-4
    """Depth at which the held object touches something."""
    near: float = 0.05
    """Clearances are measured up to here."""

    stir: float = 0.02
    """Closing fingers reach what is this close to the open hand: they sink 14 mm, and their backs come in."""
    min_cover: float = 0.62
    """Share of rays between the pads that must meet the object: accepts 15 mm off centre, rejects 18."""
    cover_across: tuple[float, ...] = (-0.009, -0.0045, 0.0, 0.0045, 0.009)
    """Where the rays run along the width of the pads (22 mm)."""
    cover_along: tuple[float, ...] = (-0.008, -0.004, 0.0, 0.004, 0.008)
    """And along the fingers, from the grasp point."""

    finger_torque: float = 2.5
    """1.5 drops blocks, 6 tilts them."""
    finger_speed: float = 2.5
    """rad/s"""
    finger_closed: float = 0.8
    """Angle of the finger joint when the empty hand is closed."""
    pad_friction: float = 1.5
    table_friction: float = 0.8
    grip_iterations: int = 150
    """Of the solver while the fingers hold something; at the default of 50 objects creep 2 mm in 0.5 s."""
    iterations: int = 50
    """Of the solver otherwise (PyBullet's default)."""
    check_every: int = 4
    """Ticks between looks at what the closing fingers touch."""
    close_most: int = 96
    stall: int = 12
    """The fingers have closed when they stand still for this long..."""
    stall_speed: float = 0.03
    """...slower than this, rad/s..."""
    close_least: int = 12
    """...having had time to start."""

    arm_speed: float = 2.0
    """Of the fastest joint half-way through a free move of a driven arm, rad/s; the UR5e allows 3.1."""
    arm_still: float = 0.002
    """rad/s; a driven arm stands when all its joints are slower..."""
    arm_still_most: int = 60
    """...or after so many ticks."""

    shake: tuple[tuple[tuple[float, float, float], int], ...] = (
        ((0.0, 0.0, -4.9), 24),
        ((4.9, 0.0, 0.0), 8),
        ((-4.9, 0.0, 0.0), 8),
        ((0.0, 4.9, 0.0), 8),
        ((0.0, -4.9, 0.0), 8),
    )
    """Pull on the object beside gravity (m/s2) and ticks of the lift test: half a g down, then sideways."""
    max_slip: float = 0.010
    max_slip_angle: float = 0.30
    """More is an object that falls out of the hand."""
    lift_off: float = 0.010
    """An object lifted less may still touch what it stood on or beside."""

    press: float = 0.004
    """The descent goes this far below the commanded z to find a support."""
    bisections: int = 5
    """Of a way-point interval to find the contact: to 0.23 mm."""
    supporting: float = 0.5
    """Least upward part of a contact normal for a support; less is a side that was run into."""
    drop_step: float = 0.005
    drop_most: float = 0.060
    """How far below the release a support is looked for."""
    open_margin: float = 0.006
    """A finger opens this much further than the object is wide; wide open it pushes neighbours."""

    fall: float = 0.02
    """What is this close to an object that is let go may be hit when it falls over."""
    settle_first: int = 18
    settle_look: int = 6
    settle_most: int = 360
    still_speed: float = 0.01
    """m/s"""
    still_turn: float = 0.10
    """rad/s; all must be slower at two looks in a row."""
    knocked_over: float = 0.25
    """Lean of an object that was knocked over."""


def inside_table(x: float, y: float) -> float:
    """Signed distance of a point to the nearest edge of the table."""
    (x0, x1), (y0, y1) = TABLE_BOUNDS
    return min(x - x0, x1 - x, y - y0, y1 - y)
