import itertools
import tracemalloc
from unittest import mock

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3
from scanplan.registration import loops


def there_and_back():
    """Along a line to x = 9 and back, 0.5 m beside it, a scan a metre."""
    x = np.r_[np.arange(10), np.arange(9, -1, -1)]
    return np.column_stack([x, np.repeat([0.0, 0.5], 10)])


def test_a_scan_is_linked_to_the_earlier_visit_of_its_place():
    pairs = loops.choose_loop_pairs(
        there_and_back(), np.ones(20, bool), radius_m=0.9, apart=2, most=4
    )
    assert pairs == [(i, 19 - i) for i in range(11, 20)]


def test_each_visit_gives_one_link_and_the_nearest_come_first():
    """Four times past the origin, ever nearer, with a long way between."""
    away = np.column_stack([np.full(5, 50.0), np.arange(5.0)])
    passes = [[[-1, y], [0, y], [1, y]] for y in (0.9, 0.6, 0.3, 0.0)]
    xy = np.concatenate(
        [np.concatenate([p, away + np.array([0, 10 * i])]) for i, p in enumerate(passes)]
    )
    pairs = loops.choose_loop_pairs(xy, np.ones(len(xy), bool), radius_m=2.0, apart=3, most=2)
    assert [p for p in pairs if p[0] == 25] == [(25, 9), (25, 17)]
    assert [
        p
        for p in loops.choose_loop_pairs(xy, np.ones(len(xy), bool), radius_m=2.0, apart=3, most=9)
        if p[0] == 25
    ] == [
        (25, 1),
        (25, 9),
        (25, 17),
    ]


def test_standing_still_links_to_none_too_near_in_time():
    still = np.zeros((12, 2))
    assert all(
        source - target > 4
        for source, target in loops.choose_loop_pairs(
            still, np.ones(len(still), bool), radius_m=1.0, apart=4, most=3
        )
    )
    assert loops.choose_loop_pairs(still[:4], np.ones(4, bool), radius_m=1.0, apart=4, most=3) == []


def test_stations_are_a_step_or_a_turn_apart():
    x_m = [0.0, 0.2, 0.4, 0.6, 0.6, 0.6, 0.6, 1.2]
    heading_deg = [0, 0, 0, 0, 20, 40, -20, -20]
    turn = Rotation.from_euler("z", np.array(heading_deg)[:, None], degrees=True).as_quat()
    pose = se3.pose_matrix(np.column_stack([x_m, np.zeros((8, 2))]), turn)
    assert np.flatnonzero(loops.choose_stations(pose, 0.5)).tolist() == [0, 3, 5, 6, 7]
    assert loops.choose_stations(pose, 0.0).all()


def test_stations_alone_are_linked_and_to_the_nearest_station():
    """There a scan a metre, back likewise: of the way there only x = 0, 4, 8 are stations."""
    is_station = np.r_[np.arange(10) % 4 == 0, np.ones(10, bool)]
    pairs = loops.choose_loop_pairs(there_and_back(), is_station, radius_m=1.2, apart=2, most=4)
    assert pairs == [
        (11, 8),
        (12, 8),
        (13, 6),
        (14, 4),
        (15, 4),
        (16, 4),
        (17, 2),
        (18, 0),
        (19, 0),
    ]


def test_a_scan_without_links_is_tried_with_the_near_ones_before():
    xy = np.column_stack([np.arange(8.0), np.zeros(8)])
    linked = [False, True, True, True, True, False, True, False]
    assert loops.choose_bridges(linked, xy, radius_m=2.5, apart=4) == [
        (5, 3),
        (5, 4),
        (7, 5),
        (7, 6),
    ]
    assert loops.choose_bridges(linked, xy, radius_m=9.0, apart=1) == [(5, 4), (7, 6)]


def test_standing_still_takes_no_memory_for_all_pairs():
    still = np.random.default_rng(0).normal(0, 0.1, (1500, 2))
    tracemalloc.start()
    loops.choose_loop_pairs(still, np.ones(len(still), bool), radius_m=5.0, apart=6, most=4)
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak_bytes < 1500**2


def align(pairs, places_m, most, fails=()):
    """Align pairs of scans at places on a line, of which some do not fit."""

    def constrain(source, target, kind, _settings, _min_fitness):
        pair = source.scan_id, target.scan_id
        return None if pair in fails else (kind, *pair)

    poses = np.tile(np.eye(4), (len(places_m), 1, 1))
    poses[:, 0, 3] = places_m
    rows = list(range(len(places_m)))
    clouds = [np.zeros((0, 3))] * len(rows)
    with (
        mock.patch.object(loops, "_constrain", constrain),
        mock.patch.object(loops.prepared_clouds, "prepare_cloud", lambda *_, **__: None),
        mock.patch.object(loops.constraints, "neighbour_reach_m", lambda _: 0.0),
    ):
        return loops.align_pairs(
            loops.PlacedClouds(clouds, rows, np.array(rows), poses),
            pairs,
            False,
            None,
            loops.LoopLimits(min_fitness=0.5, apart=2, most=most),
        )


def test_the_nearest_visits_that_align_are_linked_and_no_more():
    """Scan 9 has four visits, of which the nearest lies behind a wall; 8 and 9 are neighbours."""
    places_m = [0.0, 0.3, 9.0, 0.6, 9.0, 0.9, 9.0, 9.0, 1.0, 1.0]
    pairs = [(9, 0), (9, 1), (9, 3), (9, 5), (9, 8)]
    assert align(pairs, places_m, 1, fails=[(9, 5)]) == [("sequence", 9, 8), ("loop", 9, 3)]
    assert align(pairs, places_m, 2) == [("sequence", 9, 8), ("loop", 9, 5), ("loop", 9, 3)]
    assert align(pairs, places_m, 1, fails=[(9, row) for row in (0, 1, 3, 5)]) == [
        ("sequence", 9, 8)
    ]


@given(
    st.lists(
        st.lists(st.tuples(st.integers(0, 5), st.integers(0, 3)), min_size=1, max_size=8),
        min_size=1,
        max_size=12,
    ),
    st.sampled_from([0.0, 0.3, 0.5, 1.0]),
    st.integers(0, 4),
    st.integers(1, 4),
)
def test_planar_scans_are_paired_with_those_that_show_most_of_the_same(squares, least, apart, most):
    """Squares of a metre counted in sets, scans moved apart so that few show the same."""
    n = len(squares)
    pose = np.tile(np.eye(4), (n, 1, 1))
    pose[:, 0, 3] = np.arange(n)
    clouds = [np.array([(x + 0.2, y + 0.2, 0.0) for x, y in of]) for of in squares]
    expected = []
    for source in range(n):
        placed = [(x + source, y) for x, y in squares[source]]
        known = [{(x + target, y) for x, y in squares[target]} for target in range(n)]
        shares = {
            target: sum(square in known[target] for square in placed)
            for target in range(max(source - apart, 0))
        }
        eligible = [t for t in shares if shares[t] >= max(least * len(placed), 1)]
        visit = {
            t: sum(b - a > apart for a, b in itertools.pairwise(eligible[: i + 1]))
            for i, t in enumerate(eligible)
        }
        place = {
            t: sum(visit[u] == visit[t] and (-shares[u], u) < (-shares[t], t) for u in eligible)
            for t in eligible
        }
        enough = sorted(eligible, key=lambda t: (place[t], -shares[t], t))
        expected += [(source, target) for target in enough[:most]]
    rest = {"apart": apart, "least": least, "most": most}
    no_last = np.arange(n) < n - 1
    with mock.patch.object(loops, "_ROWS_AT_ONCE", 5):
        found = loops.choose_shared_views(clouds, pose, np.ones(n, bool), **rest)
        without = loops.choose_shared_views(clouds, pose, no_last, **rest)
    assert found == sorted(expected)
    assert without == [pair for pair in sorted(expected) if pair[0] != n - 1]
