"""The plan as a project of openPlan3D: what its reader asks of one, and where things are."""

import json
import math

import numpy as np
import pytest
import shapely
import shapely.affinity

from helpers import floorplan_making
from scanplan.exports.data import element_ids, openplan
from scanplan.exports.data.openplan_walls import draw_walls, list_around

DOORS = ("single", "double", "sliding", "french", "pocket", "bifold", "opening", "garage")
WINDOWS = ("standard", "fixed", "casement", "sliding", "bay")


def floor_of(plan):
    text = openplan.format_openplan(plan, element_ids.ids_from_places(plan))
    assert text == openplan.format_openplan(plan, element_ids.ids_from_places(plan))
    project = json.loads(text, parse_constant=lambda word: pytest.fail(word))
    assert project["activeFloorId"] == project["floors"][0]["id"]
    return project["floors"][0]


@pytest.fixture
def plan():
    return floorplan_making.plan(furniture=floorplan_making.furniture(), floor_z_m=0.0,
                                 ceiling_z_m=2.5)  # fmt: skip


def test_walls_are_solid_around_their_middle_in_centimetres_y_downwards(plan):
    walls = floor_of(plan)["walls"]
    assert [wall["thickness"] for wall in walls] == [20, 10, 20, 20, 20, 10]
    assert {wall["height"] for wall in walls} == {250}
    # seen from the west alone, at 7.1 m: the assumed 0.1 m lie behind
    assert (walls[1]["start"]["x"], walls[1]["end"]["x"]) == (715, 715)
    # ends are where lines cross: of the south wall at the middles of those across
    assert walls[0]["start"] == {"x": 715, "y": 10} and walls[0]["end"] == {"x": -10, "y": 10}


def test_openings_are_where_they_are_along_their_walls(plan):
    floor = floor_of(plan)
    by_id = {wall["id"]: wall for wall in floor["walls"]}
    places = []
    for item in [*floor["doors"], *floor["windows"]]:
        wall = by_id[item["wallId"]]
        x, y = (
            wall["start"][axis] + item["position"] * (wall["end"][axis] - wall["start"][axis])
            for axis in "xy"
        )
        places.append([round(x, 1), round(y, 1), item["width"], item["height"]])
    # a door's height is from the floor, a window's from its sill
    assert places == [[-10, -150, 100, 200], [405, -145, 90, 200], [160, 10, 120, 120]]
    assert floor["windows"][0]["sillHeight"] == 90


def test_it_is_what_the_editor_reads(plan):
    floor = floor_of(plan)
    keys = set()
    for table in ("walls", "doors", "windows", "rooms", "furniture", "stairs", "columns"):
        for item in floor[table]:
            assert item["id"].strip() and item["id"] not in keys
            keys.add(item["id"])
    walls = {wall["id"] for wall in floor["walls"]}
    for door in floor["doors"]:
        assert door["wallId"] in walls and door["type"] in DOORS and 0 <= door["position"] <= 1
        assert door["swingDirection"] in ("left", "right") and isinstance(door["flipSide"], bool)
    for window in floor["windows"]:
        assert window["type"] in WINDOWS and window["sillHeight"] >= 0
    for room in floor["rooms"]:
        assert set(room["walls"]) <= walls and room["area"] > 0
    assert [piece["catalogId"] for piece in floor["furniture"]] == ["imported_object"]


def test_a_room_is_known_by_the_walls_that_enclose_it(plan):
    ids = list("abcdef")
    assert list_around(draw_walls(plan, ids), plan.areas) == [list("adef"), list("abcf")]
    # without the wall between them neither is half of what is enclosed
    other = list_around(draw_walls(plan, ids)[:5], np.array([shapely.box(9, 9, 10, 10)], object))
    assert other == [[]]


def test_a_curved_wall_is_in_pieces_that_keep_its_radius():
    walls = floorplan_making.walls([((5, 0, 0, 5), 0.2, 0, 1, "observed")])
    walls |= {"arc_x_m": np.zeros(1), "arc_y_m": np.zeros(1), "arc_radius_m": np.full(1, 5.0)}
    plan = floorplan_making.plan(walls=walls, openings=floorplan_making.openings([]))
    pieces = draw_walls(plan, ["w"])
    assert [piece.key for piece in pieces] == ["w", "w~1", "w~2"]
    for piece in pieces:
        t = np.linspace(0, 1, 21)[:, None]
        start, end = piece.line_m
        curve = (1 - t) ** 2 * start + 2 * t * (1 - t) * piece.control_m + t**2 * end
        assert np.hypot(*curve.T) == pytest.approx(np.full(21, 5.0), abs=5 * 0.00061)
    assert pieces[0].line_m[0].tolist() == [5, 0] and pieces[2].line_m[1].tolist() == [0, 5]


def test_a_column_is_round_or_square(plan):
    disc = shapely.Point(2, 2).buffer(0.2)
    things = floorplan_making.furniture([shapely.box(1, 1, 1.3, 1.3), disc], "column")
    columns = floor_of(floorplan_making.plan(furniture=things))["columns"]
    assert [column["shape"] for column in columns] == ["square", "round"]
    assert [column["diameter"] for column in columns] == pytest.approx([30, 40], abs=1)
    assert columns[0]["position"] == {"x": 115, "y": -115}


def test_furniture_is_turned_as_it_stands():
    piece = shapely.affinity.rotate(shapely.box(0, 0, 2, 0.5), 30, origin=(0, 0))
    things = floorplan_making.furniture([piece])
    (item,) = floor_of(floorplan_making.plan(furniture=things))["furniture"]
    # clockwise, as y runs downwards there
    assert item["rotation"] % 180 == pytest.approx(-30 % 180, abs=0.01)
    assert (item["width"], item["depth"]) == pytest.approx((200, 50), abs=0.01)
    assert item["position"]["x"] == pytest.approx(100 * math.cos(math.radians(30)) - 12.5, abs=0.1)


def test_a_room_that_walls_do_not_close_is_a_text():
    walls = floorplan_making.walls(floorplan_making.WALLS[:5])
    openings = floorplan_making.openings([floorplan_making.OPENINGS[0]])
    floor = floor_of(floorplan_making.plan(walls=walls, openings=openings))
    # both rooms are one to the editor: it is the larger one
    assert [room["name"] for room in floor["rooms"]] == ["Room 0"]
    assert [text["text"] for text in floor["textAnnotations"]] == ["Room 1"]
    bare = floor_of(floorplan_making.plan(walls=floorplan_making.walls(floorplan_making.WALLS[:2]),
                                          openings=floorplan_making.openings([])))  # fmt: skip
    assert bare["rooms"] == [] and [t["text"] for t in bare["textAnnotations"]] == [
        "Room 0",
        "Room 1",
    ]
