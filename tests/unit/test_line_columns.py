import numpy as np
import pytest

from scanplan.rays import line_columns, scan_view

NORMAL = np.array([-1.0, 0.0])  # of the line x = 2, seen from the origin
SIZES = {"sill_m": 0.5, "door_m": 1.9}


def columns(where_m, height_m, scan):
    """Return the columns of the line in a scan of these points and two of the floor, 1 m below the sensor."""
    view = scan_view.sort_by_azimuth(np.vstack([np.reshape(scan, (-1, 3)), [(-1, 0, -1)] * 2]))
    return line_columns.classify_columns(
        view, NORMAL, -2.0, np.array(where_m), np.array(height_m), **SIZES
    )


def test_columns_are_open_where_rays_pass_and_shut_where_they_end():
    # lintels at y = 0.05 to 0.45; a ray through y = 0.17, another stopped that would come through y = 0.28
    found = columns([0.05, 0.15, 0.25, 0.35, 0.45], [2.2] * 5, [(4, 0.34, 0.2), (1, 0.14, 0.1)])
    assert found.is_open.tolist() == [False, True, False, False, False]
    assert found.is_shut.tolist() == [False, False, True, False, False]


def test_a_ray_above_the_top_of_doors_or_along_the_floor_tells_nothing():
    # through at 2 m above the floor, and at 0.13 m
    found = columns([0.0, 0.3], [2.2, 2.2], [(4, 0.3, 2.0), (2.3, 0.2, -1.0)])
    assert not found.is_open.any() and not found.is_shut.any()


def test_a_sill_is_as_high_as_its_points():
    low = columns([0.0, 0.15, 0.3], [0.4, 0.4, 0.4], [(4, 0.3, 0.2)])
    assert low.is_open.tolist() == [False, True, False] and low.is_shut.tolist() == [
        True,
        False,
        True,
    ]
    high = columns([0.0, 0.15, 0.3], [0.6, 0.6, 0.6], [(4, 0.3, 0.2)])
    assert not high.is_open.any()


@pytest.mark.parametrize("side", [1, -1])
def test_a_grazing_ray_opens_all_that_it_runs_close_behind(side):
    """A ray through y = 1 comes 8 cm behind the line 0.04 m farther along; one through y = 20 takes 0.8 m."""
    far = columns(side * np.arange(0.5, 2.0, 0.1), [2.2] * 15, [(2.2, side * 1.1, 0.1)])
    assert np.count_nonzero(far.is_open) == 1
    view = [(2.1, side * 21.0, 0.1)]
    grazing = columns(side * np.arange(19.5, 21.5, 0.1), [2.2] * 20, view)
    assert np.count_nonzero(grazing.is_open) == pytest.approx(9, abs=1)


def test_few_columns_however_far_a_point_is():
    assert len(columns([0.0, 1e6], [1.0, 1.0], [(4, 0.3, 0.2)]).is_open) <= 10_001


def test_runs_on_paper():
    where = [3.0, 0.0, 0.4, 0.2, 3.1, 9.0]
    assert line_columns.find_runs(np.array(where), 0.5, 2).tolist() == [[0.0, 0.4], [3.0, 3.1]]
    assert line_columns.find_runs(np.array(where), 0.5, 3).tolist() == [[0.0, 0.4]]
    assert line_columns.find_runs(np.empty(0), 0.5, 1).shape == (0, 2)


def test_runs_grow_through_further_positions_and_meet():
    shut = line_columns.LineColumns(0.0, 0.1, np.zeros(50, bool), np.ones(50, bool))
    found = np.array([(0.5, 1.0), (2.5, 3.0)])
    assert line_columns.grow_runs(found, np.array([0.1, 1.4]), 0.5, shut).tolist() == [
        [0.1, 1.4],
        [2.5, 3.0],
    ]
    assert line_columns.grow_runs(found, np.array([1.4, 1.8, 2.2]), 0.5, shut).tolist() == [
        [0.5, 3.0]
    ]
    gate = np.zeros(50, bool)
    gate[16] = True
    part_open = line_columns.LineColumns(0.0, 0.1, gate, ~gate)
    assert line_columns.grow_runs(found, np.array([1.4, 1.8, 2.2]), 0.5, part_open).tolist() == [
        [0.5, 1.4],
        [1.8, 3.0],
    ]
    assert len(line_columns.grow_runs(np.empty((0, 2)), np.array([1.0]), 0.5, shut)) == 0
