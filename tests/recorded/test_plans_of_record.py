"""Today's code finds the plans that it found when they were put on record, with as many samples."""

import json

import plans_of_record
import pytest

RECORD = json.loads(plans_of_record.FILE.read_text(encoding="utf-8"))


def _name(problem):
    return "-".join(str(problem[name]) for name in plans_of_record.QUESTION)


def _numbers(value):
    """Approximately equal numbers are equal: another processor rounds otherwise."""
    return pytest.approx(value, abs=1e-6) if isinstance(value, float) else value


def _steps(plan):
    flat = ([a] if not isinstance(a, list) else a for action in plan for a in action["args"])
    return [action["skill"] for action in plan], [value for part in flat for value in part]


def test_the_record_has_twenty_problems_of_all_domains():
    assert len({_name(problem) for problem in RECORD}) == 20
    assert {problem["task"].partition("/")[0] for problem in RECORD} == {"drawing", "blocks", "ycb"}


@pytest.mark.slow
@pytest.mark.parametrize("problem", RECORD, ids=_name)
def test_the_plan_is_that_of_the_record(problem, tmp_path):
    found = plans_of_record.solved(problem, tmp_path)
    skills, values = _steps(problem["plan"])
    assert _steps(found["plan"]) == (skills, [_numbers(value) for value in values])
    assert (found["samples"], found["evaluations"]) == (problem["samples"], problem["evaluations"])
