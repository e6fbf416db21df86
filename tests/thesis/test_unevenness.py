"""Uneven sampling on paper: three rooms in a row, of which only the first is crowded."""

from itertools import combinations

import numpy as np
import pandas as pd
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from scanplan.lab.evaluation import visible_faces
from scanplan.lab.evaluation.truth_file import TrueFaces
from thesis import unevenness

# ten scans in the first room, one in each of the others; cells are the rooms' walls, of 10 m, 20 m
# and 30 m
ROOM = np.array([0] * 10 + [1, 2])
SEEN = ROOM[:, None] == np.arange(3)
LENGTH_M = np.array([10.0, 20.0, 30.0])
POLYGONS = np.array([shapely.box(4 * room, 0, 4 * room + 1 + room, 1) for room in ROOM])
SAMPLING = {"n_clusters": 4, "sample_size": 50, "radius": "least_distance", "seed": 1}


def measured(crowd, n_selected=2):
    further = {row: np.repeat(POLYGONS[row], 19) for row in crowd}
    columns = unevenness.unevenness_columns(
        SEEN, LENGTH_M, POLYGONS, further, [np.array(crowd)], n_selected=n_selected
    )
    return pd.DataFrame(columns)


def test_the_order_by_area_takes_the_largest_rooms_however_often_the_others_were_seen():
    columns = measured(range(10))
    of_it = columns[columns["order"] == "cluster_hull"]
    assert of_it["repeats"].tolist() == [1, 5, 20]
    np.testing.assert_allclose(of_it["seen_m"], 50.0)


def test_a_random_order_sees_what_chance_says():
    even_m, lost = unevenness.lost_shares(measured(range(10)))
    # two of 10 + 2 scans: in the first room with one of 45/66, both others 1/66, one of them 10/66
    # each
    assert even_m["random"] == pytest.approx((45 * 10 + 10 * 30 + 10 * 40 + 50) / 66)
    # of 200 + 2 scans both nearly always lie in the first room
    n = 202 * 201 / 2
    crowded_m = (199 * 100 * 10 + 200 * 30 + 200 * 40 + 50) / n
    assert lost["random"][20] == pytest.approx(1 - crowded_m / even_m["random"])
    assert 0 < lost["random"][5] < lost["random"][20]


@given(st.integers(0, 2**31), st.integers(1, 7))
def test_what_is_to_be_expected_is_the_mean_of_all_subsets(seed, n_selected):
    rng = np.random.default_rng(seed)
    seen = rng.random((6, 4)) < 0.4
    length_m = rng.uniform(1, 5, 4)
    polygons = np.array([shapely.box(i, 0, i + 1, 1) for i in range(6)])
    columns = unevenness.unevenness_columns(
        seen, length_m, polygons, {0: np.repeat(polygons[0], 19)}, [np.array([0])],
        n_selected=n_selected,
    )  # fmt: skip
    found = pd.DataFrame(columns).query("order == 'random' and repeats == 1")["seen_m"].item()
    subsets = list(combinations(range(6), min(n_selected, 6)))
    lengths_m = [length_m[seen[list(rows)].any(axis=0)].sum() for rows in subsets]
    assert found == pytest.approx(np.mean(lengths_m))


def test_a_crowd_in_the_longest_room_does_no_such_harm():
    _, lost = unevenness.lost_shares(measured([11]))
    assert lost["random"][20] < 0


def test_a_survey_of_fewer_scans_is_seen_whole():
    columns = measured([11], n_selected=200)
    np.testing.assert_allclose(columns["seen_m"], 60.0)


def test_a_crowd_is_of_neighbours():
    places_m = np.column_stack([np.arange(40.0), np.zeros(40)])
    found = unevenness.draw_crowds(places_m, seed=3)
    assert len(found) == 3 and all(len(rows) == 4 and np.ptp(rows) == 3 for rows in found)
    assert [len(rows) for rows in unevenness.draw_crowds(places_m[:2], seed=3)] == [1, 1]


def test_no_two_times_that_a_scan_was_taken_are_the_same_to_the_order():
    points = np.random.default_rng(0).normal(0, 1, (300, 3))
    found = unevenness.copy_hulls(5, points, n_copies=3, **SAMPLING)
    assert len(set(shapely.area(found).round(9))) == 3
    again = unevenness.copy_hulls(5, points, n_copies=3, **SAMPLING)
    assert shapely.equals(found, again).all()


def test_what_a_place_sees_is_told_with_its_length():
    box = np.array([(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0)], float).reshape(
        -1, 2, 2
    )
    here = np.eye(4)
    here[:2, 3] = 1.0
    seen, length_m = unevenness.view_cells(
        TrueFaces(box, np.empty((0, 2, 2))), here[None], visible_faces.SensorView(100.0)
    )
    np.testing.assert_allclose((seen @ length_m), 20.0)
