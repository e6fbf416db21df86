"""Chairs and ajar doors in a box of 4 m by 3 m."""

from pathlib import Path

import pytest
import shapely

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import building, clutter
from scanplan.lab.buildings.building_route import ROVER_RADIUS_M


def load():
    text = drawn.text(drawn.WALLS, drawn.WAY).encode()
    return building.load_building(text, Path("box.geojson"), slice_height_m=0.3)


def test_nothing_asked_changes_nothing():
    site = load()
    assert clutter.add_clutter(site, chairs=0, doors_ajar=0.0, seed=1) is site


def test_chairs_stand_on_free_floor_clear_of_the_way():
    site = load()
    furnished = clutter.add_clutter(site, chairs=3, doors_ajar=0.0, seed=1)
    added = furnished.obstacles_m.difference(site.obstacles_m.buffer(1e-6))
    legs = shapely.get_parts(added)
    assert len(legs) == 12
    assert added.area == pytest.approx(12 * 0.03**2, rel=0.01)
    way = shapely.LineString(site.waypoints_m)
    assert added.distance(way) > ROVER_RADIUS_M
    assert site.floor_m.contains(added)
    n_more = len(furnished.mesh.triangles) - len(site.mesh.triangles)
    assert n_more > 0
    assert furnished.mesh.vertices_m[furnished.mesh.triangles[-1]].shape == (3, 3)


def test_the_seed_decides_where_they_stand():
    places = [
        clutter.add_clutter(load(), chairs=3, doors_ajar=0.0, seed=seed).obstacles_m.wkb
        for seed in (1, 1, 2)
    ]
    assert places[0] == places[1] != places[2]
