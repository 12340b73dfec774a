"""The columns that screens take for the hand lie inside the simulated one."""

import numpy as np
import pytest

from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.bullet.hand import FloatingHand
from proc3s_tabletop.robot.hand_profile import AIRO
from proc3s_tabletop.robot.settings import TCP, ReferenceSettings

NEXT_TO_THE_EDGE = 5e-4


@pytest.fixture(scope="module")
def hand(tmp_path_factory):
    client = Client()
    made = FloatingHand(client, ReferenceSettings(), tmp_path_factory.mktemp("hand"))
    made.put((0.0, 0.0, TCP), (1.0, 0.0, 0.0, 0.0))
    yield made
    client.close()


def below(hand, x, y):
    """Where a ray from below meets the hand, z in m."""
    hit = hand.client.rayTest([x, y, -0.2], [x, y, 0.3])[0]
    return hit[3][2] if hit[0] >= 0 else np.inf


def highest(hand, column):
    """The highest point of a column's foot at which the hand begins."""
    start, stop, width, _ = column
    across = (-width + NEXT_TO_THE_EDGE, 0.0, width - NEXT_TO_THE_EDGE)
    along = np.linspace(start + NEXT_TO_THE_EDGE, stop - NEXT_TO_THE_EDGE, 4)
    return max(below(hand, x, y) for x in along for y in across)


def opened(hand, gap):
    hand.put_fingers(hand.angle_for(gap))
    hand.client.performCollisionDetection()


@pytest.mark.parametrize("gap", np.linspace(0.002, 0.086, 15).round(4).tolist())
def test_every_column_lies_inside_the_hand(hand, gap):
    opened(hand, gap)
    for column in AIRO.columns(gap):
        assert highest(hand, column) <= column[3] + 2e-4, column


def test_a_column_beside_the_hand_would_be_noticed(hand):
    opened(hand, 0.052)
    pad = AIRO.columns(0.052)[0]
    assert highest(hand, pad - [0.005, 0.005, 0.0, 0.0]) > pad[3] + 0.01


def test_the_columns_are_as_wide_apart_as_the_pads():
    for gap in (0.01, 0.04, 0.08):
        found = AIRO.columns(gap)
        assert found[found[:, 0] > 0.003][:, 0].min() == pytest.approx(gap / 2)
        assert found[:, 1].max() == pytest.approx(-found[:, 0].min())
