"""What planar scans agree on, on cells small enough to count by hand."""

import numpy as np
import pytest

from scanplan.selection import persistence
from scanplan.store.registered_scans import RegisteredScans


def observations(rows):
    """Return the columns of rows of (scan_id, facing, along, across, length_m)."""
    columns = np.array(rows, float).reshape(-1, 5).T
    names = ("scan_id", "facing", "along", "across")
    numbers = dict(zip(names, columns[:4].astype(np.int32), strict=True))
    return {**numbers, "length_m": columns[4]}


def weigh_by_persistence(columns, places_m=None):
    """Weigh observations of scans that are a metre apart, or at some places."""
    scan_ids = np.unique(columns["scan_id"])
    if places_m is None:
        places_m = [(scan, 0.2) for scan in scan_ids]
    map_from_sensor = np.tile(np.eye(4), (len(scan_ids), 1, 1))
    map_from_sensor[:, :2, 3] = np.array(places_m, float).reshape(-1, 2)
    unknown = np.full((len(scan_ids), 3, 3), np.nan)
    t_ns = 10**8 * scan_ids.astype(np.int64)
    registered = RegisteredScans(scan_ids, t_ns, map_from_sensor, unknown)
    return persistence.weigh_by_persistence(columns, registered)


def test_half_of_the_best_shows_a_cell_and_less_counts_in_proportion():
    one_cell = [(0, 0, 5, 2, 0.2), (1, 0, 5, 2, 0.1), (2, 0, 5, 2, 0.04)]
    columns = observations([*one_cell, (0, 1, 5, 2, 0.03)])
    weighed = weigh_by_persistence(columns)
    np.testing.assert_allclose(weighed["length_m"], [0.2, 0.2, 0.08, 0.03])
    assert all(weighed[name] is columns[name] for name in columns if name != "length_m")


def test_no_observation_is_none():
    assert len(weigh_by_persistence(observations([]))["length_m"]) == 0


@pytest.mark.parametrize(("n_showing", "counts"), [(1, 0.25), (2, 0.5), (3, 0.75), (4, 1), (9, 1)])
@pytest.mark.parametrize("across", [-3, 2])
def test_of_what_less_than_a_fifth_of_the_scans_show_as_much_less_counts(n_showing, counts, across):
    wall = [(scan, 0, 0, 0, 0.25) for scan in range(20)]
    chair = [(scan, 0, 1, across, 0.1) for scan in range(n_showing)]
    weighed = weigh_by_persistence(observations([*wall, *chair]))
    assert weighed["length_m"][:20] == pytest.approx(0.25)
    assert weighed["length_m"][20:] == pytest.approx(0.1 * counts)


@pytest.mark.parametrize(("facing", "along"), [(1, 0), (0, 8), (0, -5)])
def test_scans_that_look_elsewhere_or_at_the_other_side_do_not_count(facing, along):
    wall = [(scan, 0, 0, 0, 0.25) for scan in range(20)]
    weighed = weigh_by_persistence(observations([*wall, (0, facing, along, 0, 0.1)]))
    assert weighed["length_m"][20] == pytest.approx(0.1)


def test_a_wall_that_noise_parts_between_two_rows_is_shown_by_all_its_scans():
    rows = [(scan, 2, 0, scan % 2, 0.25) for scan in range(20)]
    beside = [(20 + scan, 2, 3, 3, 0.25) for scan in range(75)]
    weighed = weigh_by_persistence(observations([*rows, *beside]))
    assert weighed["length_m"] == pytest.approx(0.25)


def test_places_below_zero_are_near_those_above():
    wall = [(scan, 3, scan % 2 - 1, 0, 0.25) for scan in range(20)]
    weighed = weigh_by_persistence(observations([*wall, (0, 3, -4, -4, 0.1)]))
    assert weighed["length_m"][-1] == pytest.approx(0.1 * 0.25)


def test_however_long_a_sensor_stands_at_a_place_it_looks_from_there_once():
    """100 scans from one place show half of a wall, 4 on the way past it the other half."""
    rows = [(scan, 0, 0, 0, 0.25) for scan in range(100)]
    rows += [(100 + scan, 0, along, 0, 0.25) for scan in range(4) for along in (0, 3)]
    places_m = [(-0.1, 0.2)] * 100 + [(scan, 3.2) for scan in range(4)]
    weighed = weigh_by_persistence(observations(rows), places_m)
    assert weighed["length_m"] == pytest.approx(0.25)
    chair = [(50, 0, 2, 2, 0.1), (51, 0, 2, 2, 0.1)]
    seen_twice = weigh_by_persistence(observations(sorted([*rows, *chair])), places_m)
    assert seen_twice["length_m"].min() == pytest.approx(0.1)


@pytest.mark.parametrize("far", [2_000_000, -2_000_000])
def test_cells_far_from_the_origin_of_the_map_count_alike(far):
    wall = [(scan, 0, far, 10 * far, 0.25) for scan in range(2000)]
    weighed = weigh_by_persistence(observations([*wall, (0, 0, far + 1, 10 * far + 3, 0.1)]))
    assert weighed["length_m"].sum() == pytest.approx(500 + 0.1 / (0.2 * 2000))
