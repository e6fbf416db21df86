import numpy as np
import pytest

import toyrooms
from scanplan import schemas, tables
from scanplan.errors import StageError
from scanplan.extraction import walls

LIMITS = walls.Limits(**{**toyrooms.LIMITS, "min_points": 5, "min_points_planar": 3})


def upright(y, z=(0.0, 0.5, 1.0), x=2.0):
    """Return points on the plane x = 2 at every y and z."""
    return np.array([(x, a, b) for a in y for b in z], float)


def test_segments_end_where_points_pause():
    points = upright(np.r_[np.arange(0, 1.01, 0.25), np.arange(1.9, 3.0, 0.25)])
    rows = walls.cut(np.array([1.0, 0.0]), 2.0, points, LIMITS, planar=False)
    found = walls.assemble(rows, (10, 20, 30))
    # the sensor is to the left of the way from start to end: the wall x = 2 is walked along with rising y
    assert found.start_m == pytest.approx(np.array([(12, 20), (12, 21.9)]))
    assert found.end_m == pytest.approx(np.array([(12, 21), (12, 22.9)]))
    assert found.normal == pytest.approx(np.array([(-1, 0), (-1, 0)]))
    assert found.n_points.tolist() == [15, 15]
    assert found.rmse_m == pytest.approx([0, 0], abs=1e-12)
    assert found.z_range_m == pytest.approx(np.array([(30, 31), (30, 31)]))


def test_the_wall_above_a_door_does_not_close_it():
    jambs = upright(np.r_[np.arange(0, 1.01, 0.25), np.arange(1.9, 3.0, 0.25)])
    lintel = upright(np.arange(0, 3.0, 0.25), z=(2.2, 2.4))
    rows = walls.cut(np.array([1.0, 0.0]), 2.0, np.vstack([jambs, lintel]), LIMITS, planar=False, top_m=1.9)
    found = walls.assemble(rows, (0, 0, 0))
    assert found.start_m[:, 1] == pytest.approx([0, 1.9]) and found.end_m[:, 1] == pytest.approx([1, 2.9])
    assert (found.z_range_m[:, 1] > 2.1).all()


def test_the_top_of_doors_is_measured_from_the_floor():
    floor = np.column_stack([np.zeros((300, 2)), np.full(300, -0.4)])
    points = np.vstack([floor, upright(np.arange(0, 3, 0.1), z=(0, 1, 2))])
    assert walls.door_top(points, LIMITS, planar=False) == pytest.approx(1.5)
    assert walls.door_top(points, LIMITS, planar=True) == np.inf


def test_a_gap_of_just_the_limit_is_none():
    points = upright([0, 0.5, 1.0, 1.5])
    assert len(walls.cut(np.array([1.0, 0]), 2.0, points, LIMITS, planar=False)) == 1


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
    assert walls.cut(np.array([1.0, 0]), 2.0, points, LIMITS, planar=False) == [], why


def test_a_planar_wall_needs_no_height():
    points = upright([0, 0.3, 0.6], z=(0.7,))
    assert len(walls.cut(np.array([1.0, 0]), 2.0, points, LIMITS, planar=True)) == 1


@pytest.mark.parametrize("sign", [1, -1])
def test_the_normal_points_to_the_sensor_whatever_the_lines_sense(sign):
    row = walls.cut(sign * np.array([1.0, 0]), sign * 2.0, upright([0, 1 / 2, 1]), LIMITS, planar=False)[0]
    assert row[4:6] == pytest.approx((-1, 0))
    assert row[:4] == pytest.approx((2, 0, 2, 1))


def test_spare_points_prolong_within_reach_and_no_farther():
    spare = upright([-0.06, 1.03, 1.06, 1.09, 1.12, 1.3], z=(0.5,))
    rows = walls.cut(
        np.array([1.0, 0]), 2.0, upright([0, 0.5, 1]), LIMITS, planar=False, spare_xyz_m=spare, reach_rad=0.05
    )
    # reach at the end: 0.05 hypot(2, 1) = 0.112 m; at the start 0.1 m, but the first step there is more than half
    assert rows[0][:4] == pytest.approx((2, 0, 2, 1.09))
    assert rows[0][6] == 12


def test_order_of_segments_and_of_points_depend_on_the_points_alone():
    points = np.random.default_rng(1).normal(size=(50, 3)).round(1)
    shuffled = np.random.default_rng(2).permutation(points)
    assert (walls.around_sensor(points, (1, 2, 3)) == walls.around_sensor(shuffled, (1, 2, 3))).all()
    rows = [(5, 0, 6, 0, 0, 1, 9, 0, 0, 1), (1, 0, 2, 0, 0, 1, 9, 0, 0, 1), (7, 0, 8, 0, 0, 1, 12, 0, 0, 1)]
    assert walls.assemble(rows, (0, 0, 0)).start_m[:, 0].tolist() == [7, 1, 5]
    assert walls.assemble(rows[::-1], (0, 0, 0)).start_m[:, 0].tolist() == [7, 1, 5]


@pytest.mark.parametrize(
    ("xyz_m", "sensor"),
    [
        ([(0, 0, np.nan)], (0, 0, 0)),
        ([(0, np.inf, 0)], (0, 0, 0)),
        ([(0, 0, 0)], (0, np.nan, 0)),
        ([(0, 0)], (0, 0, 0)),
        ([(0, 0, 0)], (0, 0)),
    ],
)
def test_points_must_be_finite_and_in_space(xyz_m, sensor):
    with pytest.raises(ValueError, match=r"finite|points"):
        walls.around_sensor(xyz_m, sensor)


def test_table_of_scans_with_and_without_walls(tmp_path):
    one = walls.assemble([(1, 0, 2, 0, 0, 1, 9, 0.01, 0, 1), (3, 0, 4, 0, 0, 1, 5, 0.01, 0, 1)], (0, 0, 0))
    none = walls.assemble([], (0, 0, 0))
    columns = walls.table([4, 7, 9], [one, none, one])
    assert columns["scan_id"].tolist() == [4, 4, 9, 9]
    assert columns["wall"].tolist() == [0, 1, 0, 1]
    tables.write(tmp_path / "walls.parquet", schemas.WALLS, columns)
    assert tables.read(tmp_path / "walls.parquet", schemas.WALLS)["x0_m"].tolist() == [1, 3, 1, 3]


def test_table_without_any_wall(tmp_path):
    columns = walls.table([4], [walls.assemble([], (0, 0, 0))])
    tables.write(tmp_path / "walls.parquet", schemas.WALLS, columns, allow_empty=True)
    assert len(tables.read(tmp_path / "walls.parquet", schemas.WALLS, allow_empty=True)["wall"]) == 0
    assert walls.summary(columns, 1, 12.0) == "1 scans, 0 walls, no wall at all, 12 ms a scan"


def test_every_scan_needs_a_pose():
    registered = {"scan_id": np.array([0, 5]), **{c: np.array([1.0, np.nan]) for c in ("x_m", "y_m", "z_m")}}
    assert walls.sensor_positions(registered, [0], "r.parquet")[0]["sensor_xyz_m"].tolist() == [1, 1, 1]
    with pytest.raises(StageError, match=r"r\.parquet.*first scan 5"):
        walls.sensor_positions(registered, [0, 5], "r.parquet")
