"""Ways through floors small enough to know which rooms can be reached."""

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest
import shapely

from helpers import simple_rooms as drawn
from helpers.refusals import refused
from scanplan.lab.buildings import building, hallways, route

WIDE = [[-0.1, -0.1], [12.1, -0.1], [12.1, 6.1], [-0.1, 6.1], [-0.1, -0.1]]


OUTER = (drawn.wall(*WIDE),)


def floor(*features, walls=OUTER):
    return building.load_building(
        drawn.text(*walls, *features).encode(), Path("floor.geojson"), slice_height_m=0.4
    )


def planned(found, kind="rooms", clearance_m=0.3, **values):
    ground = route.Ground(found.floor_m, found.obstacles_m, found.rooms)
    return route.plan_route(ground, "floor.geojson", kind=kind, clearance_m=clearance_m, **values)


def corridor_floor(**values):
    """A corridor of 12 m x 1.8 m, two rooms on it: west with a door of 0.9 m, east as asked."""
    walls = [drawn.wall(*WIDE), drawn.wall((0, 1.9), (12, 1.9)), drawn.wall((6, 1.9), (6, 6))]
    names = [
        drawn.feature("room", "Point", p, name=n)
        for p, n in (((6, 1), "hall"), ((3, 4), "W"), ((9, 4), "E"))
    ]
    return floor(drawn.door(3, 1.9, width_m=0.9), drawn.door(9, 1.9, **values), *names, walls=walls)


def check(found, way_m, clearance_m):
    line = shapely.LineString(way_m)
    assert line.distance(found.obstacles_m) >= clearance_m
    assert found.floor_m.buffer(-clearance_m + 1e-9).covers(line)


def test_every_room_is_entered_and_walls_are_kept_off():
    found = corridor_floor(width_m=0.8)
    way = planned(found)
    check(found, way.waypoints_m, 0.3)
    assert sorted(way.reached) == ["E", "W", "hall"] and way.missed == ()
    line = shapely.LineString(way.waypoints_m)
    assert all(line.intersection(room.buffer(-0.5)).length > 0 for _, room in found.rooms)
    assert line.length < 40


@pytest.mark.parametrize("values", [{"width_m": 0.55}, {"sill_m": 0.3}])
def test_a_room_behind_a_narrow_door_or_a_step_is_missed(values):
    found = corridor_floor(**{"width_m": 0.9, **values})
    way = planned(found)
    check(found, way.waypoints_m, 0.3)
    assert way.missed == ("E",) and sorted(way.reached) == ["W", "hall"]


def test_hallways_are_driven_there_and_back_and_rooms_left_alone():
    found = corridor_floor()
    assert [name for name, _ in hallways.find_hallways(found.rooms)] == ["hall"]
    way = planned(found, "hallways")
    check(found, way.waypoints_m, 0.3)
    np.testing.assert_array_equal(way.waypoints_m[0], way.waypoints_m[-1])
    hall = next(room for name, room in found.rooms if name == "hall")
    assert hall.covers(shapely.LineString(way.waypoints_m))
    assert 16 < shapely.LineString(way.waypoints_m).length < 26


@pytest.mark.parametrize(
    ("room", "is_hall"),
    [
        (shapely.box(0, 0, 12, 1.8), True),
        (shapely.box(0, 0, 6, 1.8), False),
        (shapely.box(0, 0, 40, 4), False),
        (shapely.box(0, 0, 20, 20) - shapely.box(2.4, 2.4, 17.6, 17.6), True),
        (shapely.Point(0, 0).buffer(3), False),
    ],
)
def test_a_hallway_is_long_and_narrow(room, is_hall):
    assert bool(hallways.find_hallways([("", room)])) == is_hall


def test_furniture_is_driven_round():
    box = [[5, 1], [7, 1], [7, 5], [5, 5], [5, 1]]
    found = floor(drawn.feature("furniture", "Polygon", [box], height_m=0.8))
    way = planned(found, start_m=(1.0, 3.0))
    check(found, way.waypoints_m, 0.3)
    assert np.hypot(*(way.waypoints_m[0] - (1.0, 3.0))) < 0.1


def test_the_same_floor_gives_the_same_way():
    first, second = planned(corridor_floor()), planned(corridor_floor())
    np.testing.assert_array_equal(first.waypoints_m, second.waypoints_m)


@pytest.mark.parametrize("start_m", [(0.1, 3.0), (6.0, 6.1), (20.0, 3.0)])
def test_a_start_in_a_wall_is_refused(start_m):
    with refused(file="floor.geojson", value=f"({start_m[0]:g}", remedy="move it"):
        planned(floor(), start_m=start_m)


def test_a_floor_too_tight_for_the_rover_is_refused():
    with refused(value=("1 rooms", "3 m")):
        planned(floor(), clearance_m=3.0)
    with pytest.raises(ValueError, match="clearance"):
        planned(floor(), clearance_m=0.0)


def test_the_ring_office_is_like_the_thesis_and_all_of_it_is_reached(project_root):
    path = project_root / "config/buildings/ring_office.geojson"
    found = building.load_building(path.read_bytes(), path, slice_height_m=0.4)
    halls = hallways.find_hallways(found.rooms)
    assert [name for name, _ in halls] == ["hallway"] and 330 <= halls[0][1].area <= 370
    assert len(found.rooms) == 25 and all(name for name, _ in found.rooms)
    assert shapely.union_all([found.floor_m]).bounds == pytest.approx((0, 0, 45, 35), abs=1e-6)
    way = planned(found)
    check(found, way.waypoints_m, 0.3)
    assert way.missed == () and len(way.reached) == 25
    line = shapely.LineString(way.waypoints_m)
    assert all(line.intersection(room.buffer(-1.0)).length > 0 for _, room in found.rooms)
    ring = planned(found, "hallways").waypoints_m
    check(found, ring, 0.3)
    assert 95 < shapely.LineString(ring).length < 115


def test_the_ring_office_is_what_its_script_draws(project_root):
    folder = project_root / "config/buildings"
    spec = importlib.util.spec_from_file_location(
        "make_ring_office", folder / "make_ring_office.py"
    )
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    drawn_by_script = json.loads(json.dumps(script.drawing()))
    assert json.loads((folder / "ring_office.geojson").read_text())["features"] == drawn_by_script


@pytest.mark.parametrize(
    ("start_m", "reached"),
    [(None, "east"), ([1.0, 1.0], "west"), (np.array([1.0, 1.0]), "west"), ("random", "east")],
)
def test_ground_with_a_neck_too_narrow_for_the_grid_is_driven_in_part(start_m, reached):
    """Two rooms joined by a neck 0.63 m wide: with 0.3 m to either side 3 cm are left of it."""
    rooms = [("west", shapely.box(0, 0, 4, 4)), ("east", shapely.box(6, 0, 12, 4))]
    floor = shapely.union_all([shapely.box(4, 1.7, 6, 2.33), *(room for _, room in rooms)])
    here = route.Ground(floor, shapely.Polygon(), rooms)
    found = route.plan_route(here, "a", kind="rooms", clearance_m=0.3, start_m=start_m, seed=1)
    assert found.reached == (reached,) and len(found.missed) == 1


def test_places_are_joined_in_their_order_round_what_stands_between():
    floor = shapely.box(0, 0, 10, 4)
    wall = shapely.box(4.9, 1.5, 5.1, 4)
    places_m = np.array([[1.0, 3.0], [9.0, 3.0], [9.0, 3.0], [1.0, 3.0]])
    way_m = route.join_places(floor, wall, places_m, "drawn", clearance_m=0.3)
    np.testing.assert_allclose(way_m[[0, -1]], places_m[[0, -1]], atol=0.05)
    assert np.hypot(*(way_m - places_m[1]).T).min() < 0.05
    way = shapely.LineString(way_m)
    assert way.distance(wall) >= 0.3 - 1e-6
    # under the wall's lower end there and back, with 0.3 m to spare
    assert way.length >= 4 * np.hypot(4, 1.8) - 0.2


def test_without_free_floor_places_are_not_joined():
    places_m = np.array([[0.5, 0.5], [1.0, 0.5]])
    with refused(value="0.6 m"):
        route.join_places(
            shapely.box(0, 0, 1, 1), shapely.Point(9, 9), places_m, "drawn", clearance_m=0.6
        )
