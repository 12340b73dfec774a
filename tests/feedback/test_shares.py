import numpy as np
import pytest

from proc3s import Trial, Violation
from proc3s.domain.samplers import ContinuousSampler, DiscreteSampler, Space
from proc3s.domain.values import Action
from proc3s.feedback.diagnosis import diagnose
from proc3s.feedback.report import Failure
from proc3s.feedback.shares import portion, shares
from proc3s.sandbox import SketchContractError, SketchRuntimeError, SketchTimeout

PLAN = (Action("slide", ("object_0", 1.0)),) * 5
SPACE = Space({"x": ContinuousSampler(0, 100), "side": DiscreteSampler(["left", "right"])})


def trial(index, u, error=None, constraint="on_wire"):
    if error:
        return Trial(error=error, index=index, u=u)
    return Trial(PLAN, (Violation(constraint, 0, "slide", -1.0, "off"),), index=index, u=u)


def trials(errors):
    """Trials of 200 samples; `errors` gives the error of a sample by its u."""
    u = np.random.default_rng(0).random((200, 2)).tolist()
    return [trial(i, tuple(row), errors(*row)) for i, row in enumerate(u)]


def of_errors(trials_):
    return [f for f in diagnose(trials_, space=SPACE).failures if f.step is None]


@pytest.mark.parametrize(
    ("counts", "whole", "expected"),
    [
        ([1, 1999], 2000, [0, 99]),
        ([1] * 2000, 2000, [0] * 2000),
        ([1, 1, 1], 3, [35, 35, 30]),
        ([1] * 6, 6, [15, 15, 15, 15, 15, 15]),
        ([1] * 7, 7, [15, 15, 15, 15, 15, 15, 10]),
        ([44, 43, 13], 100, [45, 45, 10]),
        ([5], 5, [100]),
        ([3], 10, [30]),
    ],
)
def test_shares_are_honest_and_never_more_than_all(counts, whole, expected):
    found = shares(counts, whole)
    assert found == expected
    assert sum(found) <= 100


@pytest.mark.parametrize("seed", range(20))
def test_any_shares_are_within_rounding(seed):
    rng = np.random.default_rng(seed)
    counts = np.sort(rng.integers(1, 10 ** rng.integers(1, 5), rng.integers(1, 30)))[::-1].tolist()
    found = shares(counts, sum(counts))
    assert sum(found) <= 100
    for count, share in zip(counts, found, strict=True):
        assert abs(share - 100 * count / sum(counts)) < 5
        assert (share == 100) is (count == sum(counts))


def test_a_small_share_is_said_to_be_small():
    assert [portion(share) for share in (0, 5, 95, 99, 100)] == [
        "under 5 %",
        "5 %",
        "95 %",
        "over 95 %",
        "100 %",
    ]


def test_constraints_and_errors_are_shares_of_one_whole():
    broke = [SketchRuntimeError("oops", 3)] * 17
    mixed = [trial(i, (0.5, 0.5), error) for i, error in enumerate(broke)]
    mixed += [trial(100 + i, (0.5, 0.5), constraint="one") for i in range(17)]
    mixed += [trial(200 + i, (0.5, 0.5), constraint="other") for i in range(17)]
    diagnosis = diagnose(mixed)
    told = [r.share for r in diagnosis.constraints] + [f.share for f in diagnosis.failures if f.step is None]
    assert sum(told) <= 100
    assert min(told) >= 30


def test_an_error_is_told_with_the_parameters_that_tell_its_samples():
    (found,) = of_errors(
        trials(lambda x, side: SketchContractError("the plan is empty") if x < 0.6 else None)
    )
    low, high = found.parameters.removeprefix("with `x` between ").split(" and ")
    assert (float(low) < 2, 58 < float(high) < 60) == (True, True)
    assert found.share == 55


def test_a_choice_that_fails_is_named():
    (found,) = of_errors(trials(lambda x, side: SketchRuntimeError("oops", 3) if side < 0.5 else None))
    assert found.parameters == "with `side` 'left'"


def test_of_a_rare_error_one_sample_is_given():
    (found,) = of_errors(trials(lambda x, side: SketchTimeout("slow", 3) if x < 0.01 else None))
    assert found.parameters.startswith("for example with `x` = 0.")
    assert "`side` = '" in found.parameters
    assert found.share == 0


def test_an_error_of_all_samples_has_no_parameters():
    (found,) = of_errors(trials(lambda x, side: SketchRuntimeError("oops", 3)))
    assert (found.parameters, found.share) == ("", 100)


def test_a_loop_without_end_is_one_failure_at_whichever_line_it_is_met():
    met = [trial(i, (0.5, 0.5), SketchTimeout("slow", 3 + i % 2)) for i in range(4)]
    (found,) = diagnose(met).failures
    assert isinstance(found, Failure)
    assert found.share == 100
