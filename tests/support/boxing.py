"""Programs of a domain in their box, the trials of their samples, and what comes of a plan."""

import numpy as np

from proc3s.domain.prelude import setup_code
from proc3s.domain.source_text import source_text
from proc3s.domain.world import make_world
from proc3s.sandbox import BoxedSketch, Program
from proc3s.search.evaluator import Evaluator
from proc3s.search.rollout import carry_out, judge


def box(domain, source, answer, state):
    """A program that starts in a state; `answer` is its kind."""
    return BoxedSketch(
        Program(
            source=source,
            answer=answer,
            prelude=setup_code(domain),
            initial=source_text(state),
            signatures=domain.signatures(state),
            samplers=domain.samplers,
        )
    )


def trials(sketch, problem, samples):
    """The trials of so many samples, always the same ones, up to the first that nobody takes."""
    from proc3s_executors.serial import Serial

    executor = Serial()
    u = np.random.default_rng(0).random((samples, sketch.space.dim))
    try:
        yield from Evaluator(problem, sketch, executor).stream(u)
    finally:
        executor.close()


def reaches_goal(problem, plan):
    """Whether the world accepts a plan of a problem and its judge what comes of it."""
    world = make_world(problem.domain)
    try:
        trial, final = carry_out(world, problem, plan, stop=False)
    finally:
        world.close()
    score, _ = judge(problem, final, plan)
    return not trial.violations and score.reached
