"""Conformance kits of constraints and screens that are brought to domains which exist already."""

import numpy as np
import pytest

from proc3s.checks.stepping import margins, screens
from proc3s.checks.subject import Subject
from proc3s.domain.margins import check as check_step
from proc3s.domain.world import make_world
from proc3s.plugins.registry import Registry, open_registry
from proc3s.testing.domains import once


class ConstraintTests:
    """A constraint on the bundled plans of a domain. Override `domain_name` and `constraint_name`; and
    `registry`, where the constraint is in a loose file: `open_registry([path])`."""

    @pytest.fixture
    def registry(self) -> Registry:
        """The plugins that are installed."""
        return open_registry()

    @pytest.fixture
    def subject(self, registry: Registry, domain_name: str) -> Subject:
        """The domain that the constraint is brought to."""
        return once(self, registry, domain_name)

    def test_the_domain_has_it(self, subject: Subject, constraint_name: str) -> None:
        """By its `domains`, or by the domain's `use`."""
        assert constraint_name in subject.spec.constraints

    def test_it_applies_and_its_margins_are_finite(self, subject: Subject, constraint_name: str) -> None:
        """To some step of a bundled plan."""
        target = subject.spec.constraints[constraint_name].target
        assert [fault.text for fault in margins(subject) if fault.where == target] == []

    def test_its_sign_is_its_verdict_and_its_sentence_is_whole(
        self, subject: Subject, constraint_name: str
    ) -> None:
        """A negative margin beyond the tolerance is a violation with a text, and nothing else is."""
        spec = subject.spec.constraints[constraint_name]
        world = make_world(subject.domain)
        for answer, plan in subject.plans(4):
            world.reset(answer.problem.initial)
            for step, action in enumerate(plan):
                found, violations, _ = check_step(subject.domain, world.step(action), step)
                mine = [v for v in violations if v.constraint == constraint_name]
                assert bool(mine) == (found.get(constraint_name, 0.0) < -spec.tolerance)
                assert all(np.isfinite(v.margin) and v.text.strip() for v in mine)
        world.close()


class ScreenTests:
    """The screens of a domain, during `seconds`. Override `domain_name`."""

    seconds = 10.0

    @pytest.fixture
    def registry(self) -> Registry:
        """The plugins that are installed."""
        return open_registry()

    def test_they_reject_what_the_world_rejects(self, registry: Registry, domain_name: str) -> None:
        """And say the same of a plan by itself; exact ones say just what the world says."""
        faults = [fault.text for fault in screens(Subject(registry, domain_name, self.seconds))]
        assert faults == []
