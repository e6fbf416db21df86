import numpy as np

from helpers.floorplan_making import faces
from helpers.wall_making import walls
from scanplan.report.plan_view import growth
from scanplan.report.plan_view.growth import NEVER

SETTINGS = {"max_angle_deg": 10.0, "distance_m": 0.1}


def grown(lines, rank, *, face=(0, 0, 4, 0, -1), min_scans=2):
    found = growth.cut_by_rank(
        faces([face]), walls(lines), np.array(rank, int), min_scans=min_scans, **SETTINGS
    )
    ends_m = found["x0_m"].round(3).tolist(), found["x1_m"].round(3).tolist()
    return list(zip(*ends_m, found["first"], found["enough"], strict=True))


def test_a_stretch_appears_with_the_first_scan_and_is_sure_with_enough():
    assert grown([(0, 0, 3, 0), (2, 0, 4, 0)], [1, 5]) == [
        (0, 2, 1, NEVER),
        (2, 3, 1, 5),
        (3, 4, 5, NEVER),
    ]


def test_the_order_of_the_segments_does_not_matter():
    assert grown([(2, 0, 4, 0), (0, 0, 3, 0)], [5, 1]) == grown(
        [(0, 0, 3, 0), (2, 0, 4, 0)], [1, 5]
    )


def test_one_scan_counts_once():
    assert grown([(0, 0, 4, 0), (0, 0.01, 4, 0.01)], [3, 3]) == [(0, 4, 3, NEVER)]


def test_one_scan_can_be_enough():
    assert grown([(0, 0, 4, 0)], [3], min_scans=1) == [(0, 4, 3, 3)]


def test_what_no_scan_shows_stays_open():
    assert grown([(0, 0, 1, 0), (3, 0, 4, 0)], [1, 2], min_scans=1) == [
        (0, 1, 1, 1), (1, 3, NEVER, NEVER), (3, 4, 2, 2),
    ]  # fmt: skip


def test_the_other_side_a_parallel_wall_and_a_turned_one_are_not_of_it():
    assert grown([(4, 0, 0, 0), (0, 0.2, 4, 0.2), (1, -0.09, 1.4, 0.09)], [1, 1, 1]) == [
        (0, 4, NEVER, NEVER)
    ]


def test_no_segments_and_no_faces():
    assert grown([], []) == [(0, 4, NEVER, NEVER)]
    none = growth.cut_by_rank(
        faces([]), walls([(0, 0, 1, 0)]), np.array([1]), min_scans=1, **SETTINGS
    )
    assert len(none["face"]) == 0


def test_a_short_face_is_one_stretch():
    assert grown([(0, 0, 4, 0)], [2], face=(1, 0, 1.02, 0, -1)) == [(1, 1.02, 2, NEVER)]
