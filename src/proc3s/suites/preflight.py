"""What is certain before the first episode: that its parts are there, and that the model can be asked."""

import itertools
from collections.abc import Sequence

from proc3s.backends import find_llm, patient
from proc3s.budget import Budget, Ledger
from proc3s.errors import Proc3sError, SpecError, UsageError
from proc3s.options import RunOptions, key_values, make_problem, make_prompter, make_setup
from proc3s.readiness import check_parts
from proc3s.registry import Registry
from proc3s.suites.runner import Order
from proc3s.suites.spec import Cell


def check_order(registry: Registry, order: Order, cells: Sequence[Cell]) -> None:
    """Make once what all the episodes need: backend, scenes, worlds, prompts.

    Raises what the first of them would end with, before any is begun: LLMError for a key or a file that is
    missing, UsageError or SpecError for all else.
    """
    if not cells:
        return
    budget = Budget(max_cost=order.max_cost) if order.max_cost else Budget()
    chosen = find_llm(registry, order.llm, key_values(list(order.llm_options)))
    patient(chosen, budget, Ledger(), lambda ledger: None, lambda request, error, wait: None)
    for task, of_task in itertools.groupby(sorted(cells), key=lambda cell: cell.task):
        try:
            _check_task(registry, list(of_task), order.spec.samples)
        except SpecError:
            raise
        except Proc3sError as error:
            raise UsageError(f"{task}: {error}") from error


def _check_task(registry: Registry, cells: Sequence[Cell], samples: int | None) -> None:
    """The first scene of a task in its worlds, and every method's prompt."""
    checked, seed = False, min(cell.seed for cell in cells)
    for method, preset in sorted({(cell.method, cell.preset) for cell in cells}):
        given = {"task": cells[0].task, "method": method, "preset": preset, "seed": seed}
        options = RunOptions.model_validate({**given, "samples": samples})
        problem = make_problem(registry, options)
        make_setup(registry, options, problem).executor.close()
        make_prompter(registry, options, problem).rehearse(problem)
        if not checked:
            check_parts(problem)
            checked = True
