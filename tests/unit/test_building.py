"""The same room as a drawing, a mesh and a building model: the same truth."""

from pathlib import Path

import numpy as np
import open3d as o3d
import pytest
import shapely

from helpers import box_making, ifc_making
from helpers import simple_rooms as drawn
from helpers.refusals import refused
from scanplan.design import ifc_file
from scanplan.errors import StageError
from scanplan.lab.buildings import building, extrusion

IFC = ifc_making.model()
ROOM = box_making.room()
DOOR = drawn.door(2, -0.1)


def mesh_of(triangles_m, **values):
    return building.load_building(
        box_making.written(triangles_m, "stl"),
        Path("room.stl"),
        slice_height_m=0.4,
        reading=building.FileReading(**values),
    )


def model_of(data=IFC, **values):
    reading = building.FileReading(**values)
    return building.load_building(data, Path("room.ifc"), slice_height_m=0.4, reading=reading)


def of_kind(found, kind):
    return [(g, values) for g, values in found.truth if values["kind"] == kind]


def lengths(found, side):
    return sorted(
        round(line.length, 4) for line, values in of_kind(found, "face") if values["side"] == side
    )


def off_the_mesh(found, slice_height_m=0.4):
    """The greatest distance of the truth's faces from the mesh, sampled every 5 cm."""
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(
        o3d.core.Tensor(found.mesh.vertices_m.astype(np.float32)),
        o3d.core.Tensor(found.mesh.triangles.astype(np.uint32)),
    )
    xy = np.concatenate(
        [shapely.get_coordinates(g.segmentize(0.05)) for g, _ in of_kind(found, "face")]
    )
    points = np.column_stack([xy, np.full(len(xy), slice_height_m)]).astype(np.float32)
    return float(scene.compute_distance(o3d.core.Tensor(points)).numpy().max())


def test_the_truth_of_a_mesh_is_that_of_the_drawing():
    drawing = building.load_building(
        drawn.text(drawn.WALLS, drawn.WAY, DOOR).encode(), Path("a.geojson"), slice_height_m=0.4
    )
    mesh = mesh_of(ROOM)
    assert lengths(mesh, "inside") == lengths(drawing, "inside") == [0.2, 0.2, 1.5, 1.5, 3, 3, 4]
    assert lengths(mesh, "outside") == lengths(drawing, "outside") == [1.7, 1.7, 3.4, 3.4, 4.4]
    ((room, values),) = of_kind(mesh, "room")
    assert values["area_m2"] == pytest.approx(12, abs=0.05)
    assert room.symmetric_difference(shapely.box(0, 0, 4, 3)).area < 0.05
    walls = of_kind(mesh, "wall")
    assert sorted(round(g.length, 3) for g, _ in walls) == [1.5, 1.5, 3, 3, 4]
    assert {values["thickness_m"] for _, values in walls} == {0.2}
    assert off_the_mesh(mesh) < 1e-4


def test_units_floors_and_turned_faces_change_nothing():
    turned = ROOM.copy()
    turned[::3] = turned[::3, ::-1]
    moved = (turned + np.array([0, 0, 7.0])) * 1000
    for found in (mesh_of(turned), mesh_of(moved, unit="mm", floor_z_m=7.0)):
        assert lengths(found, "inside") == [0.2, 0.2, 1.5, 1.5, 3, 3, 4]
        assert found.floor_m.area == pytest.approx(4.4 * 3.4, abs=0.02)


def test_a_mesh_without_floor_is_driven_on_all_the_same():
    found = mesh_of(ROOM[:-24])
    assert "no floor" in found.notes[-1]
    assert found.floor_m.area == pytest.approx(4.4 * 3.4, abs=0.02)


def test_a_room_drawn_as_one_shell_is_a_room():
    shell = box_making.box(0, 0, 0, 4, 3, 2.5)
    found = mesh_of(shell)
    assert lengths(found, "inside") == [3, 3, 4, 4] and lengths(found, "outside") == []
    assert [round(room.area, 1) for _, room in found.rooms] == [12.0]


def test_the_faces_of_a_model_are_those_on_paper():
    found = model_of()
    # the door is open at the slice, the window's parapet is not
    assert lengths(found, "inside") == [0.2, 0.2, 1.0, 2.1, 3, 3, 4]
    assert lengths(found, "outside") == [1.2, 2.3, 3.4, 3.4, 4.4]
    assert off_the_mesh(found) < 1e-4
    walls = of_kind(found, "wall")
    assert sorted(round(g.length, 4) for g, _ in walls) == [3, 3, 4.4, 4.4]
    assert {values["thickness_m"] for _, values in walls} == {0.2}
    ((room, values),) = of_kind(found, "room")
    assert (
        values["name"] == "1 Living"
        and room.symmetric_difference(shapely.box(0, 0, 4, 3)).area < 1e-3
    )
    openings = {v["type"]: (g, v) for g, v in of_kind(found, "opening")}
    line, values = openings["door"]
    assert sorted(line.coords) == [pytest.approx((1.0, -0.1)), pytest.approx((1.9, -0.1))]
    assert (values["width_m"], values["sill_m"], values["lintel_m"]) == pytest.approx(
        (0.9, 0.0, 2.0)
    )
    _, values = openings["window"]
    assert (values["width_m"], values["sill_m"], values["lintel_m"]) == pytest.approx(
        (1.0, 0.9, 2.0)
    )


def test_doors_and_windows_by_choice():
    def kinds(**values):
        return {extrusion.SURFACES[i] for i in np.unique(model_of(**values).mesh.surface)}

    assert kinds() == {"wall", "floor", "furniture", "glass"}
    assert kinds(doors="closed", windows="empty") == {"wall", "floor", "furniture", "door"}
    door = shapely.box(1.0, -0.2, 1.9, 0.0)
    assert not model_of().obstacles_m.buffer(-0.01).intersects(door.buffer(-0.05))
    assert model_of(doors="closed").obstacles_m.intersects(door)


def test_the_upper_storey_is_moved_to_zero():
    model = ifc_file.parse_ifc(ifc_making.model(("Ground", "Upper")), "made.ifc")
    upper = building.building_of_model(model, 1, 0.4, "made.ifc")
    assert lengths(upper, "inside") == [0.2, 0.2, 1.0, 2.1, 3, 3, 4]
    assert len(of_kind(upper, "opening")) == 2 and len(upper.rooms) == 1


def test_a_sensor_above_its_storey_is_refused():
    model = ifc_file.parse_ifc(ifc_making.model(("Ground", "Upper")), "made.ifc")
    with refused(file="made.ifc", value="3.5 m", key="simulate.mount"):
        building.building_of_model(model, 0, 3.5, "made.ifc")


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"floor_z_m": 5.0},
            r"neither its floor at 0 nor the sensor at 0\.4 m may be outside; set simulate",
        ),
        ({"floor_z_m": 2.4}, "simulate.site.floor_z_m"),
    ],
)
def test_a_floor_beside_the_mesh_is_refused(values, message):
    with pytest.raises(StageError, match=message):
        mesh_of(ROOM, **values)


def test_other_files_and_choices_are_refused():
    with pytest.raises(StageError, match=r"accepted are \.geojson"):
        building.load_building(b"x", Path("room.dwg"), slice_height_m=0.4)
    with pytest.raises(ValueError, match="ajar"):
        model_of(doors="ajar")
