"""Programs of a domain in their box, the trials of their samples, and what comes of a plan."""

import numpy as np

from proc3s.evaluation import Evaluator
from proc3s.problem import carry_out, judge
from proc3s.setup_code import setup_code
from proc3s.sketch import BoxedSketch, Program
from proc3s.state import source_text


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
    world = problem.domain.make_world()
    try:
        trial, final = carry_out(world, problem, plan, stop=False)
    finally:
        world.close()
    score, _ = judge(problem, final, plan)
    return not trial.violations and score.reached
