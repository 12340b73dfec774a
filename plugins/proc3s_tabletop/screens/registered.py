"""The screens that come with the table-top's reference world, the cheapest first."""

from proc3s import ScreenSpec

SCREENS = (
    ScreenSpec(name="geometry", target="proc3s_tabletop.screens.geometry:geometry"),
    ScreenSpec(name="grasps", target="proc3s_tabletop.screens.grasps:grasps"),
    ScreenSpec(name="reach", target="proc3s_tabletop.screens.geometry:reach"),
)
