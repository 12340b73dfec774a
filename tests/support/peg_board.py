"""The world of the domain in `pegs`: a peg is put down on a line, and may come down off; in two engines."""

import dataclasses
import math
from typing import Literal

from proc3s import Margin, Score, World, WorldOptions


class BoardOptions(WorldOptions):
    """Which floor the pegs stand on; on ice errors are three times as large."""

    execution: Literal["felt", "ice"] = "felt"

    def execution_args(self):
        return {"floor": self.execution}

    @classmethod
    def used(cls, reference, execution):
        return {"execution": execution.get("floor", "felt")}


class Board(World):
    """Disturbed or misplaced, a peg comes down up to so far off."""

    options = BoardOptions

    def __init__(self, domain, floor="felt"):
        super().__init__(domain)
        self.slide = {"felt": 1.0, "ice": 3.0}[floor]
        self.rng, self.error = None, 0.0

    def disturb(self, rng, corner=None):
        self.rng, self.error = rng, 0.0005

    def misplace(self, rng, error=0.0):
        self.rng, self.error = rng, error

    def off(self):
        if self.rng is None:
            return 0.0
        area, angle = self.rng.random(2)
        return self.slide * self.error * math.sqrt(area) * math.cos(2 * math.pi * angle)


def scene(rng, first=0.0):
    return {"place": first + rng.uniform(-0.1, 0.1)}


def put(world, at):
    world.state = dataclasses.replace(world.state, place=at + world.off())


def on_board(transition):
    return Margin(0.5 - abs(transition.after.place))


def near(state, plan, reach):
    apart = abs(state.place)
    return Score(apart <= reach, f"the peg is {1e3 * apart:.2f} mm from the middle")
