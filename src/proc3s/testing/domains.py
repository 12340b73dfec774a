"""Conformance kit of domains: inherit `DomainTests`, give it a `domain_name`, and run pytest.

The checks are those of `proc3s check`.
"""

import pytest

from proc3s.conformance.checks import CHECKS, Check, findings
from proc3s.conformance.subject import Subject
from proc3s.registry import Registry, open_registry


class DomainTests:
    """What solvers, workers, models and judges rely on. Override `domain_name`, and `registry` for a domain
    that is not installed: `open_registry([path])`."""

    @pytest.fixture(scope="class")
    def registry(self) -> Registry:
        """The plugins that are installed."""
        return open_registry()

    @pytest.fixture(scope="class")
    def subject(self, registry: Registry, domain_name: str) -> Subject:
        """The domain under examination; a screen's mistakes are looked for during ten seconds."""
        return Subject(registry, domain_name, seconds=10.0)

    @pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.name)
    def test_conformance(self, subject: Subject, check: Check) -> None:
        """No check finds an error."""
        errors = [f for f in findings(check, subject) if f.level == "error"]
        told = [f"{f.where}: {f.text}\n  why: {f.why}\n  mend: {f.mend}" for f in errors]
        assert not errors, "\n".join(told)
