"""The built-in executors."""

from collections.abc import Callable

from proc3s import ExecutorSpec, hookimpl


@hookimpl
def register_executors(register: Callable[[ExecutorSpec], None]) -> None:
    """One process, one plan after the other."""
    register(
        ExecutorSpec(
            name="serial",
            summary="One plan after the other in this process.",
            target="proc3s_executors.serial:Serial",
        )
    )
