"""The columns that the screens take for the hand lie inside the simulated one."""

import tempfile
from pathlib import Path

import numpy as np
import pytest

from proc3s_tabletop.client import Client
from proc3s_tabletop.columns import columns
from proc3s_tabletop.hand import FloatingHand
from proc3s_tabletop.motion import tool_poses, top_down
from proc3s_tabletop.recipe import Recipe

HEIGHT = 0.5
"""Of the grasp point, m."""
CLOSE = 2e-4
"""The hand begins at most this far above the lower end of a column, m."""
GAPS = (
    0.002,
    0.006,
    0.010,
    0.015,
    0.020,
    0.030,
    0.040,
    0.046,
    0.052,
    0.058,
    0.064,
    0.070,
    0.075,
    0.080,
    0.086,
)


class Hovering:
    """A hand in the air that points down and closes along y, with its grasp point over the origin."""

    def __init__(self, client, folder):
        self.hand = FloatingHand(client, Recipe(), folder)
        self._client = client
        (pose,) = tool_poses(top_down(0.0, 0.0, HEIGHT)[None])
        turn = pose[:3, :3]
        # Half a turn about an axis in the plane: the quaternion that brings the third axis down.
        axis = np.sqrt(np.maximum((np.diag(turn) + 1) / 2, 0.0))
        axis[1] *= np.sign(turn[0, 1]) or 1.0
        self.hand.put(tuple(pose[:3, 3].tolist()), (*axis.tolist(), 0.0))
        middle, along = self.hand.grasp_point()
        assert middle == pytest.approx([0, 0, HEIGHT], abs=1e-6)
        assert along == pytest.approx([0, 0, -1], abs=1e-6)

    def open_to(self, gap):
        """Put the fingers where the pads are this far apart."""
        self.hand.put_fingers(self.hand.angle_for(gap))
        self._client.performCollisionDetection()
        assert self.hand.gap() == pytest.approx(gap, abs=1e-3)

    def lower_end(self, points):
        """Where rays straight up from points (n, 2) meet the hand, above its grasp point; inf if they miss."""
        starts = [[x, y, HEIGHT - 0.1] for x, y in points]
        ends = [[x, y, HEIGHT + 0.3] for x, y in points]
        hits = self._client.rayTestBatch(starts, ends)
        return np.array([h[3][2] - HEIGHT if h[0] == self.hand.id else np.inf for h in hits])


@pytest.fixture(scope="module")
def hovering():
    client = Client()
    with tempfile.TemporaryDirectory() as folder:
        yield Hovering(client, Path(folder))
    client.close()


def excess(hovering, found):
    """How far above their lower ends the hand begins over points of columns (k, 4), at most, for each."""
    worst = []
    for start, stop, width, bottom in found:
        across, along = np.meshgrid(np.linspace(-width, width, 9), np.linspace(start, stop, 9))
        points = np.stack([across.ravel(), along.ravel()], axis=1)
        worst.append((hovering.lower_end(points) - bottom).max())
    return np.array(worst)


@pytest.mark.parametrize("gap", GAPS)
def test_columns_lie_inside_the_hand(hovering, gap):
    hovering.open_to(gap)
    assert excess(hovering, columns(gap)).max() <= CLOSE


@pytest.mark.parametrize("gap", [0.010, 0.040, 0.086])
def test_a_column_moved_out_by_5_mm_would_be_noticed(hovering, gap):
    hovering.open_to(gap)
    right, left = np.array([[0.005, 0.005, 0, 0]]), np.array([[-0.005, -0.005, 0, 0]])
    outermost = columns(gap)[[5, 11]] + np.vstack([right, left])
    assert (excess(hovering, outermost) > CLOSE).all()


@pytest.mark.parametrize("change", [(0, 0, 0.005, 0), (0, 0, 0, -0.005)], ids=["wider", "lower"])
def test_every_column_that_is_wider_or_lower_by_5_mm_would_be_noticed(hovering, change):
    hovering.open_to(0.040)
    assert (excess(hovering, columns(0.040)[:12] + np.array(change)) > CLOSE).all()


@pytest.mark.parametrize("gap", GAPS)
def test_columns_mirror_each_other(gap):
    found = columns(gap)
    right, left = found[:6], found[6:12]
    assert left == pytest.approx(right[:, [1, 0, 2, 3]] * [-1, -1, 1, 1])
    assert (found[:, 0] < found[:, 1]).all()
    assert right[0, 0] == pytest.approx(gap / 2)
