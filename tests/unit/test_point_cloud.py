"""laspy reads the points as they were, thinned to one a cube."""

import laspy
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.exports.data import point_cloud

SCANS = [
    (3, np.array([(0.01, 0.01, 0.0), (0.02, 0.03, 0.0), (1.0, -2.0, 0.5)], np.float32)),
    (8, np.array([(0.04, 0.04, 0.04), (5.0, 5.0, 5.0)], np.float32)),
]


def written(path, cell_m, rgb_of=lambda scan_id: None, **choices):
    scans = [(scan_id, xyz_m, rgb_of(scan_id)) for scan_id, xyz_m in SCANS]
    counts = point_cloud.write_laz(path, scans, cell_m, 10**18, **choices)
    return laspy.read(path), counts


def test_all_points_are_there_to_a_millimetre(tmp_path):
    cloud, counts = written(tmp_path / "cloud.laz", 0.0)
    assert counts == (5, 5)
    assert cloud.xyz == pytest.approx(np.concatenate([xyz for _, xyz in SCANS]), abs=5.1e-4)
    assert cloud["scan_id"].tolist() == [3, 3, 3, 8, 8]
    assert cloud.header.maxs == pytest.approx([5.0] * 3)
    assert str(cloud.header.creation_date) == "2001-09-09"


def test_the_first_point_of_each_cube_stays(tmp_path):
    cloud, counts = written(tmp_path / "cloud.laz", 0.05)
    assert counts == (5, 3)
    assert list(cloud.x) == [0.01, 1.0, 5.0] and cloud["scan_id"].tolist() == [3, 3, 8]


def test_points_keep_their_colours_and_are_black_without(tmp_path):
    rgb_of = {3: None, 8: np.array([(1, 2, 3), (4, 5, 65535)], np.uint16)}.get
    cloud, _ = written(tmp_path / "cloud.laz", 0.05, rgb_of, coloured=True)
    assert list(cloud.x) == [0.01, 1.0, 5.0]
    assert np.column_stack([cloud.red, cloud.green, cloud.blue]).tolist() == [
        [0, 0, 0],
        [0, 0, 0],
        [4, 5, 65535],
    ]
    plain, _ = written(tmp_path / "plain.laz", 0.05, rgb_of)
    assert "red" not in plain.point_format.dimension_names


def test_the_same_points_give_the_same_bytes(tmp_path):
    for name in ("once", "again"):
        written(tmp_path / f"{name}.laz", 0.05)
    assert (tmp_path / "once.laz").read_bytes() == (tmp_path / "again.laz").read_bytes()


scans_of_cells = st.lists(st.lists(st.integers(-3, 3), max_size=6), max_size=12)


@given(scans_of_cells)
def test_a_cube_counts_once_whatever_the_order(scans):
    cells = point_cloud._SeenCells(1.0)
    seen = set()
    for scan in scans:
        xyz_m = np.array([(x + 0.5, 0.5, -0.5) for x in scan], np.float32).reshape(-1, 3)
        expected = []
        for x in scan:
            expected.append(x not in seen)
            seen.add(x)
        assert cells.add(xyz_m).tolist() == expected
