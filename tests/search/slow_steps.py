"""A loose plugin file: a world whose skill, reset or judge never ends."""

import itertools
import time

from proc3s import DomainSpec, Score, World, hookimpl

YAML = {
    "spec_version": 1,
    "name": "tar",
    "summary": "Something gets stuck.",
    "world": {"target": "slow_steps:Tar"},
    "state": "Place",
    "types": {"Place": {"summary": "A place.", "fields": {"at": {"type": "float"}}}},
    "skills": {
        "wade": {
            "summary": "Wades.",
            "target": "slow_steps:wade",
            "params": {"how": {"type": "str", "choices": ["on", "asleep", "busy", "deaf", "in_c"]}},
        }
    },
    "constraints": {"free": {"says": "stuck", "target": "slow_steps:free"}},
    "samplers": ["ContinuousSampler"],
    "tasks": {
        "cross": {
            "instruction": "Cross it.",
            "initial": {"target": "slow_steps:scene"},
            "judge": [{"target": "slow_steps:judge"}],
        },
        "sink": {"instruction": "Sink.", "initial": {"target": "slow_steps:scene", "args": {"at": -1.0}}},
    },
    "budget": {"paper": 10, "release": 10},
}


@hookimpl
def register_domains(register):
    register(DomainSpec.model_validate(YAML))


def scene(rng, at=0.0):
    return {"at": at}


class Tar(World):
    def place(self, state):
        super().place(state)
        if state.at < 0:
            time.sleep(1000)


def wade(world, how):
    if how == "asleep":
        time.sleep(1000)
    while how == "busy":
        pass
    while how == "deaf":
        try:
            time.sleep(1000)
        except Exception:
            how = "awake"
    if how == "in_c":
        sum(itertools.repeat(0))  # comes never back to Python


def free(transition):
    return 1.0


def judge(state, plan):
    if len(plan) > 2:
        time.sleep(1000)
    return Score(True, "across")
