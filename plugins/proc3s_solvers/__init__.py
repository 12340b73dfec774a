"""The solvers of the paper, and solvers that learn from trials."""

from collections.abc import Callable

from proc3s import SolverSpec, hookimpl


@hookimpl
def register_solvers(register: Callable[[SolverSpec], None]) -> None:
    """Uniform draws, annealed noise, backtracking, evolution, a portfolio of them, and one for room."""
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
    register(
        SolverSpec(
            name="backtracking",
            summary="Keeps the accepted steps and draws again what matters from the failing step on.",
            target="proc3s_solvers.backtracking:Backtracking",
            options="proc3s_solvers.backtracking:BacktrackingOptions",
        )
    )
    register(
        SolverSpec(
            name="cma",
            summary="Evolves samples towards further steps and smaller violations (CMA-ES).",
            target="proc3s_solvers.evolution:Cma",
            options="proc3s_solvers.evolution:CmaOptions",
        )
    )
    register(
        SolverSpec(
            name="portfolio",
            summary="Rejection, then backtracking and cma in turns that double.",
            target="proc3s_solvers.portfolio:Portfolio",
            options="proc3s_solvers.portfolio:PortfolioOptions",
        )
    )
    register(
        SolverSpec(
            name="roomier",
            summary="Moves an accepted sample to where its plan stands larger errors (linear programs).",
            target="proc3s_solvers.roomier:Roomier",
            options="proc3s_solvers.roomier:RoomierOptions",
            objective="room",
        )
    )
