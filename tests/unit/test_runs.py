"""Runs along a line; columns of 10 cm given ray by ray."""

import numpy as np
import pytest

from scanplan.extraction import runs

FOUND = np.array([(0.5, 1.0), (2.5, 3.0)])
DOOR_M, SILL_M = 1.9, 0.5


def grown(found, where_m, *, opened=()):
    is_open = np.isin(np.arange(50), opened)
    columns = runs.LineColumns(0.0, is_open, np.full(50, False))
    return runs.grow_runs(found, np.array(where_m), 0.5, columns).tolist()


def column(number, *heights_m):
    """Return rays through the middle of a column, one at each height."""
    return [(0.1 * (number + 0.5), z_m) for z_m in heights_m]


def sort(occupied=(), free=(), occluded=(), until_m=None):
    """Return ten columns, each ray given by its place along and its height."""
    kinds = [np.reshape(np.array(rows, float), (-1, 2)).T for rows in (occupied, free, occluded)]
    occupied, free, occluded = (tuple(kind) for kind in kinds)
    until_m = free[0] if until_m is None else np.array(until_m)
    limits = {"span_m": (0.0, 0.95), "sill_m": SILL_M, "door_m": DOOR_M}
    return runs.sort_into_columns(runs.LineRays(occupied, free, until_m, occluded), **limits)


def test_runs_end_where_positions_pause():
    where = np.array([3.0, 0.0, 0.4, 0.2, 3.1, 9.0])
    assert runs.find_runs(where, 0.5, 2).tolist() == [[0.0, 0.4], [3.0, 3.1]]
    assert runs.find_runs(where, 0.5, 3).tolist() == [[0.0, 0.4]]
    assert runs.find_runs(np.empty(0), 0.5, 1).shape == (0, 2)


def test_runs_grow_through_further_positions_and_meet():
    assert grown(FOUND, [0.1, 1.4]) == [[0.1, 1.4], [2.5, 3.0]]
    assert grown(FOUND, [1.4, 1.8, 2.2]) == [[0.5, 3.0]]
    assert grown(np.empty((0, 2)), [1.0]) == []


def test_an_open_column_ends_a_run():
    assert grown(FOUND, [1.4, 1.8, 2.2], opened=[16]) == [[0.5, 1.4], [1.8, 3.0]]


def test_a_run_is_prolonged_within_its_reach_and_no_farther():
    """2 m off, 0.05 rad reach 0.1 m at the foot and 0.112 m at 1 m along; pauses, half of it."""
    where = np.array([-0.06, 0.0, 1.0, 1.04, 1.08, 1.12])
    assert runs.extend_run_ends(0.0, 1.0, where, 0.05, 2.0) == [0.0, 1.08]
    assert runs.extend_run_ends(0.0, 1.0, where[1:3], 0.05, 2.0) == [0.0, 1.0]


@pytest.mark.parametrize(
    ("ends_m", "through_m", "is_open"),
    [
        ((), (1.0,), True),
        ((), (0.1,), False),  # along the floor
        ((), (2.2,), False),  # above a door
        ((2.2,), (1.0,), True),  # below a lintel
        ((0.3,), (1.0,), True),  # over a sill
        ((0.3,), (0.22,), False),  # below what ends rays
        ((0.52,), (1.0,), False),  # higher than a sill
        ((1.0,), (0.5,), False),
    ],
)
def test_a_column_is_open_where_a_ray_goes_over_its_sill(ends_m, through_m, is_open):
    found = sort(column(4, *ends_m), column(4, *through_m))
    assert found.is_open.tolist() == [number == 4 and is_open for number in range(10)]


@pytest.mark.parametrize(
    ("ends_m", "before_m", "is_stopped"),
    [
        ((1.0,), (), True),
        ((0.1,), (), True),
        ((2.2,), (), False),  # the wall above a door shows nothing of what is below
        ((), (1.0,), True),
        ((), (0.1,), False),  # along the floor
        ((), (2.2,), False),
        ((), (), False),
    ],
)
def test_a_column_is_stopped_where_rays_end_at_it_or_before_it(ends_m, before_m, is_stopped):
    found = sort(column(4, *ends_m), column(4, 1.0), column(4, *before_m))
    assert found.is_stopped.tolist() == [number == 4 and is_stopped for number in range(10)]


def test_a_grazing_ray_opens_columns_until_it_leaves_the_thinnest_wall():
    rays, until_m = [(0.25, 1.0), (0.65, 1.0)], [0.55, 0.62]
    assert np.flatnonzero(sort((), rays, until_m=until_m).is_open).tolist() == [2, 3, 4, 5, 6]
    # a ray the other way opens the same columns, and none is beyond the last
    back = sort((), [(z, 1.0) for z in until_m], until_m=[0.25, 0.65])
    assert np.flatnonzero(back.is_open).tolist() == [2, 3, 4, 5, 6]
    assert np.flatnonzero(sort((), [(0.85, 1.0)], until_m=[7.0]).is_open).tolist() == [8, 9]
