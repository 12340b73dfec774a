"""Checks before the first episode: all parts exist, and the model can be asked."""

import itertools
from collections import Counter
from collections.abc import Iterator, Sequence

from proc3s.errors import Proc3sError, SpecError, UsageError
from proc3s.llm.budget import Budget
from proc3s.planning.expense import Bound, bound_of
from proc3s.planning.llm_backend import Chosen, find_llm, open_llm, price_of
from proc3s.planning.options import RunOptions, key_values
from proc3s.planning.proposals import Question
from proc3s.planning.readiness import check_parts
from proc3s.planning.setup import make_prompter, make_setup
from proc3s.plugins.registry import Registry
from proc3s.specs.suite import Cell
from proc3s.suites.runner import Order


def check_order(registry: Registry, order: Order, cells: Sequence[Cell]) -> Bound | None:
    """Make once what all the episodes need: backend, scenes, worlds, prompts; the most that they may ask.

    That is None where asking costs nothing.

    Raises what the first of them would end with, before any is begun: LLMError for a key or a file that is
    missing, UsageError or SpecError for all else.
    """
    if not cells:
        return None
    budget = Budget(max_cost=order.max_cost) if order.max_cost else Budget()
    chosen = find_llm(registry, order.llm, key_values(list(order.llm_options)))
    llm = open_llm(chosen, budget)
    price, bound = price_of(chosen) if llm.live else None, Bound()
    for task, of_task in itertools.groupby(sorted(cells), key=lambda cell: cell.task):
        try:
            for question, times in _check_task(registry, chosen, list(of_task), order):
                bound = bound.plus(bound_of(question, price), times)
        except SpecError:
            raise
        except Proc3sError as error:
            raise UsageError(f"{task}: {error}") from error
    return bound if llm.live else None


def _check_task(
    registry: Registry, chosen: Chosen, cells: Sequence[Cell], order: Order
) -> Iterator[tuple[Question, int]]:
    """The first scene of a task in its worlds, and every method's question with how many episodes ask it."""
    checked, seed = False, min(cell.seed for cell in cells)
    for (method, preset), times in Counter((cell.method, cell.preset) for cell in cells).items():
        given = {"task": cells[0].task, "method": method, "preset": preset, "seed": seed}
        given |= {"samples": order.spec.samples, "feedback": order.spec.feedback}
        given |= {"world_options": order.world_options}
        options = RunOptions.model_validate({**given, "template_dir": order.template_dir})
        setup = make_setup(registry, options)
        setup.executor.close()
        prompter = make_prompter(registry, options, setup.problem)
        prompter.rehearse(setup.problem)
        if not checked:
            check_parts(setup.problem)
            checked = True
        yield Question(setup.problem, prompter, chosen.call.sampling(seed, 1)), times
