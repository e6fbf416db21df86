import numpy as np
import pytest

from helpers import toy_rooms
from helpers.refusals import assert_told
from scanplan.extraction import segments
from scanplan.store import schemas, tables

LIMITS = segments.SegmentLimits(**{**toy_rooms.LIMITS, "min_points": 5, "min_points_planar": 3})


def upright(y, z=(0.0, 0.5, 1.0), x=2.0):
    """Return points on the plane x = 2 at every y and z."""
    return np.array([(x, a, b) for a in y for b in z], float)


def cut(points, *, spare=None, others=(), normal=(1.0, 0.0), offset_m=2.0):
    """Cut the line x = 2 in a scan of these points, of spare ones on the line, and of others."""
    parts = [p for p in (points, spare, others) if p is not None and len(p)]
    scan = segments.view_scan(np.vstack([*parts, np.empty((0, 3))]), planar=False)
    further = None if spare is None else segments.SparePoints(spare)
    return segments.cut_line(np.array(normal), offset_m, points, LIMITS, scan=scan, spare=further)


def test_segments_end_where_points_pause():
    points = upright(np.r_[np.arange(0, 1.01, 0.25), np.arange(1.9, 3.0, 0.25)])
    found = segments.collect_segments(cut(points), (10, 20, 30))
    # the sensor is to the left of the way from start to end: the wall x = 2 is walked along with
    # rising y
    assert found.start_m == pytest.approx(np.array([(12, 20), (12, 21.9)]))
    assert found.end_m == pytest.approx(np.array([(12, 21), (12, 22.9)]))
    assert found.normal == pytest.approx(np.array([(-1, 0), (-1, 0)]))
    assert found.n_points.tolist() == [15, 15]
    assert found.rmse_m == pytest.approx([0, 0], abs=1e-12)
    assert found.z_range_m == pytest.approx(np.array([(30, 31), (30, 31)]))


JAMBS = upright(np.r_[np.arange(0, 1.01, 0.25), np.arange(2, 3.01, 0.25)])
LINTEL = upright(np.arange(0, 3.01, 0.125), z=(2.2, 2.4))


def ends(rows):
    return [(round(r[1], 3), round(r[3], 3)) for r in rows]


def test_the_wall_above_a_door_does_not_close_it():
    # rays that cross the line at y = 1.5 and 0.8 m end at x = 4
    through = np.array([(4.0, 3.0, 1.6)] * 3)
    rows = cut(np.vstack([JAMBS, LINTEL]), others=through)
    assert ends(rows) == [(0, 1), (2, 3)]
    assert (segments.collect_segments(rows, (0, 0, 0)).z_range_m[:, 1] > 2.1).all()


def test_the_wall_above_a_cabinet_is_one():
    # rays end at x = 1 that would have crossed the line between y = 1 and 2, at 0.8 m
    cabinet = np.array([(1.0, y / 2, 0.4) for y in np.arange(1.05, 2, 0.1)])
    assert ends(cut(np.vstack([JAMBS, LINTEL]), others=cabinet)) == [(0, 3)]


def test_where_no_ray_goes_the_wall_above_tells_nothing():
    assert ends(cut(np.vstack([JAMBS, LINTEL]))) == [(0, 1), (2, 3)]


def test_the_reveal_of_a_door_seen_along_shows_that_it_is_open():
    """Rays along the wall meet the far reveal 0.1 m behind it, at y = 2.

    They cross it at y = 1.9.
    """
    cabinet = np.array([(1.0, y / 2, 0.4) for y in np.arange(1.05, 2, 0.1)])
    reveal = np.array([(2.1, 1.99, 0.6)] * 3)
    assert ends(cut(np.vstack([JAMBS, LINTEL]), others=np.vstack([cabinet, reveal])))[-1] == (2, 3)


def test_a_low_sill_makes_no_wall_where_rays_pass_over_it():
    sill = upright(np.arange(0, 3.01, 0.125), z=(0.0, 0.3))
    over = np.array([(4.0, 2 * y, 1.6) for y in np.arange(1.02, 2, 0.04)])
    assert ends(cut(np.vstack([JAMBS, sill]), others=over)) == [(0, 1), (2, 3)]
    assert ends(cut(np.vstack([JAMBS, sill]))) == [(0, 3)]
    high = upright(np.arange(0, 3.01, 0.125), z=(0.0, 0.7))
    assert ends(cut(np.vstack([JAMBS, high]), others=over)) == [(0, 3)]


def test_a_gap_of_just_the_limit_is_none():
    assert len(cut(upright([0, 0.5, 1.0, 1.5]))) == 1


@pytest.mark.parametrize(
    ("points", "why"),
    [
        (upright([0, 0.3]), "short"),
        (upright([0, 0.3, 0.6], z=(0.0, 0.4)), "low"),
        (upright([0, 0.45], z=(0.0, 1.0)), "few points"),
        (np.empty((0, 3)), "nothing"),
    ],
)
def test_what_is_no_wall(points, why):
    assert cut(points, others=upright([0, 0.3, 0.6], x=5.0)) == [], why


def test_a_planar_wall_needs_no_height():
    points = upright([0, 0.3, 0.6], z=(0.7,))
    assert len(segments.cut_line(np.array([1.0, 0]), 2.0, points, LIMITS)) == 1


@pytest.mark.parametrize("sign", [1, -1])
def test_the_normal_points_to_the_sensor_whatever_the_lines_sense(sign):
    (row,) = cut(upright([0, 1 / 2, 1]), normal=(sign * 1.0, 0), offset_m=sign * 2.0)
    assert row[4:6] == pytest.approx((-1, 0))
    assert row[:4] == pytest.approx((2, 0, 2, 1))


def test_in_the_plane_spare_points_prolong_within_reach_and_no_farther():
    spare = upright([-0.06, 1.03, 1.06, 1.09, 1.12, 1.3], z=(0.5,))
    points = upright([0, 0.5, 1])
    spare = segments.SparePoints(spare, reach_rad=0.05)
    rows = segments.cut_line(np.array([1.0, 0]), 2.0, points, LIMITS, spare=spare)
    # reach at the end: 0.05 hypot(2, 1) = 0.112 m; at the start 0.1 m, but the first step there is
    # more than half
    assert rows[0][:4] == pytest.approx((2, 0, 2, 1.09))
    assert rows[0][6] == 12


def test_in_space_spare_points_prolong_up_to_a_pause_and_to_an_opening():
    spare = upright([1.2, 1.4, 1.6, 2.0], z=(0.5,))
    assert ends(cut(upright([0, 0.5, 1]), spare=spare)) == [(0, 1.6)]
    through = np.array([(4.0, 3.04, 1.2)])
    assert ends(cut(upright([0, 0.5, 1]), spare=spare, others=through)) == [(0, 1.4)]
    assert cut(upright([0]), spare=spare) == []


def test_order_of_segments_depends_on_the_segments_alone():
    rows = [
        (5, 0, 6, 0, 0, 1, 9, 0, 0, 1),
        (1, 0, 2, 0, 0, 1, 9, 0, 0, 1),
        (7, 0, 8, 0, 0, 1, 12, 0, 0, 1),
    ]
    assert segments.collect_segments(rows, (0, 0, 0)).start_m[:, 0].tolist() == [7, 1, 5]
    assert segments.collect_segments(rows[::-1], (0, 0, 0)).start_m[:, 0].tolist() == [7, 1, 5]


def test_table_of_scans_with_and_without_walls(tmp_path):
    one = segments.collect_segments(
        [(1, 0, 2, 0, 0, 1, 9, 0.01, 0, 1), (3, 0, 4, 0, 0, 1, 5, 0.01, 0, 1)], (0, 0, 0)
    )
    none = segments.collect_segments([], (0, 0, 0))
    columns = segments.segment_columns([4, 7, 9], [one, none, one])
    assert columns["scan_id"].tolist() == [4, 4, 9, 9]
    assert columns["wall"].tolist() == [0, 1, 0, 1]
    tables.write_table(tmp_path / "walls.parquet", schemas.WALLS, columns)
    assert tables.read_table(tmp_path / "walls.parquet", schemas.WALLS)["x0_m"].tolist() == [
        1,
        3,
        1,
        3,
    ]


def test_table_without_any_wall(tmp_path):
    columns = segments.segment_columns([4], [segments.collect_segments([], (0, 0, 0))])
    tables.write_table(tmp_path / "walls.parquet", schemas.WALLS, columns, allow_empty=True)
    assert (
        len(tables.read_table(tmp_path / "walls.parquet", schemas.WALLS, allow_empty=True)["wall"])
        == 0
    )
    told = segments.summarise_segments(columns, 1, 12.0)
    assert_told(told, value=("1 scans", "0 walls", "12 ms a scan"))
