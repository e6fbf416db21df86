"""Files of corrections: what they may say, and one line for each mistake."""

import json
import os

import pytest

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.corrections_file import (
    find_beside,
    place_corrections,
    read_corrections,
    read_entries,
)

GOOD = """\
corrections:
- {element: room, at: [1, 2], name: "Foyer & bar"}
- {"element":"wall","at":[1.5,-2],"action":"remove"}
- {element: opening, at: [3, 0], kind: window}
- {element: wall, action: add, line: [[0, 0], [4, 0]], thickness_m: 0.2}
- {element: opening, action: add, line: [[1, 0], [2, 0]], kind: door}
- {element: reference_point, at: [0, 0], world: [500000, 5400000], crs: EPSG:25832}
- {element: reference_point, at: [0, 9], world: [500000, 5400009], crs: EPSG:25832}
"""


def written(folder, text, name="corrections.yaml"):
    path = folder / name
    path.write_text(text)
    return path


def test_a_room_may_be_one_with_several(tmp_path):
    path = tmp_path / "corrections.yaml"
    merge = "- {element: room, action: merge, at: [1, 1], with: [5, %d]}\n"
    path.write_text("corrections:\n" + merge % 1 + merge % 2)
    assert [c.with_m for c in read_corrections(path)] == [(5.0, 1.0), (5.0, 2.0)]
    path.write_text("corrections:\n" + merge % 1 + merge % 1)
    with refused(value=("entry 2", "entry 1")):
        read_corrections(path)


def test_entries_are_read_as_they_stand(tmp_path):
    room, wall, opening, new_wall, door, point, _ = read_corrections(written(tmp_path, GOOD))
    assert (room.action, room.at_m, room.name) == ("change", (1.0, 2.0), "Foyer & bar")
    assert (wall.action, wall.at_m) == ("remove", (1.5, -2.0))
    assert (opening.action, opening.kind) == ("change", "window")
    assert new_wall.line_m == ((0.0, 0.0), (4.0, 0.0)) and new_wall.thickness_m == 0.2
    assert (door.action, door.kind, door.at_m) == ("add", "door", (1.5, 0.0))
    assert (point.world_m, point.crs) == ((500000.0, 5400000.0), "EPSG:25832")


def test_sizes_places_and_who_said_it_are_read(tmp_path):
    text = """\
survey: office 0123
corrections:
- {element: wall, at: [1, 2], line: [[0, 0], [4, 0]], thickness_m: 0.36}
- {element: opening, at: [3, 0], width_m: 0.9, lintel_m: 2.1, when: "2026-03-01T09:30:00Z", by: A}
- {element: room, action: merge, at: [1, 2], with: [5, 2]}
- {element: room, at: [1, 2], number: "2.14"}
"""
    wall, opening, merged, room = read_corrections(written(tmp_path, text))
    assert (wall.action, wall.at_m, wall.line_m) == ("change", (1, 2), ((0, 0), (4, 0)))
    assert (wall.thickness_m, opening.width_m, opening.lintel_m) == (0.36, 0.9, 2.1)
    assert (merged.with_m, room.number, room.name) == ((5.0, 2.0), "2.14", "")


def test_leaves_things_tapes_and_settled_rooms_are_read(tmp_path):
    text = """\
corrections:
- {element: opening, at: [3, 0], kind: door, swing: [2.5, 0.9]}
- {element: furniture, action: add, outline: [[0, 0], [2, 0], [2, 1], [0, 1]], kind: column}
- {element: furniture, at: [5, 5], action: remove}
- {element: length, action: add, line: [[0, 0], [4, 0]], length_m: 4.012, sigma_m: 0.002}
- {element: room, at: [1, 2], use: store, by: A. Bee, when: "2026-03-01T09:30:00Z"}
- {element: room, at: [1, 2], action: settle}
- {element: wall, at: [9, 9], height_m: 1.2}
"""
    door, column, gone, tape, room, settled, wall = read_corrections(written(tmp_path, text))
    assert door.swing_m == (2.5, 0.9) and column.at_m == (1.0, 0.5)
    assert column.outline_m == ((0, 0), (2, 0), (2, 1), (0, 1)) and gone.action == "remove"
    assert (tape.length_m, tape.sigma_m, tape.at_m) == (4.012, 0.002, (2, 0))
    assert (room.use, room.by, room.when) == ("store", "A. Bee", "2026-03-01T09:30:00Z")
    assert settled.action == "settle" and wall.height_m == 1.2


@pytest.mark.parametrize(
    ("entry", "fault"),
    [
        ("outline: [[0, 0], [2, 0]]", "3 to 100 places"),
        ("outline: [[0, 0], [2, 0], [1, 0]]", "covers 0 m²"),
        ("outline: [[0, 0], [2, 0], [1, x]]", "two numbers"),
        ("outline: [[0, 0], [1000000, 0], [0, 1000000]]", "0.001 to 10000 m²"),
    ],
)
def test_an_outline_that_is_none_is_told(tmp_path, entry, fault):
    path = written(tmp_path, f"corrections:\n- {{element: furniture, action: add, {entry}}}\n")
    with pytest.raises(StageError, match="entry 1: ") as told:
        read_corrections(path)
    assert fault in str(told.value)


def test_geojson_says_the_same(tmp_path):
    geometries = {
        "at": lambda place: {"type": "Point", "coordinates": place},
        "line": lambda line: {"type": "LineString", "coordinates": line},
    }
    features = []
    for entry in read_entries(written(tmp_path, GOOD)):
        ((key, place),) = ((key, entry[key]) for key in geometries if key in entry)
        features.append({
            "type": "Feature",
            "properties": {k: v for k, v in entry.items() if k != key},
            "geometry": geometries[key](place),
        })  # fmt: skip
    text = json.dumps({"type": "FeatureCollection", "features": features})
    path = written(tmp_path, text, "corrections.geojson")
    assert read_entries(path) == read_entries(tmp_path / "corrections.yaml")
    assert len(read_corrections(path)) == 7


@pytest.mark.parametrize(
    ("entry", "fault"),
    [
        (
            "{element: wal, at: [1, 2], action: keep}",
            "element is 'wal', expected one of check_point",
        ),
        ("{element: wall, at: [1, 2], action: paint}", "action of a wall is 'paint', expected"),
        (
            "{element: wall, at: [1, 2]}",
            "has no kind or line or thickness_m or height_m; to",
        ),
        ("{element: wall, at: [1, 2], kind: door}", "kind is 'door', expected one of furniture"),
        ("{element: opening, at: [1, 2], width_m: 0}", "width_m is 0, expected 0.05 to 1000 m"),
        ("{element: opening, at: [1, 2], sill_m: 2, lintel_m: 1.5}", "sill_m is not below"),
        ("{element: room, action: merge, at: [1, 2]}", "has no with; to merge a room takes"),
        ("{element: room, action: split, at: [1, 2]}", "has at; to split a room takes line"),
        ("{element: wall, at: [1, 2], action: keep, when: noon}", "when is 'noon', expected a"),
        ("{element: wall, at: [1, 2], action: keep, by: 5}", "by is 5, expected text of 1 to 80"),
        ("{element: wall, at: [1], action: keep}", "at is [1], expected two numbers"),
        ("{element: wall, at: [1, .inf], action: keep}", "expected two numbers"),
        ("{element: wall, at: [1, yes], action: keep}", "expected two numbers"),
        ("{element: wall, at: [1, 1" + "0" * 400 + "], action: keep}", "expected two numbers"),
        ("{element: room, at: [1, 2], name: 5}", "name is 5, expected text of 1 to 80"),
        ("{element: room, at: [1, 2], name: ' '}", "name shows nothing; write letters"),
        ('{element: room, at: [1, 2], name: "a\\nb"}', "name has '\\n'; leave out line breaks"),
        ('{element: room, at: [1, 2], name: "a\\uffff"}', "name has '\\uffff'; leave out"),
        ('{element: room, at: [1, 2], name: "a\\u202eb"}', "name has '\\u202e'; leave out"),
        (
            "{element: room, at: [1, 2], name: " + "a" * 81 + "}",
            "has 81 characters, expected text of",
        ),
        ("{element: wall, action: [1], at: [1, 2]}", "action of a wall is [1], expected one of"),
        ("{element: [wall], action: keep, at: [1, 2]}", "element is ['wall'], expected one of"),
        ("{element: opening, at: [1, 2], kind: {a: 1}}", "kind is {'a': 1}, expected one of"),
        ("{element: room, at: [1, 2], name: x, kind: door}", "has kind; to change a room takes"),
        ("{element: room, at: [1, 2], name: no}", "name is False, expected text of 1 to 80"),
        ("{element: opening, at: [1, 2], kind: gate}", "kind is 'gate', expected one of door"),
        ("{element: opening, action: add, kind: door}", "has no line"),
        ("{element: wall, action: add, line: [[0, 0], [0, 0]]}", "line is 0 m long, expected"),
        (
            "{element: wall, action: add, line: [[0, 0], [30000, 0]]}",
            "line is 30000 m long, expected",
        ),
        (
            "{element: opening, action: add, kind: door, line: [[0, 0], [1.0e+8, 0]]}",
            "0.05 to 1000 m",
        ),
        ("{element: wall, action: add, line: [[0, 0], [1.0e+9, 0]]}", "in metres, up to 1e+08"),
        ("{element: wall, action: add, line: [[0, 0]]}", "expected two places"),
        (
            "{element: wall, action: add, line: [[0, 0], [1, 0]], thickness_m: -1}",
            "expected 0.01 to 3 m",
        ),
        (
            "{element: wall, action: add, line: [[0, 0], [1, 0]], thickness_m: 1.0e-300}",
            "0.01 to 3 m",
        ),
        ("{element: wall, action: add, line: [[0, 0], [1, 0]], thickness_m: 9.9}", "0.01 to 3 m"),
        ("{element: reference_point, at: [0, 0], world: [1, 2], crs: EPSG:0}", "a code of 1024 to"),
        ("{element: reference_point, at: [0, 0], world: [1, 2], crs: EPSG:4326}", "in degrees"),
        ("{element: reference_point, at: [0, 0], world: [1.0e+300, 2], crs: x}", "up to 1e+08"),
        ("{element: reference_point, at: [0, 0], world: [1, 2], crs: x}", "add another"),
        ("{element: check_point, at: [0, 0], world: [1, 2], crs: EPSG:25832}", "add two"),
        ("just words", "is 'just words', expected `element: ...`"),
    ],
)
def test_a_wrong_entry_ends_in_one_line(tmp_path, entry, fault):
    path = written(tmp_path, f"corrections:\n- {entry}\n")
    with pytest.raises(StageError) as told:
        read_corrections(path)
    assert f"{path}: entry 1: " in str(told.value) and fault in str(told.value)


@pytest.mark.parametrize("text", ["", "corrections: 5", "corrections: []\nwalls: []", "rooms: []"])
def test_a_file_of_something_else_is_told(tmp_path, text):
    with refused(remedy="corrections:"):
        read_corrections(written(tmp_path, text))


@pytest.mark.parametrize(
    "text",
    ["{", "[]", "[" * 10**5, '{"features": [{}]}', '{"features": [5]}', '{"features": {"a": 1}}'],
)
def test_damaged_geojson_is_told(tmp_path, text):
    with refused(file="corrections.geojson", value="FeatureCollection"):
        read_corrections(written(tmp_path, text, "corrections.geojson"))


def test_two_entries_of_one_place_are_told(tmp_path):
    text = GOOD + "- {element: wall, at: [1.5, -2], action: keep}\n"
    with refused(value=("entry 8", "entry 2"), remedy="keep one"):
        read_corrections(written(tmp_path, text))


def test_points_have_names_and_sigmas(tmp_path):
    told = "world: [500000, 5400000], crs: EPSG:25832, sigma_m: 0.01, name: P1"
    other = told.replace("500000", "500009").replace("P1", "K1")
    path = written(
        tmp_path,
        f"corrections:\n- {{element: reference_point, at: [0, 0], {told}}}\n"
        f"- {{element: reference_point, at: [9, 0], {other}}}\n"
        f"- {{element: check_point, at: [9, 0], {other}}}\n",
    )
    points = read_corrections(path)
    assert [(point.name, point.sigma_m) for point in points] == [
        *(("P1", 0.01), ("K1", 0.01), ("K1", 0.01))
    ]


def test_reference_points_in_two_systems_are_told(tmp_path):
    with pytest.raises(StageError, match="several `crs`"):
        read_corrections(written(tmp_path, GOOD.replace("EPSG:25832", "EPSG:25833", 1)))


def test_one_file_of_corrections_is_used(tmp_path):
    assert find_beside(tmp_path / "corrections.yaml") is None
    path = written(tmp_path, GOOD)
    assert find_beside(tmp_path / "corrections.yaml") == path
    written(tmp_path, "{}", "corrections.geojson")
    with refused(file=("corrections.yaml", "corrections.geojson"), remedy="keep one"):
        find_beside(tmp_path / "corrections.yaml")


@pytest.mark.parametrize("geometry", ['"Point"', "[1, 2]", "5", "null", "true"])
def test_a_geometry_that_is_none_is_told(tmp_path, geometry):
    text = f'{{"features": [{{"properties": {{"element": "wall"}}, "geometry": {geometry}}}]}}'
    with refused(file="corrections.geojson", remedy="mend it"):
        read_corrections(written(tmp_path, text, "corrections.geojson"))


@pytest.mark.parametrize("name", ["{a}", "a^b", "a\\Pb", "<b>x", "50 %%c", "Lager $1", "ёж 🏠"])
def test_a_name_may_have_any_character_of_a_line(tmp_path, name):
    entry = json.dumps({"element": "room", "at": [1, 2], "name": name})
    path = written(tmp_path, f"corrections:\n- {entry}\n")
    assert [c.name for c in read_corrections(path)] == [name]


def test_half_of_a_character_is_told_with_its_line(tmp_path):
    path = written(tmp_path, 'corrections:\n- {element: room, at: [1, 2], name: "\\ud83c"}\n')
    with refused(value=("line 2", "column 37")):
        read_corrections(path)
    feature = {"properties": {"element": "room", "name": "\ud83c"},
               "geometry": {"type": "Point", "coordinates": [1, 2]}}  # fmt: skip
    path = written(tmp_path, json.dumps({"features": [feature]}), "corrections.geojson")
    with pytest.raises(StageError, match=r"name has '\\ud83c'; leave out"):
        read_corrections(path)


@pytest.mark.parametrize("name", ["corrections.yaml", "corrections.geojson"])
def test_what_is_no_file_is_told(tmp_path, name):
    path = tmp_path / name
    path.symlink_to(tmp_path / "nowhere")
    with refused(file=name, value="a link"):
        find_beside(tmp_path / "corrections.yaml")
    path.unlink()
    path.mkdir()
    with refused(file=name, value="a folder"):
        find_beside(tmp_path / "corrections.yaml")
    path.rmdir()
    os.mkfifo(path)
    with refused(file=name, value="a pipe"):
        find_beside(tmp_path / "corrections.yaml")


def test_corrections_lie_beside_the_recording(tmp_path):
    bag = tmp_path / "my.bag"
    bag.touch()
    beside = place_corrections("my", bag, is_simulated=False)
    assert beside == tmp_path / "my.bag.corrections.yaml"
    assert find_beside(written(tmp_path, GOOD, beside.name)) == beside
    folder = place_corrections("floor", tmp_path, is_simulated=False)
    assert folder == tmp_path / "corrections.yaml"
    simulated = place_corrections("demo", None, is_simulated=True)
    assert simulated.as_posix() == "results/demo/survey/corrections.yaml"
