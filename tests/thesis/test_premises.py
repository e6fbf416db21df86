"""Premises on paper: two walls with a door, and scans that show parts of them."""

import numpy as np
import pytest

from scanplan.lab.evaluation import bitmap_shares, face_cells, wall_findings
from thesis import premises
from thesis.steps_figure import WallSteps

# a wall with a door in it, and one at a right angle
FACES = np.array([(0, 2, 2, 2), (3, 2, 5, 2), (5, 2, 5, -2)], float).reshape(-1, 2, 2)


def steps(xy_m, label):
    nothing = np.zeros((len(xy_m), 2))
    return WallSteps(xy_m, nothing, nothing, np.array(label), np.empty((0, 2, 2)))


def test_a_wall_goes_on_behind_its_door():
    line = premises.number_lines(np.concatenate([FACES, FACES[:1, ::-1]]))
    assert line[0] == line[1] == line[3] != line[2]


def test_the_sides_of_a_thin_wall_are_two():
    line = premises.number_lines(np.array([[(0, 2.0), (2, 2.0)], [(0, 2.1), (2, 2.1)]]))
    assert line[0] != line[1]


def test_the_share_on_one_wall_as_counted_on_paper():
    on_first = [(x, 1.0) for x in (-0.5, 0.5, 2.5, 3.5)]
    on_second, nowhere = [(4.0, 0.0), (4.01, -1.0)], [(1.0, -2.0)]
    xy_m = np.array([*on_first, *on_second, *nowhere])
    # seen from (1, 1): one cluster of a wall on both sides of the door and a point of the other,
    # one of the other wall and of furniture
    label = [0, 0, 0, 0, 0, 1, 1]
    here = np.array([1.0, 1.0])
    found = premises.share_on_one_wall(steps(xy_m, label), here, FACES, min_points=2)
    assert found == pytest.approx((4 + 1) / 7)
    some = premises.share_on_one_wall(steps(xy_m, label), here, FACES, min_points=3)
    assert some == pytest.approx(4 / 5)
    assert np.isnan(premises.share_on_one_wall(steps(xy_m, label), here, FACES, min_points=9))


def findings_of(lines, scan, n_scans):
    cells = face_cells.cut_faces(FACES)
    every = np.ones(len(cells.face), bool)
    truth = wall_findings.VisibleTruth(cells, np.tile(every, (n_scans, 1)), every, every)
    lines_m = np.array(lines, float).reshape(-1, 2, 2)
    drawn = wall_findings.PlacedSegments(lines_m, lines_m, np.array(scan))
    bitmaps = bitmap_shares.trace_truth(FACES, lines_m, 0.05)
    return truth, wall_findings.match_segments(drawn, truth, bitmaps)


def test_scans_that_show_the_same_add_more_one_by_one_than_together():
    # every scan shows the same wall, but for one that shows another
    lines = [(0, 2, 2, 2)] * 3 + [(5, 2, 5, -2)]
    truth, findings = findings_of(lines, [0, 1, 2, 3], 4)
    ratios = premises.submodularity_ratios(truth, findings, n_added=2, seed=1)
    assert len(ratios) == 2 and set(ratios[0]) == set(premises.UTILITIES)
    for ratio in ratios:
        assert not ratio["walls found"] < 1 - 1e-9


def test_scans_that_show_nothing_in_common_add_as_much_either_way():
    lines = [(0, 2, 1, 2), (1.2, 2, 2, 2), (3, 2, 5, 2), (5, 1.5, 5, -2)]
    truth, findings = findings_of(lines, [0, 1, 2, 3], 4)
    for ratio in premises.submodularity_ratios(truth, findings, n_added=2, seed=1):
        # their tolerances meet at ends only
        assert ratio["walls found"] == pytest.approx(1, abs=0.05)
