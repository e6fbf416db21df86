"""Leaves hung at random in the doors of a box of two rooms, and of a building model."""

from pathlib import Path

import numpy as np
import pytest
import shapely

from helpers import ifc_making
from helpers import simple_rooms as drawn
from scanplan.lab.buildings import building, building_route, random_leaves
from scanplan.lab.simulation import survey_setup

WALL = drawn.wall((0, 1.5), (4, 1.5))
DOORS = (drawn.door(1.0, 1.5, width_m=0.9), drawn.door(3.0, 1.5, width_m=0.9))
WINDOW = drawn.door(2.0, -0.1, type="window", sill_m=0.9)


def load(*features):
    text = drawn.text(drawn.WALLS, WALL, WINDOW, *features).encode()
    return building.load_building(text, Path("box.geojson"), slice_height_m=0.4)


def hang(site, seed, share=1.0, **values):
    return random_leaves.hang_leaves(site, share=share, seed=seed, slice_height_m=0.4, **values)


def leaves_of(site):
    return [(line, values) for line, values in site.truth if values["kind"] == "leaf"]


def test_a_share_of_none_changes_nothing():
    site = load(*DOORS)
    assert hang(site, 1, share=0.0) is site


def test_leaves_are_told_stand_in_the_way_and_in_the_mesh():
    site = load(*DOORS)
    hung = hang(site, 1)
    assert [values["opening"] for _, values in leaves_of(hung)] == [1, 2]
    for line, values in leaves_of(hung):
        assert values["width_m"] == pytest.approx(0.89)
        assert hung.obstacles_m.buffer(1e-6).covers(line)
    # each a box of twelve triangles, four screens
    assert len(hung.mesh.triangles) - len(site.mesh.triangles) == 2 * 12
    screens = [line for line, values in hung.truth if values["kind"] == "screen"]
    assert len(screens) == 8 and hung.doorways == ()


def test_angles_are_shut_ajar_open_or_on_the_wall_in_their_shares():
    angles = [
        values["open_deg"]
        for seed in range(60)
        for _, values in leaves_of(hang(load(*DOORS), seed))
    ]
    shares = {
        "shut": np.mean([a == 0 for a in angles]),
        "ajar": np.mean([5 <= a <= 30 for a in angles]),
        "open": np.mean([70 <= a <= 95 for a in angles]),
        "wall": np.mean([a == 180 for a in angles]),
    }
    assert sum(shares.values()) == pytest.approx(1.0)
    # 120 of them: two standard deviations of a share are 0.09 at most
    assert shares == pytest.approx({"shut": 0.3, "ajar": 0.15, "open": 0.4, "wall": 0.15}, abs=0.09)


def test_the_seed_decides_and_a_door_is_drawn_whatever_others_there_are():
    one, again, other = (hang(load(*DOORS), seed).truth for seed in (1, 1, 2))
    assert one == again != other
    ((_, alone),) = leaves_of(hang(load(DOORS[0]), 1))
    assert leaves_of(hang(load(*DOORS), 1))[0][1] == alone


def test_doors_that_have_a_leaf_keep_it():
    hung = hang(load(DOORS[0], drawn.door(3.0, 1.5, width_m=0.9, leaf="hinged", open_deg=90)), 1)
    assert sorted(values["opening"] for _, values in leaves_of(hung)) == [1, 2]
    assert [v["open_deg"] for _, v in leaves_of(hung) if v["opening"] == 2] == [90.0]


@pytest.mark.parametrize("seed", range(8))
def test_a_given_way_is_left_free_and_a_planned_one_goes_around(seed):
    way_m = [[1.0, 0.7], [1.0, 2.3], [1.6, 2.4]]
    site = load(*DOORS)
    hung = hang(site, seed, track=random_leaves.widen_track(way_m))
    building_route.check_way(way_m, hung.floor_m, hung.obstacles_m, "box")
    loose = hang(site, seed)
    planned = building_route.plan_building_route(
        loose, "box.geojson", building_route.WaySettings("rooms", 0.25), seed=seed
    )
    assert shapely.LineString(planned.waypoints_m).distance(loose.obstacles_m) > 0.23


def test_a_room_behind_a_shut_door_is_not_visited():
    shut = drawn.door(1.0, 1.5, width_m=0.9, leaf="hinged", frame_m=0.05)
    for doors, n_visited in (((shut,), 1), ((shut, DOORS[1]), 2)):
        site = building_route.plan_building_route(
            load(*doors), "box.geojson", building_route.WaySettings("rooms", 0.25)
        )
        rooms = [values for _, values in site.truth if values["kind"] == "room"]
        assert sum(values["visited"] for values in rooms) == n_visited


def test_a_leaf_stands_in_no_cupboard():
    cupboards = [
        drawn.feature(
            "furniture",
            "Polygon",
            [[[0, y], [4, y], [4, y + 0.5], [0, y + 0.5], [0, y]]],
            height_m=2.0,
        )
        for y in (0.75, 1.75)
    ]
    site = load(*DOORS, *cupboards)
    for seed in range(6):
        for _, values in leaves_of(hang(site, seed)):
            assert values["open_deg"] < 30 or values["open_deg"] == 180


def test_doors_of_a_model_get_leaves_of_their_own_size():
    def prepare(**values):
        site = {"route": "rooms", "waypoints_m": None, "start_m": None, "clearance_m": 0.25}
        site |= {"chairs": 0, "doors_ajar": 0.0, **values}
        settings = {"site": site, "mount": {"height_m": 0.4, "forward_m": 0.0}}
        return survey_setup.prepare_site(ifc_making.model(), Path("made.ifc"), settings, seed=3)

    without, hung = prepare(), prepare(leaves=1.0)
    ((line, values),) = leaves_of(hung)
    openings = [(g, v) for g, v in hung.truth if v["kind"] == "opening"]
    door, said = openings[values["opening"]]
    assert said["type"] == "door"
    assert values["width_m"] == pytest.approx(said["width_m"] - 0.01)
    assert values["height_m"] == pytest.approx(said["lintel_m"] - 0.005)
    assert line.distance(door) < 0.2
    assert leaves_of(without) == []
    shut = prepare(leaves=1.0, doors="closed")
    assert leaves_of(shut) == [] and "no door" in " ".join(shut.notes)
