import pytest

from proc3s import Trial, Violation
from proc3s.domain.room import Room
from proc3s.domain.values import Action
from proc3s.feedback.diagnosis import diagnose
from proc3s.sandbox import SketchContractError, SketchIssue, SketchRuntimeError, SketchTimeout

PLAN = (Action("slide", ("object_0", 1.0)),) * 5


def failed(step, text, skill="slide", more=()):
    return Trial(PLAN, (Violation("on_wire", step, skill, -1.0, text), *more), reached=step)


def broke(message, line=None):
    return Trial(error=SketchRuntimeError(message, line, "source" if line else None))


def table(diagnosis):
    return [(f.step, f.skill, f.text, f.share) for f in diagnosis.failures]


def test_failures_are_ranked_by_step_skill_and_sentence():
    trials = [failed(1, "a"), failed(0, "a"), failed(1, "a"), failed(1, "b"), failed(1, "c", "lift")]
    assert table(diagnose(trials)) == [
        (1, "slide", "a", 40),
        (0, "slide", "a", 20),
        (1, "slide", "b", 20),
        (1, "lift", "c", 20),
    ]


def test_one_sentence_of_two_skills_is_two_failures():
    found = diagnose([failed(1, "a"), failed(1, "a", "lift")]).failures
    assert {f.skill for f in found} == {"slide", "lift"}


def test_ties_keep_the_order_of_the_plan_whatever_came_first():
    one = [failed(2, "x"), failed(0, "z"), failed(0, "y"), failed(1, "w")]
    expected = [(0, "y"), (0, "z"), (1, "w"), (2, "x")]
    for trials in (one, one[::-1], one[2:] + one[:2]):
        assert [(f.step, f.text) for f in diagnose(trials).failures] == expected


def test_only_the_first_violation_of_a_sample_counts():
    second = Violation("other", 0, "slide", -1.0, "second")
    assert [f.text for f in diagnose([failed(0, "first", more=(second,))]).failures] == ["first"]


@pytest.mark.parametrize(
    ("part", "whole", "share"),
    [(731, 1000, 75), (732, 1000, 75), (1, 1000, 0), (1, 3, 35), (2, 3, 65), (999, 1000, 99), (7, 7, 100)],
)
def test_shares_are_rounded_to_five_percent(part, whole, share):
    trials = [failed(0, "often")] * part + [failed(1, f"rare {i}") for i in range(whole - part)]
    assert next(f.share for f in diagnose(trials).failures if f.text == "often") == share


def test_one_sample_more_rarely_changes_the_text():
    trials = [failed(0, "a")] * 700 + [failed(1, "b")] * 300
    assert diagnose(trials).failures == diagnose([*trials, failed(0, "a")]).failures


def test_errors_of_samples_are_failures_with_a_line():
    diagnosis = diagnose([broke("division by zero", 4), broke("division by zero", 4), failed(0, "a")])
    first = diagnosis.failures[0]
    assert (first.kind, first.text, first.line, first.source) == (
        "SketchRuntimeError",
        "division by zero",
        4,
        "source",
    )
    assert (first.step, first.share) == (None, 65)


def test_the_same_error_in_two_lines_is_two_failures():
    assert {f.line for f in diagnose([broke("oops", 4), broke("oops", 2)]).failures} == {2, 4}


def test_what_ended_the_program_stands_apart():
    diagnosis = diagnose([failed(0, "a")], SketchTimeout("took too long", 3, "while True:"))
    (error,) = diagnosis.program_errors
    assert (error.kind, error.line, error.source) == ("SketchTimeout", 3, "while True:")
    assert len(diagnosis.failures) == 1


def test_all_breaches_of_the_contract_are_told():
    issues = [SketchIssue("one", 1, "a"), SketchIssue("two", 9, "b"), SketchIssue("three")]
    diagnosis = diagnose((), SketchContractError.of(issues))
    assert [(f.text, f.line) for f in diagnosis.program_errors] == [("one", 1), ("two", 9), ("three", None)]
    assert diagnosis.samples == 0


def test_the_furthest_step_is_kept():
    assert diagnose([failed(0, "a"), failed(3, "b"), failed(1, "c")]).reached == 3


def test_a_diagnosis_survives_json():
    from proc3s.feedback.report import Diagnosis

    diagnosis = diagnose([failed(0, "a"), broke("oops", 2)], SketchTimeout("slow", 1, "x"))
    assert Diagnosis.model_validate_json(diagnosis.model_dump_json()) == diagnosis


def test_plans_that_only_a_rehearsal_refused_name_the_most_room_that_one_has():
    told = Violation("rehearsal", 2, "slide", -1.0, "rehearsed: fell")
    rooms = [Room(value, "on_wire", 1, value / 1000) for value in (0.2, 0.7, 0.4)]
    diagnosis = diagnose([Trial(PLAN, (told,), 2, room=room) for room in rooms] + [failed(0, "a")])
    rehearsal, on_wire = diagnosis.constraints
    assert (rehearsal.room, on_wire.room) == ("0.7, at step 1: on_wire by 0.0007", "")
