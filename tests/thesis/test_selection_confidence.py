"""Selection by the confidence of the walls so far, on walls whose gains are worked out on paper."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thesis.beyond import confidence
from thesis.beyond.confidence import CellViews, WallConfidence, Walls

SIGMA_M = 0.06
NOTHING = Walls(np.zeros((0, 2, 2)), np.zeros((0, 2)))


def gains(*sightings):
    """Of one cell, after looks that found a wall at an offset, or none (NaN)."""
    cell = WallConfidence(1, SIGMA_M)
    for offset_m in sightings:
        cell.add(np.array([0]), np.array([offset_m]))
    return cell.expected_gain()[0] / SIGMA_M**2


def test_a_gap_is_worth_more_than_a_wall_that_was_found():
    # a look finds a wall with a chance of 1/2 and halves the variance; after a hit 2/3, 1/2 - 1/3
    assert gains() == pytest.approx(1 / 2 * 1 / 2)
    assert gains(0.0) == pytest.approx(2 / 3 * 1 / 6)
    assert gains(0.0, 0.0) == pytest.approx(3 / 4 * 1 / 2 * 1 / 12)


def test_where_looks_found_nothing_one_more_is_worth_less():
    assert gains(np.nan) == pytest.approx(1 / 3 * 1 / 2)
    assert gains(np.nan, np.nan) == pytest.approx(1 / 4 * 1 / 2)


def test_walls_that_lie_apart_are_worth_another_look():
    # 6 cm to either side: a spread of two variances beside the one that is assumed
    assert gains(-SIGMA_M, SIGMA_M) == pytest.approx(3 * gains(0.0, 0.0))


def test_offsets_are_to_the_nearest_wall_of_the_cells_facing():
    walls = Walls(
        np.array([[[0.0, 1.0], [4.0, 1.0]], [[0.0, 1.2], [4.0, 1.2]]]),
        np.array([[0.0, -1.0], [0.0, 1.0]]),
    )
    centre_m = np.array([[1.0, 1.1], [1.0, 1.1], [1.0, 0.9], [4.3, 1.0], [1.0, 1.1]])
    # -y, +y, -y, -y beyond the wall's end, and a facing that no wall has
    normal = np.array([[0.0, -1], [0, 1], [0, -1], [0, -1], [-1, 0]])
    found = confidence.measure_offsets(centre_m, normal, walls, 0.25)
    np.testing.assert_allclose(found, [-0.1, -0.1, 0.1, np.nan, np.nan], atol=1e-12)
    nothing = confidence.measure_offsets(centre_m, normal, NOTHING, 0.25)
    assert np.isnan(nothing).all()


def test_cells_lie_where_observations_have_them():
    columns = {
        "scan_id": np.array([3, 3, 7]),
        "facing": np.array([0, 2, 0]),
        "along": np.array([4, 4, 4]),
        "across": np.array([1, 1, 1]),
        "length_m": np.array([0.2, 0.1, 0.05]),
        "axes_deg": np.zeros(3, int),
    }
    views = confidence.view_cells_of(columns, np.array([3, 5, 7]), 0.5)
    assert views.first.tolist() == [0, 2, 2, 3]
    assert views.cell[0] == views.cell[2] != views.cell[1]
    # of a facing along x: across is x, along y; along y the other way round
    np.testing.assert_allclose(views.centre_m[views.cell[:2]], [[0.75, 2.25], [2.25, 0.75]])
    np.testing.assert_array_equal(views.normal[views.cell[:2]], [[-1, 0], [0, -1]])
    askew = confidence.view_cells_of({**columns, "axes_deg": np.full(3, 90)}, np.array([3, 7]), 0.5)
    np.testing.assert_allclose(askew.centre_m[askew.cell[:2]], [[-2.25, 0.75], [-0.75, 2.25]])
    np.testing.assert_allclose(askew.normal[askew.cell[:2]], [[0, -1], [1, 0]], atol=1e-12)


def views_of(shown, n_cells):
    """Scans that show some cells, 1 m long each: cells 1 m apart on the line y = 0, facing -y."""
    centre_m = np.column_stack([np.arange(n_cells), np.zeros(n_cells)]).astype(float)
    counts = [len(cells) for cells in shown]
    cell = np.array([c for cells in shown for c in cells], int)
    first = np.concatenate([[0], np.cumsum(counts)])
    return CellViews(first, cell, np.ones(len(cell)), centre_m, np.tile([0.0, -1.0], (n_cells, 1)))


def test_a_gap_comes_before_a_second_look_at_a_longer_wall():
    """Scans 0 and 1 show the same three cells, 2 and 3 two others, in which nothing is found."""
    views = views_of([[0, 1, 2], [0, 1, 2], [3, 4], [3, 4]], 5)
    wall = Walls(np.array([[[-0.5, 0.0], [2.5, 0.0]]]), np.array([[0.0, -1.0]]))
    asked = []

    def extract(scan):
        asked.append(scan)
        return wall if scan < 2 else NOTHING

    order = confidence.order_by_confidence(views, extract, sigma_m=SIGMA_M, near_m=0.25)
    # 2 x 1/2 x 1/2 of the gap, 3 x 2/3 x 1/6 of the wall found once
    assert order.tolist()[:2] == [0, 2] and asked == order.tolist()


@given(
    shown=st.lists(st.sets(st.integers(0, 5)).map(sorted), min_size=1, max_size=7),
    finds=st.integers(0, 127),
)
def test_every_scan_is_asked_once_and_ordered(shown, finds):
    wall = Walls(np.array([[[-0.5, 0.0], [5.5, 0.0]]]), np.array([[0.0, -1.0]]))
    asked = []

    def extract(scan):
        asked.append(scan)
        return wall if finds >> scan & 1 else NOTHING

    views = views_of(shown, 6)
    order = confidence.order_by_confidence(views, extract, sigma_m=SIGMA_M, near_m=0.25)
    assert order.tolist() == asked and sorted(asked) == list(range(len(shown)))
    most = max(len(cells) for cells in shown)
    assert len(shown[asked[0]]) == most
