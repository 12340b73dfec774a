"""A loose plugin file: a walker on a line with pits, whose steps may take as long as a simulator's."""

import dataclasses
import os
import signal
import time
from pathlib import Path

import numpy as np

from proc3s import Margin, Score, Violation, World, hookimpl, load_domain

PITS = ((6.0, 12.0), (20.0, 27.0), (36.0, 46.0), (54.0, 66.0), (74.0, 84.0))


@hookimpl
def register_domains(register):
    register(load_domain(Path(__file__).with_name("walk.yaml")))


class Walk(World):
    """`seconds` of work and `asleep` of waiting a step; the file `count` notes every step in any process."""

    def __init__(self, domain, seconds=0.0, asleep=0.0, count=None, broken_at=None, deadly=None):
        super().__init__(domain)
        self._deadly = deadly
        self._seconds, self._count, self._broken_at = seconds, count, broken_at
        self._asleep = asleep

    def work(self, place):
        if self._broken_at is not None and place > self._broken_at:
            raise RuntimeError("the simulator gave up")
        if self._deadly is not None and self._deadly[0] < place < self._deadly[1]:
            os.kill(os.getpid(), signal.SIGSEGV)
        if self._count:
            with Path(self._count).open("a") as file:
                file.write("x")
        time.sleep(self._asleep)
        end = time.process_time() + self._seconds
        while time.process_time() < end:
            pass


def scene(rng):
    return {"place": 0.0}


def hop(world, by):
    place = world.state.place + by
    world.work(place)
    world.state = dataclasses.replace(world.state, place=place, hops=world.state.hops + 1)
    return place


def on_line(transition):
    return 100.0 - transition.telemetry


def on_line_at_all(transition):
    return bool(transition.telemetry <= 100.0)


def near(state, plan, place, reach):
    off = abs(state.place - place)
    return Score(off <= reach, f"{off:g} m off", reach - off)


def no_pit(transition):
    place = transition.telemetry
    outside = [max(low - place, place - high) for low, high in PITS]
    nearest = int(np.argmin(outside))
    return Margin(outside[nearest], {"pit": f"pit {nearest}"})


def places(batch):
    """Where each hop of each plan leads, plan by plan."""
    for first, last in zip(batch.start[:-1], batch.start[1:], strict=True):
        yield np.cumsum(batch.values[batch.offset[first] : batch.offset[last]])


def in_first_pit(state, batch):
    """Exact as far as it goes: the first hop into the first pit."""
    low, high = PITS[0]
    for path in places(batch):
        if low < path[0] < high:
            margin = float(max(low - path[0], path[0] - high))
            yield Violation("no_pit", 0, "hop", margin, "fell into pit 0")
        else:
            yield None


def listed(state, batch, domain):
    assert domain.spec.name == "walk"
    return list(in_first_pit(state, batch))


def timid(state, batch):
    """Wrong: rejects every plan that begins with a hop beyond the first pit."""
    return [Violation("no_pit", 0, "hop", -1.0, "too far") if p[0] > 12 else None for p in places(batch)]


def everything(state, batch):
    return [Violation("no_pit", 0, "hop", -1.0, "no")] * len(batch)


def short(state, batch):
    return [None]


def careless(state, batch):
    raise KeyError("no such pit")


class Guard:
    """A stateful screen: rejects plans that end beyond `limit`; it counts what it has seen."""

    def __init__(self, domain, limit=100.0):
        self._limit, self.seen = limit, 0
        assert domain.spec.name == "walk"

    def check(self, state, plan):
        self.seen += 1
        place = state.place
        for step, action in enumerate(plan):
            place += action.args[0]
            if place > self._limit:
                return Violation("on_line", step, "hop", self._limit - place, "leaves the line")
        return None
