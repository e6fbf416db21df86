"""Ways through a box of 4 m by 3 m: given, planned, refused."""

from pathlib import Path

import numpy as np
import pytest
import shapely

from helpers import simple_rooms as drawn
from helpers.refusals import assert_told, refused
from scanplan.errors import StageError
from scanplan.lab.buildings import building, building_route

FLOOR = shapely.box(0, 0, 6, 4)
PILLAR = shapely.box(2, 1, 3, 2)


def load(*features):
    text = drawn.text(drawn.WALLS, *features).encode()
    return building.load_building(text, Path("box.geojson"), slice_height_m=0.4)


WITH_WAY = load(drawn.WAY)
WITHOUT_WAY = load()


def plan(site, route, *, seed=0, reach_m=0.0, **values):
    settings = building_route.WaySettings(route, clearance_m=0.3, **values)
    return building_route.plan_building_route(site, "box", settings, reach_m=reach_m, seed=seed)


def test_a_planned_way_marks_what_it_visits():
    driven = plan(WITHOUT_WAY, "rooms")
    assert [v["visited"] for _, v in driven.truth if v["kind"] == "room"] == [True]
    assert shapely.LineString(driven.waypoints_m).distance(driven.obstacles_m) >= 0.3
    assert_told(*driven.notes, file="box", value="1 of 1 rooms")


def test_a_given_way_is_kept_unless_another_is_asked_for():
    np.testing.assert_array_equal(plan(WITH_WAY, "given").waypoints_m, [[1, 1], [3, 1], [3, 2]])
    assert len(plan(WITH_WAY, "rooms").waypoints_m) >= 2
    with refused(value=("hallway", "1 rooms")):
        plan(WITH_WAY, "hallways")
    with pytest.raises(ValueError, match="by heart"):
        plan(WITH_WAY, "by heart")


def test_waypoints_of_the_settings_come_before_the_files():
    mine = [[1.0, 2.0], [3.0, 2.0]]
    given = plan(WITH_WAY, "given", waypoints_m=mine)
    np.testing.assert_array_equal(given.waypoints_m, mine)
    refusal = r"^simulate\.site\.waypoints_m: in box: waypoint 1 .* outside the outer walls"
    with pytest.raises(StageError, match=refusal):
        plan(WITH_WAY, "given", waypoints_m=[[1.0, 2.0], [9.0, 2.0]])
    for values in ({"route": "rooms"}, {"route": "given", "start_m": [1.0, 1.0]}):
        with refused(key="simulate.site.waypoints_m"):
            plan(WITH_WAY, **values, waypoints_m=mine)


def test_a_planned_way_begins_where_asked_or_by_the_seed():
    here = plan(WITHOUT_WAY, "rooms", start_m=[3.0, 1.0])
    np.testing.assert_allclose(here.waypoints_m[0], [3.0, 1.0], atol=0.05)
    drawn_starts = [
        plan(WITHOUT_WAY, route, start_m="random", seed=seed).waypoints_m[0]
        for route, seed in (("rooms", 1), ("given", 1), ("rooms", 2))
    ]
    np.testing.assert_array_equal(drawn_starts[0], drawn_starts[1])
    assert np.linalg.norm(drawn_starts[0] - drawn_starts[2]) > 0.05
    with pytest.raises(StageError, match="lies within"):
        plan(WITHOUT_WAY, "rooms", start_m=[0.05, 0.05])


def test_a_start_of_a_given_way_is_refused():
    refusal = r"simulate\.site\.start_m: random is where a planned way begins"
    with pytest.raises(StageError, match=refusal):
        plan(WITH_WAY, "given", start_m="random")


def test_a_free_way_passes():
    building_route.check_way([[1, 0.5], [5, 0.5], [5, 3]], FLOOR, PILLAR, "plan")


@pytest.mark.parametrize(
    ("way", "reach_m", "message"),
    [
        ([[2.5, 1.5], [5, 0.5]], 0.0, r"plan: waypoint 0 \(2.5, 1.5\) lies inside a wall"),
        ([[1, 0.5], [7, 0.5]], 0.0, r"waypoint 1 \(7, 0.5\) lies outside"),
        ([[1, 1.5], [5, 1.5]], 0.0, r"from waypoint 0 to 1 passes a wall or furniture at 0.00 m"),
        ([[1, 0.8], [5, 0.8]], 0.0, r"at 0.20 m near .* the rover needs 0.23 m"),
        ([[1, 0.5], [5, 0.5]], 0.6, r"at 0.50 m near .* the rover needs 0.60 m"),
    ],
)
def test_a_blocked_way_is_refused(way, reach_m, message):
    with pytest.raises(StageError, match=message):
        building_route.check_way(way, FLOOR, PILLAR, "plan", reach_m=reach_m)
