"""building.yaml: which datasets are storeys of one building, and one line for each mistake."""

import os

import pytest

from helpers.refusals import assert_told, refused
from scanplan.errors import StageError
from scanplan.project.building_file import find_building, list_overlooked, read_building

GOOD = """\
name: Town hall
storeys:
- {dataset: floor_0, name: Ground floor, elevation_m: 0}
- {dataset: floor_1, elevation_m: 3.2, building_from_map: [1.5, -2, 90]}
"""


def written(folder, text):
    path = folder / "building.yaml"
    path.write_text(text)
    return path


def test_storeys_are_read_as_they_stand(tmp_path):
    building = read_building(written(tmp_path, GOOD))
    assert building.name == "Town_hall"
    ground, first = building.storeys
    assert (ground.name, ground.elevation_m, ground.place) == ("Ground floor", 0.0, (0, 0, 0))
    assert (first.name, first.place) == ("floor_1", (1.5, -2.0, 90.0))
    assert building.note_unaligned() == []
    assert building.list_results() == [
        "results/Town_hall/building.ifc",
        "results/Town_hall/building.dxf",
        "results/Town_hall/building.pdf",
    ]


@pytest.mark.parametrize(
    ("name", "results"), [("A/B", "A_B"), ("hall.bag", "hall.bag"), ("../x 2", None), (".", None)]
)
def test_results_are_named_by_all_of_the_building_s_name(tmp_path, name, results):
    path = written(tmp_path, GOOD.replace("Town hall", f"'{name}'"))
    if results is None:
        with refused(file=path.name, value="name for results"):
            read_building(path)
    else:
        assert read_building(path).name == results


def test_a_storey_without_a_place_is_told_unaligned(tmp_path):
    loose = GOOD.replace(", building_from_map: [1.5, -2, 90]", "")
    (note,) = read_building(written(tmp_path, loose)).note_unaligned()
    assert_told(note, key="floor_1")
    shared = read_building(written(tmp_path, loose + "frame: shared\n"))
    assert shared.note_unaligned() == []


def test_a_shared_frame_needs_no_elevation(tmp_path):
    text = "frame: shared\nstoreys: [{dataset: a}, {dataset: b}]\n"
    assert [s.elevation_m for s in read_building(written(tmp_path, text)).storeys] == [None, None]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("storeys: []", "storeys is [], expected a list of two or more"),
        ("storeys: [{dataset: a, elevation_m: 0}]", "expected a list of two or more"),
        (GOOD + "floors: 3\n", "has floors; known are"),
        (GOOD + "frame: mine\n", "frame is 'mine', expected `shared`"),
        (GOOD.replace("elevation_m: 0", "height: 0"), "storey 1: has height; known are"),
        (GOOD.replace(", elevation_m: 0", ""), "storey 1: has no elevation_m; give it, or `frame"),
        (GOOD.replace("elevation_m: 0", "elevation_m: high"), "elevation_m is 'high'"),
        (GOOD.replace("[1.5, -2, 90]", "[1.5, -2]"), "storey 2: building_from_map is [1.5, -2]"),
        (GOOD.replace("floor_1", "floor_0"), "dataset floor_0 is two storeys"),
        (GOOD.replace("Ground floor", '"a\\nb"'), "storey 1: name has '\\n'"),
        (
            GOOD.replace("Ground floor", "a" * 10_000),
            "storey 1: name has 10000 characters, expected",
        ),
        (
            GOOD.replace("3.2", "0"),
            "floor_0 and floor_1 lie 0 m apart, storeys are at least 0.5",
        ),
        (GOOD.replace("3.2", "1.0e+8"), "elevation_m is 100000000.0, expected metres, up to 10000"),
        (GOOD.replace("[1.5, -2, 90]", "[1.5, -2, 361]"), "up to 10000 m and 360"),
        (GOOD.replace("[1.5, -2, 90]", "[1.5, .nan, 90]"), "up to 10000 m and 360"),
        (GOOD.replace("Town hall", "[1, 2]"), "name is [1, 2], expected text of 1 to 80"),
        (GOOD.replace("Town hall", "thesis"), "thesis is a target of the workflow"),
        (GOOD.replace("Town hall", "Comparison"), "Comparison is a target of the workflow"),
        (GOOD.replace("dataset: floor_0", "data: floor_0"), "expected `dataset: NAME`"),
    ],
)
def test_a_wrong_file_ends_in_one_line(tmp_path, text, fault):
    path = written(tmp_path, text)
    with pytest.raises(StageError) as told:
        read_building(path)
    assert str(told.value).startswith(f"{path}: ") and fault in str(told.value)


def test_datasets_beside_the_file_are_its_storeys(tmp_path):
    written(tmp_path, GOOD)
    given = {name: str(tmp_path / name) for name in ("floor_0", "floor_1", "floor_2")}
    assert find_building(given).name == "Town_hall"
    # one alone is made alone, as are those of several folders, and the demo
    assert find_building({"floor_0": given["floor_0"]}) is None
    assert find_building(given | {"other": str(tmp_path / "x/other")}) is None
    assert find_building({"demo": None}) is None


def test_a_storey_without_scans_ends_in_one_line(tmp_path):
    written(tmp_path, GOOD)
    given = {name: str(tmp_path / name) for name in ("floor_0", "floor_2")}
    with refused(key="floor_1"):
        find_building(given)


def test_a_building_has_a_name_of_its_own(tmp_path):
    written(tmp_path, GOOD.replace("Town hall", "FLOOR_0"))
    given = {name: str(tmp_path / name) for name in ("floor_0", "floor_1")}
    with refused(value="FLOOR_0"):
        find_building(given)


def test_what_is_no_file_is_told(tmp_path):
    given = {name: str(tmp_path / name) for name in ("floor_0", "floor_1")}
    os.mkfifo(tmp_path / "building.yaml")
    with refused(file="building.yaml", value="a pipe"):
        find_building(given)


def test_a_file_of_nearly_its_name_is_told(tmp_path):
    given = {name: str(tmp_path / name) for name in ("floor_0", "floor_1")}
    assert list_overlooked(given) == list_overlooked({"floor_0": given["floor_0"]}) == []
    (tmp_path / "Building.yml").write_text(GOOD)
    (note,) = list_overlooked(given)
    assert_told(note, file=("Building.yml", "building.yaml"))
