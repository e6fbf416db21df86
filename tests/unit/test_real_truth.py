"""The drawings of real floors are sound, and rough lines move onto the returns beside them."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shapely

from benchmarks.truth.draw import find_recesses
from benchmarks.truth.fitting import (
    Returns,
    find_supported,
    fit_edge,
    fit_ring,
    near_edge,
    parse_corners,
)

FOLDER = Path(__file__).parents[1] / "benchmarks" / "truth"
FLOORS = ("seattle", "mac_first_floor", "csail", "aces")
LINES = {"surface", "unseen", "opening", "recess", "leaf", "rail"}
AREAS = {"room", "ignore", "furniture", "column"}
ROUNDED_M = 0.002
THIN_M = 0.03  # rooms on both sides of a thin wall may overlap by what each side is off
JAMB_M = 0.35  # between an end of an opening and the nearest wall that is drawn


@cache
def read_drawing(floor):
    """Return (properties, geometry) of the features of a floor's drawing."""
    collection = json.loads((FOLDER / f"{floor}.geojson").read_text(encoding="utf-8"))
    return [
        (one["properties"], shapely.geometry.shape(one["geometry"]))
        for one in collection["features"]
    ]


def shapes_of(floor, kind):
    return [shape for properties, shape in read_drawing(floor) if properties["kind"] == kind]


def returns_at(xy_m, from_m):
    xy_m = np.asarray(xy_m, float)
    return Returns(xy_m, np.broadcast_to(np.asarray(from_m, float), xy_m.shape), xy_m[:1])


@pytest.fixture(params=FLOORS)
def floor(request):
    return request.param


def test_features_have_known_kinds_and_fitting_geometry(floor):
    for properties, shape in read_drawing(floor):
        assert properties["kind"] in LINES | AREAS
        is_line = properties["kind"] in LINES
        assert shape.geom_type == ("LineString" if is_line else "Polygon")
        assert shape.is_valid and not shape.is_empty


def test_coordinates_are_millimetres(floor):
    for _, shape in read_drawing(floor):
        xy_m = shapely.get_coordinates(shape)
        np.testing.assert_allclose(xy_m, np.round(xy_m, 3), atol=1e-9)


def test_rooms_have_names_of_their_own_and_say_whether_they_were_entered(floor):
    rooms = [properties for properties, _ in read_drawing(floor) if properties["kind"] == "room"]
    assert len({room["name"] for room in rooms}) == len(rooms) > 0
    assert all(isinstance(room["entered"], bool) for room in rooms)


def test_rooms_overlap_by_no_more_than_a_few_centimetres(floor):
    rooms = shapes_of(floor, "room")
    for i, room in enumerate(rooms):
        for other in rooms[:i]:
            assert room.intersection(other).buffer(-THIN_M / 2).is_empty


def test_openings_lie_between_walls_that_are_drawn(floor):
    kinds = ("surface", "unseen")
    walls = shapely.union_all([shape for kind in kinds for shape in shapes_of(floor, kind)])
    rims = [room.exterior for room in shapes_of(floor, "room")]
    outlines = shapely.union_all([walls, *rims])
    for properties, shape in read_drawing(floor):
        if properties["kind"] == "opening":
            assert properties["type"] in ("door", "passage")
            assert 0.6 < shape.length < 3.2
            for end in (shape.coords[0], shape.coords[-1]):
                assert outlines.distance(shapely.Point(end)) < JAMB_M


def test_surfaces_lie_on_their_room_or_are_a_corridors(floor):
    rooms = {
        properties["name"]: shape.exterior
        for properties, shape in read_drawing(floor)
        if properties["kind"] == "room"
    }
    for properties, shape in read_drawing(floor):
        if properties["kind"] in ("surface", "unseen", "recess") and properties["of"] in rooms:
            assert rooms[properties["of"]].hausdorff_distance(shape) > 0
            assert shape.within(rooms[properties["of"]].buffer(ROUNDED_M))
        elif properties["kind"] in ("surface", "unseen", "recess"):
            assert properties["of"] == "corridor"


def test_no_surface_lies_in_an_opening_or_where_nothing_counts(floor):
    surfaces = shapely.union_all(shapes_of(floor, "surface"))
    openings = shapely.union_all(shapes_of(floor, "opening"))
    for shape in [*shapes_of(floor, "ignore"), openings.buffer(0.02)]:
        assert surfaces.intersection(shape.buffer(-ROUNDED_M)).length < 0.01


def test_an_edge_moves_onto_the_returns_seen_from_its_left():
    s_m = np.linspace(0, 4, 81)
    wall = np.column_stack([s_m, 0.05 + 0.01 * s_m])
    edge = fit_edge(returns_at(wall, (2, 3)), np.array([0.0, 0.0]), np.array([4.0, 0.0]))
    assert edge.n_returns > 70
    assert edge.along == pytest.approx(np.array([1, 0.01]) / np.hypot(1, 0.01), abs=1e-6)
    assert edge.point_m == pytest.approx([0, 0.05], abs=1e-6)


def test_returns_seen_from_behind_do_not_move_an_edge():
    wall = np.column_stack([np.linspace(0, 4, 81), np.full(81, 0.05)])
    edge = fit_edge(returns_at(wall, (2, -3)), np.array([0.0, 0.0]), np.array([4.0, 0.0]))
    assert edge.n_returns == 0
    assert edge.point_m == pytest.approx([0, 0])


def test_a_few_stray_returns_leave_an_edge_on_its_wall():
    s_m = np.linspace(0, 4, 81)
    wall = np.column_stack([s_m, np.where(np.arange(81) % 10 == 0, 0.09, 0.0)])
    edge = fit_edge(returns_at(wall, (2, 3)), np.array([0.0, 0.0]), np.array([4.0, 0.0]))
    assert abs(edge.point_m[1]) < 0.004


def test_a_rough_ring_becomes_the_square_of_its_returns():
    s_m = np.linspace(0, 3, 61)
    low, high = np.zeros(61), np.full(61, 3.0)
    sides = [(s_m, low), (high, s_m), (s_m, high), (low, s_m)]
    walls = np.concatenate([np.column_stack(side) for side in sides])
    rough = parse_corners("0.05 0.06, -0.04 2.95, 3.03 3.05, 2.96 -0.05")
    fitted = fit_ring(returns_at(walls, (1.5, 1.5)), rough)
    for corner in ((0, 0), (3, 0), (3, 3), (0, 3)):
        assert np.hypot(*(fitted - corner).T).min() < 0.01


def test_only_what_returns_stand_on_is_supported():
    wall = np.column_stack([np.r_[np.linspace(0, 1, 41), np.linspace(2, 3, 41)], np.zeros(82)])
    stretches = find_supported(returns_at(wall, (1.5, 2)), parse_corners("0 0, 3 0"))
    assert np.array(stretches) == pytest.approx(np.array([(0, 1), (2, 3)]), abs=0.06)


def test_places_along_an_edge_are_measured_from_its_start():
    s_m, e_m = near_edge(
        returns_at([(1, 0.02)], (1, 2)), np.array([0.0, 0.0]), np.array([2.0, 0.0]), 0.1
    )
    assert s_m == pytest.approx([1])
    assert e_m == pytest.approx([0.02])


def test_a_shallow_recess_as_wide_as_a_door_is_one():
    corners = "0 0, 2 0, 2 -0.1, 3 -0.1, 3 0, 5 0"
    (bottom,) = find_recesses(parse_corners(corners))
    assert list(bottom.coords) == [(2, -0.1), (3, -0.1)]
    assert find_recesses(parse_corners("0 0, 2 0, 2 0.1, 3 0.1, 3 0, 5 0")) == []
