import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.cluster import MeanShift

from scanplan.extraction import mean_shift


def same_partition(first, second):
    pairs = {(a, b) for a, b in zip(first.tolist(), second.tolist(), strict=True)}
    return len(pairs) == len(set(first.tolist())) == len(set(second.tolist()))


@pytest.mark.parametrize("seed", range(5))
def test_same_modes_and_labels_as_scikit_learn(seed):
    draw = np.random.default_rng(seed)
    centres = np.array([(0, 0), (2, 0.3), (-1, 2), (1.2, -2.2)])
    points = np.vstack(
        [c + draw.normal(0, 0.12, (n, 2)) for c, n in zip(centres, (60, 50, 40, 30), strict=True)]
    )
    labels, found = mean_shift.mean_shift(points, bandwidth_m=0.6)
    other = MeanShift(bandwidth=0.6).fit(points)
    assert found == pytest.approx(other.cluster_centers_, abs=0.6 / 8)
    assert (labels == other.labels_).all()
    assert found == pytest.approx(centres, abs=0.1)


def test_orphans_as_scikit_learn_without_them():
    points = np.vstack(
        [np.random.default_rng(0).normal(0, 0.1, (50, 2)), [(0.72, 0)], [(5.0, 5.0)]]
    )
    labels, found = mean_shift.mean_shift(points, bandwidth_m=0.7)
    other = MeanShift(bandwidth=0.7, cluster_all=False).fit(points)
    assert same_partition(labels, other.labels_)
    assert len(found) == len(other.cluster_centers_)


def test_one_row_is_the_flat_kernel_exactly():
    # on a line the row sums are exact: within 1 of 0.5 are 0 and 1, of 3.5 are 3 and 4
    labels, found = mean_shift.mean_shift(
        [(0, 0), (1, 0), (3, 0), (4, 0), (3.5, 0)], bandwidth_m=1.0
    )
    assert found == pytest.approx(np.array([(3.5, 0), (0.5, 0)]))
    assert labels.tolist() == [1, 1, 0, 0, 0]


def test_modes_are_farther_apart_than_the_bandwidth_and_heaviest_first():
    points = np.random.default_rng(7).uniform(0, 5, (2000, 2))
    labels, found = mean_shift.mean_shift(points, bandwidth_m=0.5)
    gaps = np.linalg.norm(found[:, None] - found[None], axis=2) + np.eye(len(found))
    assert gaps.min() > 0.5
    near = [(np.linalg.norm(points - mode, axis=1) <= 0.5).sum() for mode in found]
    assert near[0] == pytest.approx(max(near), rel=0.1)
    assert (labels >= -1).all()


def test_nothing_one_point_and_duplicates():
    labels, found = mean_shift.mean_shift(np.empty((0, 2)), bandwidth_m=0.3)
    assert len(labels) == len(found) == 0
    labels, found = mean_shift.mean_shift([(1, 2)], bandwidth_m=0.3)
    assert labels.tolist() == [0]
    assert found == pytest.approx(np.array([(1, 2)]))
    labels, found = mean_shift.mean_shift([(1, 2)] * 9, bandwidth_m=0.3)
    assert labels.tolist() == [0] * 9
    assert found == pytest.approx(np.array([(1, 2)]))


@pytest.mark.parametrize("bandwidth_m", [0, -1, np.nan])
def test_bandwidth_must_be_positive(bandwidth_m):
    with pytest.raises(ValueError, match="positive bandwidth"):
        mean_shift.mean_shift([(0, 0)], bandwidth_m=bandwidth_m)


def test_points_must_be_finite():
    with pytest.raises(ValueError, match="finite"):
        mean_shift.mean_shift([(0, np.nan)], bandwidth_m=1)


@given(st.floats(-100, 100), st.floats(-100, 100), st.permutations(range(40)))
@settings(max_examples=20, deadline=None)
def test_modes_move_with_the_points_and_ignore_their_order(x, y, order):
    draw = np.random.default_rng(1)
    points = np.vstack([draw.normal(0, 0.1, (20, 2)), draw.normal(3, 0.1, (20, 2))])
    labels, found = mean_shift.mean_shift(points, bandwidth_m=0.5)
    moved_labels, moved = mean_shift.mean_shift(points[order] + (x, y), bandwidth_m=0.5)
    assert same_partition(moved_labels, labels[order])
    assert np.sort(moved, axis=0) == pytest.approx(
        np.sort(found, axis=0) + np.array([x, y]), abs=0.5 / 4
    )


def test_crowded_neighbourhoods_are_no_matter():
    # every point has some 50,000 neighbours within the bandwidth
    points = np.random.default_rng(1).normal(0, 1, (200_000, 2))
    labels, found = mean_shift.mean_shift(points, bandwidth_m=0.8)
    assert found[0] == pytest.approx([0, 0], abs=0.1)
    assert (labels[np.linalg.norm(points, axis=1) < 0.3] == 0).all()
