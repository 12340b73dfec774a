"""Letting the scene come to rest, and how far everything moved."""

from collections.abc import Iterable, Sequence

from proc3s_tabletop.bullet.simulation import Things


def settle(things: Things, names: Sequence[str]) -> bool:
    """Let time pass until these objects are still at two looks in a row; False if the time is up before."""
    recipe = things.recipe
    things.tick(recipe.settle_first)
    ticks, looks = recipe.settle_first, int(still(things, names))
    while looks < 2 and ticks < recipe.settle_most:
        things.tick(recipe.settle_look)
        ticks += recipe.settle_look
        looks = looks + 1 if still(things, names) else 0
    return looks == 2


def still(things: Things, names: Iterable[str]) -> bool:
    """Whether none of these objects moves."""
    recipe = things.recipe
    speeds = (things.speeds(name) for name in names)
    return all(v <= recipe.still_speed and w <= recipe.still_turn for v, w in speeds)
