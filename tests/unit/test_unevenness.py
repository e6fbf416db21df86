"""Uneven sampling on paper: three rooms in a row, of which only the first is crowded."""

import numpy as np
import shapely

from scanplan.lab.evaluation import visible_faces
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.lab.thesis import unevenness

# ten scans in the first room, one in each of the others; cells are the rooms' walls, of 10 m, 20 m
# and 30 m
ROOM = np.array([0] * 10 + [1, 2])
SEEN = ROOM[:, None] == np.arange(3)
LENGTH_M = np.array([10.0, 20.0, 30.0])
POLYGONS = np.array([shapely.box(4 * room, 0, 4 * room + 1 + room, 1) for room in ROOM])
SAMPLING = {"n_clusters": 4, "sample_size": 50, "radius": "least_distance", "seed": 1}


def measured(crowd, n_selected=2):
    further = {row: np.repeat(POLYGONS[row], 19) for row in crowd}
    return unevenness.unevenness_columns(
        SEEN, LENGTH_M, POLYGONS, further, [np.array(crowd)], n_selected=n_selected, seed=1
    )


def test_the_order_by_area_takes_the_largest_rooms_however_often_the_others_were_seen():
    columns = measured(range(10))
    of_it = columns["order"] == "cluster_hull"
    assert columns["repeats"][of_it].tolist() == [1, 5, 20] and columns["draw"][of_it].tolist() == [
        0,
        0,
        0,
    ]
    np.testing.assert_allclose(columns["seen_m"][of_it], 50.0)


def test_a_random_order_sees_what_chance_says():
    columns = measured(range(10))
    even_m, lost = unevenness.lost_shares(columns, "random")
    # two of 10 + 2 scans: in the first room with one of 45/66, both others 1/66, one of them 10/66
    # each
    np.testing.assert_allclose(even_m, (45 * 10 + 10 * 30 + 10 * 40 + 50) / 66, rtol=0.1)
    # of 200 + 2 scans both nearly always lie in the first room
    assert 0 < lost[1] < lost[2] and abs(even_m * (1 - lost[2]) - 10) < 1.5


def test_a_crowd_in_the_longest_room_does_no_such_harm():
    lost = unevenness.lost_shares(measured([11]), "random")[1]
    assert lost[2] < 0


def test_the_same_seed_draws_the_same():
    first, again = measured(range(10)), measured(range(10))
    assert all((first[name] == again[name]).all() for name in first)


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
