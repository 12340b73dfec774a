"""Measures how far from the spot of the plan objects end that the driven hand has put down, in each engine.

    python tests/mujoco_tabletop/placing.py blocks ycb/stacking --seeds 5

Plans are those that a search finds for the programs of the benchmark. The spot is where the reference world
leaves the object after the same step.
"""

import argparse
from contextlib import closing

import numpy as np

from proc3s.benchmark.candidates import searched
from proc3s.benchmark.cases import find_cases
from proc3s.domain.world import make_world
from proc3s.plugins.registry import open_registry
from proc3s.search.rollout import carry_out

ENGINES = ("pybullet", "mujoco")
REGISTRY = open_registry()


def states(problem, plan, target):
    """The poses (steps + 1, objects, 3) of a plan that is carried out in a world, m."""
    visited = [problem.initial]
    with closing(make_world(problem.domain, target)) as world:
        carry_out(world, problem, plan, stop=False, visit=visited.append)
    return np.array([[(o.pose.x, o.pose.y, o.pose.z) for o in s.objects.values()] for s in visited])


def offs(known, engine):
    """How far beside its spot each object ends that a step of a plan puts down, m."""
    problem = known.problem(REGISTRY, {"execution": engine})
    spec = problem.domain.spec
    wanted = states(problem, known.plan, spec.world)
    ended = states(problem, known.plan, spec.execution or spec.world)
    for step, action in enumerate(known.plan):
        if action.skill == "place":
            moved = np.linalg.norm(wanted[step + 1] - wanted[step], axis=1).argmax()
            yield float(np.linalg.norm((ended - wanted)[step + 1, moved, :2]))


def measure(names, seeds):
    """Print a line of the table for each engine."""
    found = {engine: [] for engine in ENGINES}
    for case in find_cases(REGISTRY, names):
        for seed in range(seeds):
            known = searched(REGISTRY, case, seed, robust=0, samples=None).known
            for engine in ENGINES if known else ():
                found[engine] += offs(known, engine)
    for engine, off in found.items():
        median, most_of, most = 1000 * np.quantile(off, (0.5, 0.95, 1.0))
        print(f"{engine}: {len(off)} placed, median {median:.2f}, 95 % {most_of:.2f}, most {most:.2f} mm")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="+", help="domains, tasks or programs of the benchmark")
    parser.add_argument("--seeds", type=int, default=5)
    asked = parser.parse_args()
    measure(asked.names, asked.seeds)
