"""Clouds in files that are tables, against Open3D, which read them before."""

import numpy as np
import pytest

from helpers.cloud_files import write_compressed_pcd, write_table
from helpers.refusals import refused
from scanplan.recordings import scan_folder, table_points

FORMS = [
    *(("a.pcd", form) for form in ("ascii", "binary")),
    *(("a.ply", form) for form in ("ascii", "binary_little_endian", "binary_big_endian")),
]


def make_rows(n_points, kind, time_kind):
    rng = np.random.default_rng(n_points)
    form = [("intensity", "u1"), *((axis, kind) for axis in "xyz"), ("t", time_kind)]
    rows = np.zeros(n_points, form)
    for axis in "xyz":
        rows[axis] = rng.normal(0, 10, n_points)
    rows["t"] = (rng.uniform(0, 2**31 - 1, n_points)).astype(time_kind)
    if n_points:
        rows["y"][0] = np.nan
    return rows


@pytest.mark.parametrize(("name", "form"), FORMS)
@pytest.mark.parametrize(("kind", "time_kind"), [("f4", "u4"), ("f8", "f8"), ("f4", "f4")])
@pytest.mark.parametrize("n_points", [7, 1, 0])
def test_points_and_times_are_what_open3d_reads(
    tmp_path, monkeypatch, name, form, kind, time_kind, n_points
):
    monkeypatch.setattr(table_points, "_BLOCK", 3)
    rows = make_rows(n_points, kind, time_kind)
    path = write_table(tmp_path / name, rows, form)
    xyz_m, times = table_points.read_whole(table_points.describe_table(path))
    np.testing.assert_array_equal(xyz_m, np.column_stack([rows[axis] for axis in "xyz"]))
    np.testing.assert_array_equal(times, rows["t"])
    assert times.dtype == rows["t"].dtype
    if n_points:
        other_m, others = scan_folder._read_by_open3d(path)
        np.testing.assert_array_equal(xyz_m.astype(np.float32), other_m.astype(np.float32))
        # a PLY's unsigned ones it skips, with a warning in the log
        if name == "a.pcd" or time_kind != "u4":
            np.testing.assert_array_equal(times, others)
            assert times.dtype == others.dtype


def test_a_cloud_of_text_is_damaged_where_a_line_is_no_point(tmp_path):
    path = write_table(tmp_path / "a.pcd", make_rows(5, "f4", "u4"), "ascii")
    path.write_text(path.read_text().replace("nan", "no"))
    with refused(file="a.pcd", value=("5 lines", "point 0")):
        scan_folder.read_cloud_file(path)


def test_what_is_no_table_is_left_to_open3d(tmp_path):
    packed = tmp_path / "a.pcd"
    write_compressed_pcd(packed, 2, 24, bytes(24))
    faces = tmp_path / "a.ply"
    faces.write_text(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nproperty list uchar int near\nend_header\n1 2 3 0\n"
    )
    assert table_points.describe_table(packed) is None
    assert table_points.describe_table(faces) is None


def test_points_without_coordinates_are_refused_by_name(tmp_path):
    rows = np.zeros(3, [("x", "f4"), ("y", "f4"), ("h", "f4")])
    path = write_table(tmp_path / "a.pcd", rows, "binary")
    with refused(file="a.pcd", value="x, y, h"):
        table_points.describe_table(path)
