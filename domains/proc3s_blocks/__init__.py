"""The Arrange-Blocks domain: a robot arm moves blocks and bowls on a table."""

from collections.abc import Callable
from pathlib import Path

from proc3s import DomainSpec, hookimpl, load_domain


@hookimpl
def register_domains(register: Callable[[DomainSpec], None]) -> None:
    """The domain that `domain.yaml` describes."""
    register(load_domain(Path(__file__).parent / "domain.yaml"))
