"""Volumes and areas of extruded floors: wrong for any missing, doubled or turned triangle."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import drawn_floor, extrusion


def volume(triangles_m):
    """Enclosed volume by the divergence theorem: positive for normals outwards."""
    a, b, c = np.moveaxis(triangles_m, 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def area(triangles_m):
    a, b, c = np.moveaxis(triangles_m, 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def corners(mesh, surface):
    chosen = mesh.surface == extrusion.SURFACES.index(surface)
    return mesh.vertices_m[mesh.triangles[chosen]]


def test_unit_cube():
    cube = extrusion.extrude_bands([(0.0, 1.0, shapely.box(0, 0, 1, 1))])
    assert (len(cube), volume(cube), area(cube)) == (12, pytest.approx(1), pytest.approx(6))


def test_a_step_has_its_tread():
    steps = extrusion.extrude_bands(
        [(0.0, 1.0, shapely.box(0, 0, 2, 1)), (1.0, 2.0, shapely.box(0, 0, 1, 1))]
    )
    assert volume(steps) == pytest.approx(3)
    assert area(steps) == pytest.approx(2 + 1 + 1 + 2 * 3 + 2 + 1 + 1)


def test_box_with_a_door_loses_the_door_and_gains_its_reveal():
    closed, opened = (
        corners(extrusion.make_building_mesh(drawn.plan(*d)), "wall")
        for d in ((), (drawn.door(2, -0.1),))
    )
    assert volume(closed) == pytest.approx(2.96 * 2.5)
    assert volume(closed) - volume(opened) == pytest.approx(1.0 * 0.2 * 2.0)
    # two faces of 1 x 2 and the foot go, two jambs of 0.2 x 2 and the lintel's underside come
    assert area(closed) - area(opened) == pytest.approx(2 * 2.0 + 0.2 - (2 * 0.4 + 0.2))


def test_floor_looks_up_and_ceiling_down_over_the_whole_footprint():
    mesh = extrusion.make_building_mesh(drawn.plan())
    floor, ceiling = corners(mesh, "floor"), corners(mesh, "ceiling")
    assert area(floor) == area(ceiling) == pytest.approx(4.4 * 3.4)
    assert (np.cross(floor[:, 1] - floor[:, 0], floor[:, 2] - floor[:, 0])[:, 2] > 0).all()
    assert (np.cross(ceiling[:, 1] - ceiling[:, 0], ceiling[:, 2] - ceiling[:, 0])[:, 2] < 0).all()
    assert (np.unique(floor[..., 2]), np.unique(ceiling[..., 2])) == (0.0, 2.5)


def test_only_what_is_glazed_has_a_pane_and_its_wall_is_open_all_the_same():
    empty, glazed = (
        extrusion.make_building_mesh(drawn.plan(drawn.door(2, -0.1, sill_m=0.5, glazed=glazed)))
        for glazed in (False, True)
    )
    assert len(corners(empty, "glass")) == 0
    # 1 m wide, 1.5 m high, 2 cm thick
    assert volume(corners(glazed, "glass")) == pytest.approx(1.0 * 1.5 * 0.02)
    assert volume(corners(glazed, "wall")) == pytest.approx(volume(corners(empty, "wall")))


def test_furniture_is_closed():
    box = drawn.feature(
        "furniture", "Polygon", [[[1, 2], [2, 2], [2, 2.5], [1, 2.5], [1, 2]]], height_m=0.8
    )
    furniture = corners(extrusion.make_building_mesh(drawn.plan(box)), "furniture")
    assert volume(furniture) == pytest.approx(1 * 0.5 * 0.8)


@given(
    st.lists(
        st.tuples(*[st.integers(0, 20)] * 2, *[st.integers(1, 8)] * 2), min_size=1, max_size=6
    ),
    st.integers(1, 5),
)
def test_volume_is_area_times_height_for_any_stack(boxes, split):
    shapes = [shapely.box(x, y, x + w, y + h) for x, y, w, h in boxes]
    low, high = shapely.union_all(shapes[:split]), shapely.union_all(shapes[split - 1 :])
    stack = extrusion.extrude_bands([(0.0, 0.7, low), (0.7, 2.0, high)])
    assert volume(stack) == pytest.approx(0.7 * low.area + 1.3 * high.area, abs=1e-6)


def test_the_demo_is_closed(project_root):
    from scanplan.lab.buildings import drawing_file

    text = (project_root / "config/buildings/demo_office.geojson").read_bytes()
    plan = drawing_file.parse_drawing(text, "demo")
    expected = sum(
        (high - low) * section.area for low, high, section in drawn_floor.cut_wall_bands(plan)
    )
    assert volume(corners(extrusion.make_building_mesh(plan), "wall")) == pytest.approx(
        expected, abs=1e-6
    )
    assert len(drawn_floor.floor_rooms(plan)) == 13
