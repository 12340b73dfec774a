"""Specs that a script gives as objects, as one more plugin."""

from collections.abc import Callable, Sequence

from proc3s.markers import hookimpl
from proc3s.specs.base import Spec
from proc3s.specs.domain import DomainSpec
from proc3s.specs.parts import LLMSpec, SolverSpec


class GivenParts:
    """A plugin that registers the given domains, solvers and language models."""

    def __init__(self, specs: Sequence[Spec]) -> None:
        self._specs = specs

    @hookimpl
    def register_domains(self, register: Callable[[Spec], None]) -> None:
        """The domains among them."""
        self._register(DomainSpec, register)

    @hookimpl
    def register_solvers(self, register: Callable[[Spec], None]) -> None:
        """The solvers among them."""
        self._register(SolverSpec, register)

    @hookimpl
    def register_llms(self, register: Callable[[Spec], None]) -> None:
        """The language models among them."""
        self._register(LLMSpec, register)

    def _register(self, kind: type[Spec], register: Callable[[Spec], None]) -> None:
        for spec in self._specs:
            if isinstance(spec, kind):
                register(spec)
