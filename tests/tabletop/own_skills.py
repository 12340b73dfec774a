"""Skills of a plugin: what the toolbox does, under other names and with other parameters."""

from proc3s_tabletop.skills import pick, place
from proc3s_tabletop.telemetry import Telemetry


def grab(world, x, y, z):
    """The toolbox's pick, called by a function of one's own."""
    return pick(world, x, y, z)


def put(world, x, y, z):
    """The toolbox's place, likewise."""
    return place(world, x, y, z)


def put_then_grab(world, x, y, z):
    """Two actions in one: what comes of the first is lost."""
    place(world, x, y, z)
    return pick(world, x, y, z)


def put_and_keep_quiet(world, x, y, z):
    """Returns measurements of nothing."""
    place(world, x, y, z)
    return Telemetry()


def grab_beside(world, o, gap):
    """Takes an object by name, so much off its middle along x."""
    x, y, z = dict(world.table.snapshot.frames)[o].position
    return world.table.pick(x + gap, y, z)
