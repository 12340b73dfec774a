"""Scenes from which no plan can begin: what is wrong with them is known before anything moves."""

import math

import pytest
from blocks_domain import belief, blocks_domain

from proc3s.domain.world import flaws_of

DOMAIN = blocks_domain()
RED, BLUE, BOWL = "object_0 (the red block)", "object_1 (the blue block)", "object_1 (the yellow bowl)"


def flaws(*things):
    return flaws_of(DOMAIN, belief(DOMAIN, *things))


@pytest.mark.parametrize(
    ("things", "words"),
    [
        ([("block", "red", 0.31, -0.5, 0.02)], [f"{RED} lies outside the bounds of the table, by 10 mm"]),
        ([("block", "red", 0.0, -0.15, 0.02)], [f"{RED} lies outside the bounds of the table, by 50 mm"]),
        ([("block", "red", 0.0, -0.5, 0.015)], [f"{RED} is 5 mm deep in the table"]),
        (
            [("block", "red", 0.0, -0.5, 0.02), ("block", "blue", 0.03, -0.5, 0.02)],
            [f"{RED} is 10 mm deep in {BLUE}"],
        ),
        (
            [("block", "red", 0.0, -0.5, 0.02), ("block", "blue", 0.0, -0.5, 0.054)],
            [f"{RED} is 6 mm deep in {BLUE}"],
        ),
        (
            [("block", "red", 0.07, -0.5, 0.02), ("bowl", "yellow", 0.0, -0.5, 0.025)],
            [f"{RED} is 10 mm deep in {BOWL}"],
        ),
    ],
)
def test_what_cannot_be_there_is_said_with_the_pair_and_the_depth(things, words):
    found = flaws(*things)
    if "bowl" in str(things):  # how deep, depends on the slope of its wall
        assert [text.split(" is ")[0] + text.split(" in ")[1] for text in found] == [RED + BOWL]
    else:
        assert found == words


@pytest.mark.parametrize(
    "things",
    [
        [],
        [("block", "red", 0.0, -0.5, 0.02), ("block", "blue", 0.04, -0.5, 0.02)],
        [("block", "red", 0.0, -0.5, 0.02), ("block", "blue", 0.0, -0.5, 0.06)],
        [("block", "red", 0.0, -0.5, 0.025), ("bowl", "yellow", 0.0, -0.5, 0.025)],
        [("block", "red", 0.0, -0.5, 0.02, 0.0, 0.0, math.pi / 4), ("block", "blue", 0.05, -0.5, 0.02)],
        [("block", "red", 0.3, -0.5, 0.02)],
    ],
)
def test_what_may_be_there_is_no_flaw(things):
    assert flaws(*things) == []
