"""Meshes that are good, odd and broken."""

import numpy as np
import pytest

from helpers import box_making
from helpers.refusals import assert_told, refused
from scanplan.errors import StageError
from scanplan.lab.buildings import mesh_file

BOX = box_making.box(0, 0, 0, 4, 3, 2.5)
STL = box_making.written(BOX, "stl")


def area(triangles):
    a, b, c = np.moveaxis(triangles, 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.mark.parametrize("file_type", ["stl", "stl_ascii", "obj", "ply"])
def test_a_box_is_the_same_in_all_formats(file_type):
    triangles_m, notes = mesh_file.parse_mesh(
        box_making.written(BOX, file_type), f".{file_type[:3]}", "box"
    )
    assert triangles_m.shape == (12, 3, 3) and notes == ()
    assert area(triangles_m) == pytest.approx(2 * (12 + 10 + 7.5))
    np.testing.assert_allclose(np.ptp(triangles_m.reshape(-1, 3), axis=0), [4, 3, 2.5], atol=1e-6)


def test_a_binary_stl_may_begin_with_solid():
    assert len(mesh_file.parse_mesh(b"solid box".ljust(80) + STL[80:], ".stl", "box")[0]) == 12


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1000), ("cm", 100), ("in", 1 / 0.0254)])
def test_another_unit_is_told_and_taken_when_stated(unit, factor):
    data = box_making.written(BOX * factor, "stl")
    with refused(file="box.stl", remedy=f"simulate.site.unit: {unit}"):
        mesh_file.parse_mesh(data, ".stl", "box.stl")
    taken = mesh_file.parse_mesh(data, ".stl", "b", unit=unit)[0]
    np.testing.assert_allclose(np.sort(taken, 0), np.sort(BOX, 0), atol=1e-5)


def test_a_tower_is_not_taken_for_inches():
    with refused(key="simulate.site.unit", remedy="cut out"):
        mesh_file.parse_mesh(box_making.written(BOX * [10, 10, 40], "stl"), ".stl", "tower.stl")


@pytest.mark.parametrize(("factor", "unit"), [(0.001, "m"), (1.0, "mm"), (1e6, "mm")])
def test_no_building_is_of_that_size(factor, unit):
    with pytest.raises(StageError, match=r"spans .* m.*simulate\.site\.unit"):
        mesh_file.parse_mesh(box_making.written(BOX * factor, "stl"), ".stl", "box.stl", unit=unit)


def test_faces_without_area_are_dropped_and_counted():
    flat = np.array([[[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[1, 1, 1]] * 3], float)
    triangles_m, notes = mesh_file.parse_mesh(
        box_making.written(np.concatenate([BOX, flat]), "stl"), ".stl", "box.stl"
    )
    assert len(triangles_m) == 12
    assert_told(notes[0], file="box.stl", value="2 of 14 faces")
    with refused(value="2 faces"):
        mesh_file.parse_mesh(box_making.written(flat * 3, "stl"), ".stl", "flat.stl")


def test_holes_are_allowed_and_told():
    triangles_m, notes = mesh_file.parse_mesh(box_making.written(BOX[1:], "ply"), ".ply", "box.ply")
    assert len(triangles_m) == 11
    assert_told(*notes, file="box.ply", value="3 open edges")


@pytest.mark.parametrize(
    ("data", "suffix", "message"),
    [
        (b"", ".stl", r"is empty \(0 bytes\)"),
        (
            STL[:-20],
            ".stl",
            r"has 664 bytes, its header announces 12 faces \(684 bytes\); the binary STL is cut",
        ),
        (STL[:30], ".stl", "cut off or no STL"),
        (box_making.written(BOX, "stl_ascii")[:-200], ".stl", "has no `endsolid`"),
        (b"solid empty\nendsolid empty\n", ".stl", "holds no faces"),
        (box_making.written(BOX, "ply")[:-30], ".ply", "cannot be read as PLY"),
        (b"ply\nformat", ".ply", "cannot be read as PLY"),
        (b"v 0 0 0\nv 1 0 0\nf 1 2 9\n", ".obj", "box: "),
        (b"\x00\x01\x02" * 50, ".obj", "box: "),
        (b"no mesh", ".obj", "box: "),
    ],
)
def test_what_is_no_mesh_is_refused_in_one_line(data, suffix, message):
    with pytest.raises(StageError, match=message) as refusal:
        mesh_file.parse_mesh(data, suffix, "box")
    assert "\n" not in str(refusal.value)


def test_a_unit_is_a_known_one():
    with pytest.raises(ValueError, match="furlong"):
        mesh_file.parse_mesh(STL, ".stl", "box", unit="furlong")
