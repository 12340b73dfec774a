"""Screens reject and are counted, cannot harm when they are wrong in form, and are audited."""

import numpy as np
import pytest

from proc3s import SpecError, Trial
from proc3s.search.evaluator import Evaluator

from .conftest import Walks

ALL = {"budget": 150, "seed": 1, "exhaust": True}


def test_screens_count_what_they_reject(problem, search, serial):
    found = search(problem("listed", stateful=("Guard",)), serial, **ALL)
    assert set(found.rejected_by) == {"listed", "Guard"}
    assert all(found.rejected_by.values())
    by_trial = [trial.screen for trial in found.trials if trial.screen]
    assert {name: by_trial.count(name) for name in found.rejected_by} == found.rejected_by
    assert found.evaluations == found.samples - sum(found.rejected_by.values())


def test_the_first_screen_gives_the_reason(problem, search, serial):
    alone = search(problem("timid"), serial, **ALL)
    second = search(problem("everything", "timid"), serial, **ALL)
    assert alone.rejected_by["timid"] > 0
    assert second.rejected_by == {"everything": 150, "timid": 0}
    assert {trial.violations[0].text for trial in second.trials} == {"no"}


def test_what_a_screen_rejects_has_no_plan_and_its_step(problem, search, serial):
    found = search(problem("listed"), serial, **ALL)
    rejected = [trial for trial in found.trials if trial.screen]
    assert rejected
    for trial in rejected:
        assert (trial.accepted, trial.plan, trial.reached) == (False, None, trial.violations[0].step)


@pytest.mark.parametrize(
    ("screen", "message"),
    [("short", "target: gave 1 verdicts on 4 plans"), ("careless", "raised KeyError: 'no such pit'")],
)
def test_a_screen_that_does_not_work_is_named(problem, serial, screen, message):
    made = problem(screen)
    with pytest.raises(SpecError, match=f"screen {screen}: {message}"):
        list(Evaluator(made, Walks(made), serial).stream(np.zeros((8, 5))))


def test_no_screens_switches_them_off(problem, search, serial):
    made = problem("listed", "timid", stateful=("Guard",), screens="none")
    found = search(made, serial, **ALL)
    assert found.rejected_by == {"listed": 0, "timid": 0, "Guard": 0}
    assert found.evaluations == found.samples


def test_the_audit_finds_wrong_rejects(problem, search, serial):
    found = search(problem("timid"), serial, audit=30, **ALL)
    assert found.audit.checked == min(30, found.rejected_by["timid"])
    assert 0 < len(found.audit.wrong) < found.audit.checked
    for plan, violation in found.audit.wrong:
        assert plan[0].args[0] > 12
        assert violation.text == "too far"


def test_the_audit_finds_wrong_rejects_of_stateful_screens(problem, search, serial):
    import dataclasses

    made = problem(stateful=("Guard",))
    spec = made.domain.spec.screens[0].model_copy(update={"args": {"limit": 50.0}})
    domain = dataclasses.replace(made.domain, spec=made.domain.spec.model_copy(update={"screens": (spec,)}))
    found = search(dataclasses.replace(made, domain=domain), serial, audit=1000, **ALL)
    assert found.audit.checked == found.rejected_by["Guard"]
    assert found.audit.wrong


def test_the_audit_clears_exact_screens(problem, search, serial):
    found = search(problem("listed", stateful=("Guard",)), serial, audit=1000, **ALL)
    assert found.audit.checked == sum(found.rejected_by.values()) > 10
    assert found.audit.wrong == ()


def test_an_audit_counts_nothing_as_a_sample(problem, search, serial):
    plain = search(problem("timid"), serial, **ALL)
    audited = search(problem("timid"), serial, audit=10, **ALL)
    assert (plain.samples, plain.evaluations, plain.trials) == (
        audited.samples,
        audited.evaluations,
        audited.trials,
    )


def test_an_audit_is_a_uniform_choice():
    from proc3s.search.screen_audit import Audit

    chosen = np.zeros(20)
    for seed in range(400):
        audit = Audit(5, seed)
        for k in range(20):
            audit.offer(lambda k=k: k, Trial())
        for trial in audit._chosen:
            chosen[trial.plan] += 1
    assert np.abs(chosen / 400 - 5 / 20).max() < 0.1
