"""Letting the scene come to rest, and how far everything moved."""

from collections.abc import Iterable, Sequence

from proc3s_tabletop.engine.protocol import TableSimulation


def settle(scene: TableSimulation, names: Sequence[str]) -> bool:
    """Let time pass until these objects are still at two looks in a row; False if the time is up before."""
    settings = scene.settings
    scene.tick(settings.settle_first)
    ticks, looks = settings.settle_first, int(still(scene, names))
    while looks < 2 and ticks < settings.settle_most:
        scene.tick(settings.settle_look)
        ticks += settings.settle_look
        looks = looks + 1 if still(scene, names) else 0
    return looks == 2


def still(scene: TableSimulation, names: Iterable[str]) -> bool:
    """Whether none of these objects moves."""
    settings = scene.settings
    speeds = (scene.speeds(name) for name in names)
    return all(v <= settings.still_speed and w <= settings.still_turn for v, w in speeds)
