"""A robot reads which door leads from which room to which."""

import json

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.floorplan_making import ROOMS, bare, plan
from scanplan.exports.data import element_ids, element_tables, room_graph


def read(drawn, nominal_m=None):
    ids = element_ids.ids_from_places(drawn)
    rows = element_tables.tabulate_elements(drawn, ids, nominal_m)
    return json.loads(room_graph.format_room_graph(drawn, rows))


def test_doors_join_rooms_and_windows_do_not():
    graph = read(plan())["graph"]
    assert graph == {
        "0": [{"opening": 0, "to": None}, {"opening": 1, "to": 1}],
        "1": [{"opening": 1, "to": 0}],
    }


def test_wheelchairs_reach_rooms_through_ways_of_90_cm():
    # the entrance is 1 m wide, the door between the rooms 0.9 m
    found = read(plan())["wheelchair"]
    joined = {"least_width_m": 0.9, "groups": [[0, 1]], "from_outside": [0, 1]}
    assert found == {**joined, "to_tape": []}
    narrow = floorplan_making.openings()
    narrow["width_m"][1] = 0.89
    found = read(plan(openings=narrow))["wheelchair"]
    # of 12 and of 9 square metres
    assert found["groups"] == [[0], [1]] and found["from_outside"] == [0]
    # doors are seen too narrow, by up to 5 cm
    assert found["to_tape"] == [1]
    narrow["width_m"][1] = 0.84
    assert read(plan(openings=narrow))["wheelchair"]["to_tape"] == []
    assert read(bare())["wheelchair"]["groups"] == []


def test_wheelchairs_pass_doors_by_their_nominal_width():
    narrow = floorplan_making.openings()
    narrow["width_m"][:] = [0.87, 0.88, 1.0]
    made = read(plan(openings=narrow), {1: 0.9})
    assert [(way["width_m"], way["nominal_width_m"]) for way in made["ways"]] == [
        *((0.87, None), (0.88, 0.9))
    ]
    joined = {"groups": [[0, 1]], "from_outside": [], "to_tape": [0, 1]}
    assert made["wheelchair"] == {"least_width_m": 0.9, **joined}


def test_a_door_of_a_narrower_size_is_no_way_for_wheelchairs():
    narrow = floorplan_making.openings()
    narrow["width_m"][1] = 0.9
    assert read(plan(openings=narrow), {1: 0.89})["wheelchair"]["groups"] == [[0], [1]]


def test_a_way_has_a_place_in_either_room():
    _, between = read(plan())["ways"]
    left, right = (shapely.Point(place) for place in between["through_m"])
    assert ROOMS[0].contains(left) and ROOMS[1].contains(right)
    assert between["width_m"] == 0.9 and between["rooms"] == [0, 1]
    assert between["ends_m"] == [[4.05, 1.0], [4.05, 1.9]]


def test_a_place_in_a_shallow_room_is_in_it():
    """The second room is half a metre deep behind a door of 0.9 m; a third lies behind it."""
    rooms = [ROOMS[0], shapely.box(4.1, 0, 4.6, 3), shapely.box(4.7, 0, 7.1, 3)]
    drawn = plan(rooms=floorplan_making.rooms(rooms))
    _, between = read(drawn)["ways"]
    left, right = (shapely.Point(place) for place in between["through_m"])
    assert rooms[0].contains(left) and rooms[1].contains(right)


def test_the_places_stand_in_the_order_of_the_rooms():
    openings = floorplan_making.openings()
    turned = {"room_a": openings["room_b"], "room_b": openings["room_a"]}
    _, between = read(plan(openings=openings | turned))["ways"]
    assert between["rooms"] == [1, 0]
    first, _ = between["through_m"]
    assert ROOMS[1].contains(shapely.Point(first))


def test_rooms_have_their_outlines_and_a_place_inside():
    rooms = read(plan())["rooms"]
    assert [room["name"] for room in rooms] == ["Room 0", "Room 1"]
    for room, area in zip(rooms, ROOMS, strict=True):
        ((outline,),) = room["outlines_m"]
        assert shapely.Polygon(outline).equals(area)
        assert area.contains(shapely.Point(room["place_m"]))


def test_doubt_is_told_where_the_tables_have_it():
    openings = floorplan_making.openings() | {
        "p_true": np.array([0.9, 0.3, 0.8]),
        "verify": np.array([False, True, False]),
        "doubt": np.array(["", "few rays", ""], object),
    }
    way = read(plan(openings=openings))["ways"][1]
    assert (way["p_true"], way["verify"], way["doubt"]) == (0.3, True, "few rays")
    assert "verify" not in read(plan())["ways"][0]


def test_faces_alone_make_an_empty_graph():
    empty = read(bare())
    assert empty["rooms"] == empty["ways"] == [] and empty["graph"] == {}


@pytest.mark.parametrize("name", ['"}', "line\nbreak", "<script>"])
def test_names_stay_words(name):
    drawn = plan(name=name)
    drawn.rooms["name"] = np.array([name, ""], object)
    content = read(drawn)
    assert content["name"] == content["rooms"][0]["name"] == name
