"""Conformance kit of domains: inherit `DomainTests`, give it a `domain_name`, and run pytest.

The checks are those of `proc3s check`.
"""

import pytest

from proc3s.checks.domain import CHECKS, Check, examine_one
from proc3s.checks.subject import Subject
from proc3s.plugins.registry import Registry, open_registry


def once(tests: object, registry: Registry, name: str, seconds: float = 20.0) -> Subject:
    """The subject of a class of tests: its plans are made for the first of them."""
    made: dict[str, Subject] = vars(type(tests)).get("_made") or {}
    if name not in made:
        made[name] = Subject(registry, name, seconds)
        type(tests)._made = made  # type: ignore[attr-defined]
    return made[name]


class DomainTests:
    """What solvers, workers, models and judges rely on. Override `domain_name`, and `registry` for a domain
    that is not installed: `open_registry([path])`."""

    @pytest.fixture
    def registry(self) -> Registry:
        """The plugins that are installed."""
        return open_registry()

    @pytest.fixture
    def subject(self, registry: Registry, domain_name: str) -> Subject:
        """The domain under examination; a screen's mistakes are looked for during ten seconds."""
        return once(self, registry, domain_name, 10.0)

    @pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.name)
    def test_conformance(self, subject: Subject, check: Check) -> None:
        """No check finds an error."""
        checked = examine_one(check, subject)
        errors = [f for f in checked.findings if f.level == "error"]
        told = [f"{f.where}: {f.text}\n  why: {f.why}\n  fix: {f.mend}" for f in errors]
        assert not errors, "\n".join(told)
        if checked.unchecked:
            pytest.skip(checked.unchecked)
