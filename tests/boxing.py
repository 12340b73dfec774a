"""Programs of a domain in their box, and the trials of their samples."""

import numpy as np

from proc3s.evaluation import Evaluator
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
