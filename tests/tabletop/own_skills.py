"""Skills of a plugin: what the toolbox does, under other names and with other parameters."""

from proc3s_tabletop.skills import pick, place


def grab(world, x, y, z):
    """The toolbox's pick, called by a function of one's own."""
    return pick(world, x, y, z)


def put(world, x, y, z):
    """The toolbox's place, likewise."""
    return place(world, x, y, z)


def grab_beside(world, o, gap):
    """Takes an object by name, so much off its middle along x."""
    x, y, z = dict(world.table.snapshot.frames)[o].position
    return world.table.pick(x + gap, y, z)
