"""The solvers of the paper."""

from collections.abc import Callable

from proc3s import SolverSpec, hookimpl


@hookimpl
def register_solvers(register: Callable[[SolverSpec], None]) -> None:
    """Rejection sampling, and annealed Gaussian noise."""
    register(
        SolverSpec(
            name="rejection",
            summary="Draws every sample uniformly and independently (the paper's solver).",
            target="proc3s_solvers.sampling:Rejection",
            options="proc3s_solvers.sampling:BatchOptions",
        )
    )
    register(
        SolverSpec(
            name="gaussian",
            summary="Normal noise around the centre of the space, from none to full scale over the budget.",
            target="proc3s_solvers.sampling:Gaussian",
            options="proc3s_solvers.sampling:BatchOptions",
        )
    )
