"""Buildings drawn at random are ones that a rover can visit, and as unlike as they ought to be."""

import json

import pytest
import shapely

from benchmarks import drawn_buildings
from scanplan.lab.buildings import drawing_file, drawn_floor

SEEDS = range(12)


def parse(seed):
    return drawing_file.parse_drawing(drawn_buildings.draw_building(seed), f"{seed}.geojson")


@pytest.mark.parametrize("seed", SEEDS)
def test_every_room_can_be_reached_through_doors_and_nothing_stands_in_them(seed):
    floor = parse(seed)
    rooms = [room for _, room in drawn_floor.floor_rooms(floor)]
    ways = [o.line_m.buffer(0.5) for o in floor.openings if o.type != "window"]
    reached = shapely.union_all([*rooms, *ways])
    assert reached.geom_type == "Polygon"
    furniture = shapely.union_all([f.footprint_m for f in floor.furniture])
    assert all(way.intersection(furniture).area == 0 for way in ways)


def test_openings_do_not_overlap():
    for seed in SEEDS:
        lines = [o.line_m for o in parse(seed).openings]
        shared_m = sum(line.length for line in lines) - shapely.union_all(lines).length
        assert shared_m == pytest.approx(0, abs=1e-6)


def test_the_same_seed_draws_the_same_and_another_another():
    assert drawn_buildings.draw_building(4) == drawn_buildings.draw_building(4)
    assert drawn_buildings.draw_building(4) != drawn_buildings.draw_building(7)


def test_among_a_few_are_all_kinds_of_openings_with_and_without_panes():
    features = [
        feature["properties"]
        for seed in SEEDS
        for feature in json.loads(drawn_buildings.draw_building(seed))["features"]
    ]
    openings = [values for values in features if values["kind"] == "opening"]
    assert {o["type"] for o in openings} == {"door", "window", "passage"}
    panes = {(o["glazed"], o["sill_m"] > 0) for o in openings if o["type"] == "window"}
    assert panes == {(True, True), (True, False), (False, True)}


def test_the_pavilion_has_what_is_easily_drawn_wrongly(project_root):
    path = project_root / "config/buildings/pavilion.geojson"
    floor = drawing_file.parse_drawing(path.read_bytes(), path)
    free = shapely.union_all([wall.line_m.buffer(0.1) for wall in floor.walls])
    columns = [part for part in shapely.get_parts(free) if part.length < 3]
    panes = [o for o in floor.openings if o.glazed and o.lintel_m - o.sill_m > 2.5]
    names = [str(feature["properties"].get("name")) for feature in _features(path)]
    assert (len(columns), len(panes), len(floor.room_names)) == (2, 11, 6)
    assert (names.count("radiator"), names.count("cupboard"), names.count("step")) == (4, 7, 8)


def _features(path):
    return json.loads(path.read_text())["features"]
