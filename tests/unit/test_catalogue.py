"""The catalogue's buildings look like ones that exist, and its halves are kept apart."""

import json
from collections import Counter
from functools import cache
from pathlib import Path

import matplotlib.image
import pytest
import shapely
import yaml

from benchmarks import catalogue
from benchmarks.catalogue import buildings, phenomena, picture, survey_settings
from helpers.default_settings import SCHEMA
from scanplan.lab.buildings import building, building_route, drawing_file, drawn_floor
from scanplan.lab.buildings.details import leaves
from scanplan.project import settings_check

DRIVES = catalogue.list_drives()
BUILDINGS = sorted({(drive.kind, drive.seed) for drive in DRIVES})
ONE_OF_EACH = [BUILDINGS[3 * i + i % 3] for i in range(len(BUILDINGS) // 3)]
_SLIVER_M2 = 0.004  # what things that touch overlap by where walls are out of square


@cache
def text_of(kind, seed):
    return buildings.draw_building(kind, seed).text()


@cache
def floor_of(kind, seed):
    return drawing_file.parse_drawing(text_of(kind, seed), f"{kind}_{seed}.geojson")


def phenomena_of(drives):
    counts = Counter()
    for kind, seed in {(drive.kind, drive.seed) for drive in drives}:
        counts += phenomena.count_phenomena(json.loads(text_of(kind, seed)))
    return counts


def half(name):
    return [drive for drive in DRIVES if drive.half == name]


def test_no_kind_and_no_seed_is_for_tuning_and_for_reports():
    assert {drive.half for drive in DRIVES} == {"tuning", "reporting"}
    for value in ("kind", "seed", "name"):
        tuning, reporting = ({getattr(d, value) for d in half(h)} for h in catalogue.HALVES)
        assert not tuning & reporting
    assert all(100 <= drive.seed < 200 for drive in half("tuning"))
    assert all(200 <= drive.seed < 300 for drive in half("reporting"))


def test_there_are_three_buildings_of_each_of_fourteen_kinds_with_two_drives_each():
    assert set(Counter(kind for kind, _ in BUILDINGS).values()) == {3}
    assert {kind for kind, _ in BUILDINGS} == set(buildings.KINDS)
    assert set(Counter((d.kind, d.seed) for d in DRIVES).values()) == {2}
    assert (len(BUILDINGS), len({drive.name for drive in DRIVES})) == (42, 84)


@pytest.mark.parametrize("name", catalogue.HALVES)
def test_every_sensor_drives_in_both_halves_and_a_third_is_planar(name):
    sensors = [drive.sensor for drive in half(name)]
    assert set(sensors) == {*survey_settings.SPATIAL, *survey_settings.PLANAR}
    assert sum(sensor in survey_settings.PLANAR for sensor in sensors) >= len(sensors) / 3


@pytest.mark.parametrize("name", catalogue.HALVES)
def test_everything_that_makes_buildings_hard_is_in_both_halves(name):
    counts = phenomena_of(half(name))
    assert [n for n in phenomena.NAMES if counts[n] < 2] == []


def test_twelve_drives_show_everything_with_every_sensor():
    subset = catalogue.list_drives(subset=True)
    counts = phenomena_of(subset)
    assert len(subset) == len({drive.sensor for drive in subset}) == 12
    assert [n for n in phenomena.NAMES if not counts[n]] == []


def test_leaves_stand_as_doors_in_use_do():
    states = Counter()
    for kind, seed in BUILDINGS:
        for opening in floor_of(kind, seed).openings:
            if opening.leaf and opening.leaf.type != "sliding":
                turn = opening.leaf.open_deg
                states[sum(turn >= least for least in (1, 45, 120))] += 1
    shares = [states[k] / states.total() for k in range(4)]
    assert shares == pytest.approx([0.2, 0.15, 0.5, 0.15], abs=0.08)


@pytest.mark.parametrize(("kind", "seed"), BUILDINGS)
def test_every_room_has_a_way_in_and_nothing_stands_in_walls_or_before_doors(kind, seed):
    floor = floor_of(kind, seed)
    doors = [o for o in floor.openings if o.type != "window"]
    ways = shapely.union_all(
        [o.line_m.buffer(o.thickness_m / 2 + 0.15, cap_style="flat") for o in doors]
    )
    assert [n for n, room in drawn_floor.floor_rooms(floor) if not room.intersects(ways)] == []
    walls = drawn_floor.cut_walls(floor, 1.0)
    solid = shapely.union_all([walls, *(column.footprint_m for column in floor.columns)])
    low = [f for f in floor.furniture if f.base_m < 1.4]
    assert [f.type for f in low if f.footprint_m.intersection(solid).area > _SLIVER_M2] == []
    stuff = shapely.union_all([*(f.footprint_m for f in low), solid])
    hung = [leaf for o in doors for leaf in leaves.stand_leaves(o)]
    assert [b for b in hung if b.footprint_m.intersection(stuff).area > _SLIVER_M2] == []


@pytest.mark.parametrize(("kind", "seed"), ONE_OF_EACH)
def test_half_of_the_named_rooms_at_least_can_be_driven_into(kind, seed):
    site = building.load_building(
        text_of(kind, seed).encode(), Path(f"{kind}.geojson"), slice_height_m=0.45
    )
    driven = building_route.plan_building_route(
        site, "drawing", building_route.WaySettings("rooms", 0.25), reach_m=0.2
    )
    rooms = [v for _, v in driven.truth if v["kind"] == "room" and v["name"]]
    # bathrooms of hotels and wards are shut as a rule
    rooms = [room for room in rooms if not room["name"].startswith("bath")]
    assert sum(room["visited"] for room in rooms) >= len(rooms) / 2


def test_sizes_are_those_of_buildings():
    widths, lintels, walls = {"hinged": [], "double": [], "sliding": []}, [], []
    for kind, seed in BUILDINGS:
        floor = floor_of(kind, seed)
        doors = [o for o in floor.openings if o.leaf]
        for opening in doors if kind != "hall" else []:
            widths[opening.leaf.type].append(opening.line_m.length)
            lintels.append(opening.lintel_m)
        walls += [w.thickness_m for w in floor.walls if not w.is_glass]
    assert min(widths["hinged"]) > 0.64 and max(widths["hinged"]) < 1.3
    assert min(widths["double"]) > 1.0 and max(widths["double"]) < 1.9
    assert min(widths["sliding"]) > 0.85 and max(widths["sliding"]) < 1.7
    assert min(lintels) >= 1.9 and max(lintels) <= 2.4
    assert min(walls) == 0.05 and 0.7 <= max(walls) <= 0.85


def test_a_picture_shows_a_building(tmp_path):
    picture.draw_picture(text_of("dwelling", 101), tmp_path / "dwelling.png")
    pixels = matplotlib.image.imread(tmp_path / "dwelling.png")
    is_red = (pixels[..., 0] > 0.9) & (pixels[..., 1:3].max(axis=-1) < 0.2)
    # leaves are red
    assert pixels.shape[:2] == (720, 960) and is_red.sum() > 100


def test_the_same_seed_draws_the_same_and_another_another():
    again = buildings.draw_building("attic", 201).text()
    assert again == text_of("attic", 201) != text_of("attic", 202)


def test_a_kind_that_there_is_not_is_refused():
    with pytest.raises(ValueError, match="dwelling"):
        buildings.draw_building("castle", 1)


def test_a_survey_is_written_as_a_dataset_once(tmp_path):
    drives = {drive.sensor: drive for drive in DRIVES if drive.kind in ("attic", "shop")}
    for drive in drives.values():
        path = catalogue.write_survey(drive, tmp_path)
        settings = yaml.safe_load(path.read_text())
        settings_check.check_settings(settings, SCHEMA, path.name)
        assert Path(settings["simulate"]["building"]).read_text() == text_of(drive.kind, drive.seed)
        before = path.stat().st_mtime_ns
        assert catalogue.write_survey(drive, tmp_path).stat().st_mtime_ns == before
