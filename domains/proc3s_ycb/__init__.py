"""The Arrange-YCB domain: a robot arm grasps scanned objects of the YCB set and moves them."""

from collections.abc import Callable
from pathlib import Path

from proc3s import DomainSpec, hookimpl, load_domain


@hookimpl
def register_domains(register: Callable[[DomainSpec], None]) -> None:
    """The domain that `domain.yaml` describes."""
    register(load_domain(Path(__file__).parent / "domain.yaml"))
