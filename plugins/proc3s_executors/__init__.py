"""The built-in executors."""

from collections.abc import Callable

from proc3s import ExecutorSpec, hookimpl


@hookimpl
def register_executors(register: Callable[[ExecutorSpec], None]) -> None:
    """In this process, or in several."""
    register(
        ExecutorSpec(
            name="serial",
            summary="One plan after the other in this process.",
            target="proc3s_executors.serial:Serial",
            most_jobs=1,
        )
    )
    register(
        ExecutorSpec(
            name="processes",
            summary="Several worker processes on this machine (--jobs N), one world each.",
            target="proc3s_executors.processes:Processes",
        )
    )
