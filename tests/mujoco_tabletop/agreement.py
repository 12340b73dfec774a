"""Judges the same plans in the reference worlds of both engines, and prints how often they agree.

    python tests/mujoco_tabletop/agreement.py blocks/pyramid blocks/packing --plans 200

Plans come from the bundled program, from all of the benchmark and from the recorded answers, half of each
one's accepted and half refused by PyBullet as far as there are both. Each is judged three times by each
engine, every object moved by up to 0.5 mm; clear is a plan on which each engine gives one verdict.
"""

import argparse
import dataclasses
import itertools
import json
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from boxing import box
from proc3s.benchmark.cases import find_cases
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import open_registry
from proc3s.prompts.extract import extract_program
from proc3s.runs.recordings import read_recordings
from proc3s.search.rollout import carry_out
from proc3s_replay.recorded import FOLDER

ENGINES = ("pybullet", "mujoco")
TIMES, JITTER = 3, 0.0005
REGISTRY = open_registry()


def programs(domain, task):
    """The programs of a task that come with proc3s; each with the options of its scene."""
    answer = domain.spec.folder / "answers" / f"{task}.proc3s.md"
    yield {}, extract_program(answer.read_text(encoding="utf-8"))
    name = f"{domain.spec.name}/{task}"
    yield from ((case.scene, case.program) for case in find_cases(REGISTRY) if case.task == name)
    for recording in read_recordings(FOLDER):
        if recording.task == name:
            yield {}, extract_program(recording.completion.text)


def worlds(domain):
    """A reference world of each engine."""
    target = domain.spec.world
    return {name: target.load()(domain, **{**target.args, "engine": name}) for name in ENGINES}


def moved(state, rng):
    """The state with every object a little elsewhere."""
    objects = dict(state.objects)
    for name, thing in objects.items():
        x, y = rng.uniform(-JITTER, JITTER, 2)
        pose = dataclasses.replace(thing.pose, x=thing.pose.x + x, y=thing.pose.y + y)
        objects[name] = dataclasses.replace(thing, pose=pose)
    return dataclasses.replace(state, objects=objects)


def verdict(world, problem, plan):
    """What a world says of a plan: accepted, or the step and the constraint that refuse it."""
    trial, _ = carry_out(world, problem, plan)
    return next((f"{v.step} {v.constraint}: {v.text}" for v in trial.violations), "accepted")


def plans(problem, known, source, wanted) -> Iterator:
    """So many plans of a program, half accepted and half refused as far as its first draws have both."""
    kinds = {True: [], False: []}
    with box(problem.domain, source, "sketch", problem.initial) as sketch:
        batch = sketch.plans(np.random.default_rng(0).random((4 * wanted, sketch.space.dim)), first=0)
        for plan in (batch.plan(k) for k in range(len(batch)) if k not in batch.errors):
            kinds[verdict(known, problem, plan) == "accepted"].append(plan)
            if min(map(len, kinds.values())) >= wanted // 2 and sum(map(len, kinds.values())) >= wanted:
                break
    few, many = sorted(kinds.values(), key=len)
    few = few[: wanted // 2]
    yield from (*few, *many[: wanted - len(few)])


def judged(made, problem, plan, rng):
    """The verdicts of every engine on a plan, on the same jittered scenes."""
    dump = problem.domain.states.dump
    scenes = [json.dumps(dump(moved(problem.initial, rng))) for _ in range(TIMES)]
    jittered = [dataclasses.replace(problem, scene=scene) for scene in scenes]
    return {name: {verdict(world, each, plan) for each in jittered} for name, world in made.items()}


def compare(task, count, scenes):
    """Judge plans of a task; print what differs and a line of the table."""
    domain = REGISTRY.domain(task.partition("/")[0])
    sources = [*programs(domain, task.partition("/")[2])]
    made, found, rng = worlds(domain), Counter(), np.random.default_rng(0)
    share = -(-count // (len(sources) * scenes))
    for seed, (scene, source) in itertools.product(range(scenes), sources):
        options = RunOptions(task=task, method="proc3s", seed=seed, domain_options=scene)
        problem = make_problem(REGISTRY, options)
        for plan in plans(problem, made["pybullet"], source, share):
            said = judged(made, problem, plan, rng)
            passed = {name: {v == "accepted" for v in verdicts} for name, verdicts in said.items()}
            clear = all(len(v) == 1 for v in passed.values())
            agree = clear and len(set.union(*passed.values())) == 1
            found["clear" if clear else "unclear"] += 1
            found["agree"] += agree
            found["accepted"] += agree and True in passed["mujoco"]
            if clear and not agree:
                print("  differs, seed", seed, said, flush=True)
    clear, agree = found["clear"], found["agree"]
    share = 100 * agree / max(clear, 1)
    print(
        f"{task}: {clear + found['unclear']} plans, {found['unclear']} unclear, {clear} clear, "
        f"{agree} agree ({share:.1f} %), {found['accepted']} of them accepted",
        flush=True,
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("tasks", nargs="+")
    parser.add_argument("--plans", type=int, default=200)
    parser.add_argument("--scenes", type=int, default=5)
    asked = parser.parse_args()
    for name in asked.tasks:
        compare(name, asked.plans, asked.scenes)
