"""The truth of a box, written down by hand."""

import json

import numpy as np
import pytest
from shapely.geometry import shape

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import truth


def lengths(plan, side, slice_height_m=0.4):
    return sorted(
        round(line.length, 6)
        for line, s in truth.true_wall_faces(plan, slice_height_m)
        if s == side
    )


def of_kind(drawn_features, kind):
    return [(g, values) for g, values in drawn_features if values["kind"] == kind]


def test_box_has_four_faces_inside_and_four_outside():
    assert lengths(drawn.plan(), "inside") == [3, 3, 4, 4]
    assert lengths(drawn.plan(), "outside") == [3.4, 3.4, 4.4, 4.4]


def test_door_splits_its_wall_and_has_jambs_window_above_the_slice_does_not():
    door, window = drawn.door(1.5, -0.1), drawn.door(2, 3.1, type="window", sill_m=0.9)
    plan = drawn.plan(door, window)
    assert lengths(plan, "inside") == [0.2, 0.2, 1, 2, 3, 3, 4]
    assert lengths(plan, "outside") == [1.2, 2.2, 3.4, 3.4, 4.4]
    assert lengths(plan, "inside", 1.5) == [0.2, 0.2, 0.2, 0.2, 1, 1.5, 1.5, 2, 3, 3]


@pytest.mark.parametrize("start", range(4))
def test_a_joint_in_the_drawing_is_no_end_of_a_face(start):
    corners = [[-0.1, -0.1], [2, -0.1], [4.1, -0.1], [4.1, 3.1], [2, 3.1], [-0.1, 3.1]]
    corners = corners[start:] + corners[:start]
    apart = [drawn.wall(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    assert lengths(drawn.plan(walls=apart), "inside") == [3, 3, 4, 4]


def test_the_wall_is_on_the_left_of_its_faces():
    for line, side in truth.true_wall_faces(drawn.plan(), 0.4):
        (x0, y0), (x1, y1) = line.coords
        x, y = (x0 + x1) / 2, (y0 + y1) / 2
        left = np.array([y0 - y1, x1 - x0]) / line.length
        to_middle = np.array([2 - x, 1.5 - y])
        assert (left @ to_middle > 0) == (side == "outside")


def test_walls_openings_and_rooms():
    plan = drawn.plan(drawn.wall((2, 0), (2, 3)), drawn.door(2, 1), way=drawn.way((3, 1), (3, 2)))
    found = truth.truth_features(plan, 0.4)
    walls, ((opening, values),) = of_kind(found, "wall"), of_kind(found, "opening")
    assert [round(g.length, 6) for g, _ in walls] == [4.2, 3.2, 4.2, 3.2, 3.0]
    assert {v["thickness_m"] for _, v in walls} == {0.2}
    assert sorted(opening.coords) == [(2, 0.5), (2, 1.5)]
    assert values == {
        "kind": "opening",
        "type": "door",
        "width_m": 1.0,
        "sill_m": 0.0,
        "lintel_m": 2.0,
    }
    rooms = {room.centroid.x > 2: values for room, values in of_kind(found, "room")}
    assert [rooms[east]["area_m2"] for east in (False, True)] == pytest.approx([5.7, 5.7])
    assert [rooms[east]["visited"] for east in (False, True)] == [False, True]


def test_geojson_gives_the_shapes_back():
    found = truth.truth_features(drawn.plan(drawn.door(2, -0.1)), 0.4)
    read = json.loads(truth.format_features(found))
    assert read["type"] == "FeatureCollection" and len(read["features"]) == len(found)
    for feature, (geometry, values) in zip(read["features"], found, strict=True):
        assert feature["properties"] == values
        assert shape(feature["geometry"]).hausdorff_distance(geometry) < 1e-6


def test_a_cupboard_against_the_wall_is_a_screen_without_its_back():
    corners = [[1.0, 2.5], [2.0, 2.5], [2.0, 3.0], [1.0, 3.0], [1.0, 2.5]]
    cupboard = drawn.feature("furniture", "Polygon", [corners], height_m=2.0)
    screens = [
        line for line, _ in of_kind(truth.truth_features(drawn.plan(cupboard), 0.4), "screen")
    ]
    assert sorted(round(line.length, 3) for line in screens) == [0.5, 0.5, 1.0]


@pytest.mark.parametrize(("planar", "n_sides"), [(False, 0), (True, 3)])
def test_a_desk_is_a_screen_to_a_planar_scanner_alone(planar, n_sides):
    corners = [[1.0, 2.5], [2.0, 2.5], [2.0, 3.0], [1.0, 3.0], [1.0, 2.5]]
    desk = drawn.feature("furniture", "Polygon", [corners], height_m=0.7)
    features = truth.truth_features(drawn.plan(desk), 0.4, planar=planar)
    assert len(of_kind(features, "screen")) == n_sides
