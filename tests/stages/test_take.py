"""Plans edited elsewhere come back: what was changed is one correction, what was touched none."""

import json
import shutil

import ezdxf
import ifcopenshell
import ifcopenshell.util.element
import numpy as np
import pytest
import shapely

from helpers import correcting, floorplan_making
from helpers.editing import (
    edited_json,
    entries_of,
    make_results,
    move_wall,
    run_again,
    taken,
    wall_between,
    write_entries,
)
from helpers.refusals import assert_told
from scanplan.design.layer_words import kind_of_layer
from scanplan.edited.dxf_reading import read_facts
from scanplan.errors import StageError
from scanplan.exports.sheet.openings import find_swings
from scanplan.project.run.command import main

FILES = ("plan.openplan3d.json", "plan.ifc", "presentation.ifc", "plan.dxf", "presentation.dxf")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return make_results(tmp_path_factory.mktemp("made"))


@pytest.fixture
def results(made, tmp_path):
    shutil.copytree(made.parents[1], tmp_path, dirs_exist_ok=True)
    return tmp_path / "results/office"


def edited_ifc(results, edit, name="plan.ifc"):
    model = ifcopenshell.open(results / "plan" / name)
    edit(model)
    path = results.parent / "edited.ifc"
    model.write(str(path))
    return path


def edited_dxf(results, edit, name="plan.dxf"):
    document = ezdxf.readfile(results / "plan" / name)
    edit(document)
    path = results.parent / "edited.dxf"
    document.saveas(path)
    return path


@pytest.mark.parametrize("name", FILES)
def test_what_was_only_saved_again_is_no_correction(results, name):
    suffix = name.rpartition(".")[2]
    edit = {"json": edited_json, "ifc": edited_ifc, "dxf": edited_dxf}[suffix]
    told = taken(results, edit(results, lambda _: None, name))
    assert "0 changes" in told[0] and entries_of(results) == [] and len(told) == 1
    assert not (results.parents[1] / "rec/corrections.yaml").exists()


def test_what_was_only_touched_in_the_editor_is_no_correction(results):
    def touch(floor):
        for wall in floor["walls"]:
            wall["start"] = {axis: round(value, 0) for axis, value in wall["start"].items()}
            wall["color"] = "#ff0000"

    assert "0 changes" in taken(results, edited_json(results, touch))[0]


# --- openPlan3D ---


def by_name(items, **known):
    (found,) = [item for item in items if all(item[k] == v for k, v in known.items())]
    return found


def test_a_wall_moved_in_the_editor_is_moved_with_its_door(results):
    told = taken(results, edited_json(results, move_wall), by="A. Bee")
    (entry,) = entries_of(results)
    assert entry["element"] == "wall" and "1 change of" in told[0]
    assert {end[0] for end in entry["line"]} == {4.25}
    plan = run_again(results)
    assert plan.walls["x0_m"][5] == plan.walls["x1_m"][5] == 4.25
    assert plan.openings["x0_m"][1] == 4.25 and plan.corrected_by.startswith("A. Bee, ")


def edit_door(floor, **values):
    door = by_name(floor["doors"], wallId=wall_between(floor)["id"])
    door.update(values)


@pytest.mark.parametrize(
    ("edit", "expected"),
    [
        (lambda f: edit_door(f, width=100), {"width_m": 1.0}),
        (lambda f: edit_door(f, height=210), {"lintel_m": 2.1}),
        (lambda f: edit_door(f, type="opening"), {"kind": "passage"}),
        (lambda f: wall_between(f).update(thickness=24), {"thickness_m": 0.24}),
        (lambda f: wall_between(f).update(height=120), {"height_m": 1.2}),
        (lambda f: f["rooms"][1].update(name="Store"), {"name": "Store"}),
        (lambda f: f["rooms"][1].update(details={"roomType": "bath"}), {"use": "bath"}),
        (lambda f: f["rooms"][1].update(roomType="outdoor"), {"action": "remove"}),
        (lambda f: f["furniture"].clear(), {"action": "remove"}),
    ],
)
def test_an_edit_in_the_editor_is_one_correction(results, edit, expected):
    taken(results, edited_json(results, edit))
    (entry,) = entries_of(results)
    assert {k: v for k, v in entry.items() if k not in ("element", "at")} == expected
    plan = run_again(results, with_files=True)
    assert plan.unmatched_corrections == () or plan.unmatched_corrections == []
    # what was taken is no difference any more
    again = taken(results, results / "plan/plan.openplan3d.json")
    assert "0 changes" in again[0] and entries_of(results) == [entry]


def test_a_door_moved_along_its_wall(results):
    # 4.05, from 1.0 to 1.9 m: 0.3 m to the north
    def edit(floor):
        wall = wall_between(floor)
        door = by_name(floor["doors"], wallId=wall["id"])
        length = abs(wall["end"]["y"] - wall["start"]["y"])
        sign = 1 if wall["end"]["y"] < wall["start"]["y"] else -1
        door["position"] += sign * 30 / length

    taken(results, edited_json(results, edit))
    (entry,) = entries_of(results)
    assert sorted(end[1] for end in entry["line"]) == pytest.approx([1.3, 2.2], abs=0.001)
    plan = run_again(results)
    assert sorted([plan.openings["y0_m"][1], plan.openings["y1_m"][1]]) == pytest.approx([1.3, 2.2])


@pytest.mark.parametrize(("direction", "y"), [("left", 1.9), ("right", 1.0)])
@pytest.mark.parametrize(("flip", "side"), [(False, 1), (True, -1)])
def test_a_leaf_that_was_turned_in_the_editor(results, direction, y, flip, side):
    taken(results, edited_json(results, lambda f: edit_door(f, swingDirection=direction,
                                                            flipSide=flip)))  # fmt: skip
    entries = entries_of(results)
    if (direction, flip) == ("left", False):  # as doors are written of which no leaf was seen
        assert entries == []
        return
    (entry,) = entries
    assert entry["swing"] == pytest.approx([4.05 + side * 0.9, y], abs=0.001)
    plan = run_again(results, with_files=True)
    assert find_swings(plan).keys() == {1}
    project = json.loads((results / "plan/plan.openplan3d.json").read_text())
    floor = project["floors"][0]
    door = by_name(floor["doors"], wallId=wall_between(floor)["id"])
    assert (door["swingDirection"], door["flipSide"]) == (direction, flip)


def test_a_wall_and_a_door_in_it_drawn_in_the_editor(results):
    def edit(floor):
        wall = {"id": "new", "start": {"x": 200, "y": 0}, "end": {"x": 200, "y": -300},
                "thickness": 12, "height": 250, "color": "#444444"}  # fmt: skip
        floor["walls"].append(wall)
        leaf = {"type": "single", "swingDirection": "left", "flipSide": False}
        place = {"id": "leaf", "wallId": "new", "position": 0.5, "width": 80, "height": 200}
        floor["doors"].append(place | leaf)

    taken(results, edited_json(results, edit))
    wall, door = entries_of(results)
    assert wall == {"element": "wall", "action": "add", "line": [[2.0, 0.0], [2.0, 3.0]],
                    "thickness_m": 0.12}  # fmt: skip
    assert (door["kind"], door["line"]) == ("door", [[2.0, 1.1], [2.0, 1.9]])
    plan = run_again(results, with_files=True)
    assert plan.walls["thickness_m"][-1] == 0.12 and plan.openings["wall"][-1] == 6
    again = taken(results, results / "plan/plan.openplan3d.json")
    assert "0 changes" in again[0]


def test_a_wall_taken_out_in_the_editor(results):
    def edit(floor):
        wall = wall_between(floor)
        floor["walls"].remove(wall)
        floor["doors"] = [door for door in floor["doors"] if door["wallId"] != wall["id"]]

    taken(results, edited_json(results, edit))
    entries = entries_of(results)
    assert [(e["element"], e["action"]) for e in entries] == [("wall", "remove")]
    assert 5 not in run_again(results).walls["wall"]


def test_a_window_in_the_place_of_a_door_is_of_another_kind(results):
    def edit(floor):
        door = by_name(floor["doors"], wallId=wall_between(floor)["id"])
        floor["doors"].remove(door)
        floor["windows"].append({**{k: door[k] for k in ("wallId", "position", "width")},
            "id": "w", "height": 110, "sillHeight": 90, "type": "standard"})  # fmt: skip

    taken(results, edited_json(results, edit))
    (entry,) = entries_of(results)
    assert (entry["kind"], entry["sill_m"]) == ("window", 0.9)
    assert run_again(results).openings["type"].tolist() == ["door", "window", "window"]


def test_a_wall_that_the_editor_parted_is_one_wall(results):
    def edit(floor):
        wall = wall_between(floor)
        middle = {"x": 405, "y": -50}
        floor["walls"].append({**wall, "id": "part", "start": middle})
        wall["end"] = middle
        lower = [w for w in (wall, floor["walls"][-1]) if w["end"]["y"] != -50]
        for door in floor["doors"]:
            if door["wallId"] == wall["id"]:
                # from 1.0 to 1.9 m: in the other part
                start, end = lower[0]["start"]["y"], lower[0]["end"]["y"]
                door.update(wallId="part", position=(-145 - start) / (end - start))

    told = taken(results, edited_json(results, edit))
    assert "0 changes" in told[0], entries_of(results)


def test_a_room_that_the_editor_lost_stays(results):
    told = taken(results, edited_json(results, lambda f: f["rooms"].pop()))
    assert entries_of(results) == [] and "1 room that the editor lost" in told[-1]


def test_what_no_correction_says_is_counted(results):
    def edit(floor):
        floor["stairs"].append({"id": "s"})
        floor["textAnnotations"] += [{"id": "a"}, {"id": "b"}]
        floor["rooms"].append({"id": "x", "name": "Room 7", "walls": []})
        floor["rooms"].append({"id": "y", "name": "Attic", "walls": []})

    told = "\n".join(taken(results, edited_json(results, edit)))
    assert "1 stairs, 2 textAnnotations" in told and "1 change not" in told
    assert "room Attic, added" in told and "Room 7" not in told and entries_of(results) == []


# --- IFC ---


def inner_wall(model):
    """The wall between both rooms, and its door."""
    (wall,) = [w for w in model.by_type("IfcWall") if w.Tag == "5"]
    (door,) = [d for d in model.by_type("IfcDoor") if d.Tag == "1"]
    return wall, door


def shift(product, x=0.0, y=0.0):
    """Move a product in the frame of its storey."""
    point = product.ObjectPlacement.RelativePlacement.Location
    before = point.Coordinates
    point.Coordinates = (before[0] + x, before[1] + y, *before[2:])


def move_with_door(model):
    wall, door = inner_wall(model)
    (opening,) = [rel.RelatedOpeningElement for rel in wall.HasOpenings]
    for product in (wall, opening, door):
        shift(product, x=0.2)


MODELS = pytest.mark.parametrize("name", ["plan.ifc", "presentation.ifc"])


@MODELS
def test_a_wall_moved_in_the_model(results, name):
    taken(results, edited_ifc(results, move_with_door, name))
    (entry,) = entries_of(results)
    assert entry["element"] == "wall"
    assert [end[0] for end in entry["line"]] == pytest.approx([4.25, 4.25], abs=0.001)
    plan = run_again(results)
    assert plan.walls["x0_m"][5] == pytest.approx(4.25) and plan.openings["wall"][1] == 5


@MODELS
@pytest.mark.parametrize(
    ("edit", "element", "expected"),
    [
        (lambda m: setattr(m.by_type("IfcSpace")[1], "LongName", "Store"), "room",
         {"name": "Store"}),
        (lambda m: setattr(m.by_type("IfcSpace")[1], "ObjectType", "bath"), "room",
         {"use": "bath"}),
        (lambda m: m.remove(m.by_type("IfcSpace")[1]), "room", {"action": "remove"}),
    ],
)  # fmt: skip
def test_a_room_that_was_edited_in_the_model(results, name, edit, element, expected):
    taken(results, edited_ifc(results, edit, name))
    (entry,) = entries_of(results)
    rest = {k: v for k, v in entry.items() if k not in ("element", "at")}
    assert (entry["element"], rest) == (element, expected)
    plan = run_again(results)
    assert list(plan.unmatched_corrections) == []


@MODELS
def test_a_wall_removed_from_the_model(results, name):
    def edit(model):
        wall, door = inner_wall(model)
        (opening,) = [rel.RelatedOpeningElement for rel in wall.HasOpenings]
        for product in (door, opening, wall):
            model.remove(product)

    taken(results, edited_ifc(results, edit, name))
    assert [(e["element"], e["action"]) for e in entries_of(results)] == [("wall", "remove")]
    assert run_again(results).walls["wall"].tolist() == [0, 1, 2, 3, 4]


@MODELS
def test_a_door_that_became_a_hole_in_the_model(results, name):
    taken(results, edited_ifc(results, lambda m: m.remove(inner_wall(m)[1]), name))
    (entry,) = entries_of(results)
    assert (entry["element"], entry["kind"]) == ("opening", "passage")
    assert run_again(results).openings["type"].tolist() == ["door", "passage", "window"]


@MODELS
def test_a_door_that_opens_otherwise_in_the_model(results, name):
    edit = lambda m: setattr(inner_wall(m)[1], "OperationType", "SINGLE_SWING_LEFT")  # noqa: E731
    taken(results, edited_ifc(results, edit, name))
    (entry,) = entries_of(results)
    assert abs(entry["swing"][0] - 4.05) == pytest.approx(0.9, abs=0.03)
    assert find_swings(run_again(results)).keys() == {1}


def test_a_wall_copied_in_the_model_is_added(results):
    def edit(model):
        wall, _ = inner_wall(model)
        copy = ifcopenshell.util.element.copy_deep(model, wall)
        shift(copy, x=1.0)

    taken(results, edited_ifc(results, edit))
    (entry,) = entries_of(results)
    assert (entry["element"], entry["action"], entry["thickness_m"]) == ("wall", "add", 0.1)
    assert [end[0] for end in entry["line"]] == pytest.approx([5.05, 5.05], abs=0.001)
    assert len(run_again(results).walls["wall"]) == 7


def test_furniture_that_was_moved_in_the_model(results):
    edit = lambda m: shift(m.by_type("IfcFurniture")[0], x=-1.0)  # noqa: E731
    taken(results, edited_ifc(results, edit, "presentation.ifc"))
    (entry,) = entries_of(results)
    assert entry["element"] == "furniture" and [2.0, 2.5] in entry["outline"]
    (piece,) = shapely.from_wkb(run_again(results).furniture["geometry"])
    assert piece.bounds == pytest.approx((2.0, 2.5, 3.0, 3.0), abs=0.001)


# --- DXF ---

DRAWINGS = pytest.mark.parametrize("name", ["plan.dxf", "presentation.dxf"])


def entity_of(document, **facts):
    """The entity whose extended data say so: of a wall its line."""
    units = {4: 0.001, 6: 1.0}[document.units]
    (found,) = [
        entity
        for entity in document.modelspace()
        if facts.items() <= read_facts(entity).items() and not getattr(entity, "closed", False)
    ]
    return found, 1 / units


@DRAWINGS
def test_a_wall_moved_by_its_line_in_the_drawing(results, name):
    def edit(document):
        line, per_m = entity_of(document, wall=5)
        line.translate(0.2 * per_m, 0, 0)

    taken(results, edited_dxf(results, edit, name))
    (entry,) = entries_of(results)
    assert [end[0] for end in entry["line"]] == pytest.approx([4.25, 4.25], abs=0.001)
    assert run_again(results).walls["x0_m"][5] == pytest.approx(4.25)


def stretch_inner_wall(document, name):
    """Move what is drawn of the sides of the wall between both rooms by 0.2 m to the east."""
    per_m = 1 if name.startswith("presentation") else 1000
    for entity in document.modelspace().query("LWPOLYLINE"):
        if not read_facts(entity) and kind_of_layer(entity.dxf.layer) == "wall":
            points = [
                (x + 0.2 * per_m * (3.9 < x / per_m < 4.2), y, bulge)
                for x, y, bulge in entity.get_points("xyb")
            ]
            entity.set_points(points, format="xyb")


@DRAWINGS
def test_a_wall_moved_by_its_sides_in_the_drawing(results, name):
    taken(results, edited_dxf(results, lambda d: stretch_inner_wall(d, name), name))
    (entry,) = entries_of(results)
    assert [end[0] for end in entry["line"]] == pytest.approx([4.25, 4.25], abs=0.001)


@DRAWINGS
def test_an_opening_moved_renamed_removed_in_the_drawing(results, name):
    def move(document):
        block, per_m = entity_of(document, opening=1)
        block.translate(0, 0.3 * per_m, 0)

    taken(results, edited_dxf(results, move, name))
    (entry,) = entries_of(results)
    assert sorted(end[1] for end in entry["line"]) == pytest.approx([1.3, 2.2], abs=0.02)
    plan = run_again(results)
    assert plan.openings["wall"][1] == 5


@DRAWINGS
@pytest.mark.parametrize(
    ("edit", "expected"),
    [
        (lambda e: setattr(e.dxf, "name", "WINDOW"), {"kind": "window"}),
        (lambda e: e.destroy(), {"action": "remove"}),
    ],
)
def test_an_opening_that_is_another_or_gone_in_the_drawing(results, name, edit, expected):
    taken(results, edited_dxf(results, lambda d: edit(entity_of(d, opening=1)[0]), name))
    (entry,) = entries_of(results)
    assert {k: v for k, v in entry.items() if k not in ("element", "at")} == expected
    assert list(run_again(results).unmatched_corrections) == []


def stamp_of(document, number):
    stamps = [e for e in document.modelspace().query("INSERT") if e.dxf.name.startswith("ROOM")]
    (stamp,) = [e for e in stamps if e.get_attrib_text("NUMBER") == number]
    return stamp


@DRAWINGS
def test_a_room_renamed_by_its_attribute_or_its_text(results, name):
    def by_attribute(document):
        stamp_of(document, "1").get_attrib("NAME").dxf.text = "Store"

    def by_text(document):
        block = document.blocks[stamp_of(document, "1").dxf.name]
        next(iter(block.query("TEXT"))).dxf.text = "Store"

    for edit in (by_attribute, by_text):
        (results.parents[1] / "rec/corrections.yaml").unlink(missing_ok=True)
        taken(results, edited_dxf(results, edit, name))
        (entry,) = entries_of(results)
        assert (entry["element"], entry["name"]) == ("room", "Store")


def test_furniture_erased_in_the_drawing(results):
    def edit(document):
        (piece,) = [e for e in document.modelspace() if "furniture" in read_facts(e)]
        piece.destroy()

    taken(results, edited_dxf(results, edit))
    (entry,) = entries_of(results)
    assert (entry["element"], entry["action"]) == ("furniture", "remove")
    assert len(run_again(results).furniture["kind"]) == 0


# --- other languages ---


@pytest.fixture(scope="module", params=["de", "fr", "es"])
def foreign(request, tmp_path_factory):
    return make_results(tmp_path_factory.mktemp(request.param), request.param)


def test_files_in_another_language_come_back(foreign):
    edits = {"json": edited_json, "ifc": edited_ifc, "dxf": edited_dxf}
    for name in FILES:
        edit = edits[name.rpartition(".")[2]]
        told = taken(foreign, edit(foreign, lambda _: None, name))
        assert "0 changes" in told[0] and entries_of(foreign) == []


@MODELS
def test_edits_of_a_model_in_another_language_are_taken(foreign, name):
    def edit(model):
        move_with_door(model)
        model.by_type("IfcSpace")[1].LongName = "Store"

    taken(foreign, edited_ifc(foreign, edit, name))
    wall, room = entries_of(foreign)
    (foreign.parents[1] / "rec/corrections.yaml").unlink()
    assert [end[0] for end in wall["line"]] == pytest.approx([4.25, 4.25], abs=0.001)
    assert (room["element"], room["name"]) == ("room", "Store")


@DRAWINGS
def test_edits_of_a_drawing_in_another_language_are_taken(foreign, name):
    def edit(document):
        entity_of(document, opening=1)[0].dxf.name = "WINDOW"
        stamp_of(document, "1").get_attrib("NAME").dxf.text = "Store"

    taken(foreign, edited_dxf(foreign, edit, name))
    opening, room = entries_of(foreign)
    (foreign.parents[1] / "rec/corrections.yaml").unlink()
    assert (opening["kind"], room["name"]) == ("window", "Store")


# --- corrections that are there ---


def test_what_was_said_before_stays_and_is_joined(results):
    reference = [{"element": "reference_point", "at": [x, 0], "world": [500000 + x, 5400000],
                  "crs": "EPSG:25832"} for x in (0, 9)]  # fmt: skip
    named = {"element": "room", "at": [5, 1], "name": "Foyer", "number": "2.14"}
    opening = {"element": "opening", "at": [4.1, 1.4], "kind": "door", "lintel_m": 2.05}
    write_entries(results, *reference, named, opening)
    run_again(results, with_files=True)
    taken(results, edited_json(results, lambda f: edit_door(f, width=100)))
    assert entries_of(results) == [*reference, named, {**opening, "width_m": 1.0}]
    taken(results, edited_json(results, lambda f: f["rooms"][1].update(name="Bar")))
    assert entries_of(results)[2] == named | {"name": "Bar"}


def test_what_was_added_before_is_moved_and_taken_out(results):
    added = {"element": "wall", "action": "add", "line": [[1, 2], [3, 2]], "thickness_m": 0.2}
    write_entries(results, added)
    run_again(results, with_files=True)

    def edit(floor):
        (wall,) = [w for w in floor["walls"] if w["start"]["y"] == w["end"]["y"] == -200]
        return wall

    def move(floor):
        wall = edit(floor)
        wall["start"]["y"] -= 50
        wall["end"]["y"] -= 50

    taken(results, edited_json(results, move))
    assert entries_of(results) == [{**added, "line": [[1.0, 2.5], [3.0, 2.5]]}]
    write_entries(results, added)
    taken(results, edited_json(results, lambda f: f["walls"].remove(edit(f))))
    assert entries_of(results) == []


def test_a_removed_wall_that_was_moved_before_is_removed(results):
    write_entries(results, {"element": "wall", "at": [4.05, 0.5], "line": [[4.2, 0], [4.2, 3]]})
    run_again(results, with_files=True)

    def edit(floor):
        (wall,) = [w for w in floor["walls"] if w["start"]["x"] == w["end"]["x"] == 420]
        floor["walls"].remove(wall)
        floor["doors"] = [door for door in floor["doors"] if door["wallId"] != wall["id"]]

    taken(results, edited_json(results, edit))
    assert entries_of(results) == [{"element": "wall", "at": [4.05, 0.5], "action": "remove"}]
    assert 5 not in run_again(results, with_files=True).walls["wall"]


# --- what is refused ---


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("{", "no project of openPlan3D"),
        ("[]", "no project of openPlan3D"),
        ('{"floors": [{"walls": [{"id": "a", "start": {"x": NaN, "y": 0}}]}]}', "no project"),
        ('{"floors": [{"walls": []}], "name": "office"}', "0 of 12 elements"),
    ],
)
def test_what_is_no_project_of_the_plan_ends_in_one_line(results, text, fault):
    path = results.parent / "edited.json"
    path.write_text(text)
    with pytest.raises(StageError) as told:
        taken(results, path)
    assert str(told.value).startswith(f"{path}: ") and fault in str(told.value)


KEYS = {
    "walls": ("start", "end", "thickness"),
    "doors": ("wallId", "position", "width"),
    "furniture": ("position",),
}


@pytest.mark.parametrize(("table", "key"), [(t, k) for t, keys in KEYS.items() for k in keys])
@pytest.mark.parametrize("value", [None, [], "x", {"x": 1e999, "y": 0}, True])
def test_a_value_that_is_none_is_told_in_one_line(made, tmp_path, table, key, value):
    project = json.loads((made / "plan/plan.openplan3d.json").read_text())
    project["floors"][0][table][0][key] = value
    path = tmp_path / "edited.json"
    path.write_text(json.dumps(project))
    with pytest.raises(StageError) as told:
        taken(made, path)
    assert str(told.value).startswith(f"{path}: ") and "\n" not in str(told.value)


def test_a_wall_without_thickness_is_told_and_nothing_is_taken(results):
    path = edited_json(results, lambda floor: floor["walls"][0].update(thickness=0))
    with pytest.raises(StageError, match="thickness_m is 0"):
        taken(results, path)
    assert entries_of(results) == []


def test_the_command_tells_what_it_took_and_what_is_wrong(results, capfd):
    path = edited_json(results, move_wall)
    assert main(["take", str(path), str(results), "--by", "A. Bee"]) == 0
    assert_told(capfd.readouterr().out, file="plan.openplan3d.json", value="1 change")
    assert main(["take", "none.ifc", str(results)]) == 2
    told = capfd.readouterr().err
    assert told == "scanplan: none.ifc: does not exist; name the edited file\n"
    (line,) = (results.parents[1] / "rec/corrections.log").read_text().splitlines()
    assert json.loads(line)["said"]["by"] == "A. Bee"


def test_a_file_of_another_kind_or_none_is_refused(results):
    for name, fault in (("a.rvt", "is no .json, .ifc, .dxf"), ("a.ifc", "does not exist")):
        with pytest.raises(StageError, match=fault):
            taken(results, results.parent / name)


def test_numbers_of_the_plan_come_to_the_millimetre(results):
    taken(results, edited_json(results, move_wall))
    (entry,) = entries_of(results)
    assert np.allclose(entry["line"], np.round(entry["line"], 3), atol=0)


# --- walls of the regular drawing that are two of the plan ---


@pytest.fixture(scope="module")
def made_in_pieces(tmp_path_factory):
    """Results whose south wall is in two pieces, the longer one in the west, number 0."""
    rows = [((4.05, -0.1, -0.1, -0.1), 0.2, 7, 0, "observed"), *floorplan_making.WALLS[1:]]
    rows.append(((7.1, -0.1, 4.05, -0.1), 0.2, -1, -1, "observed"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(correcting.MADE, "walls", lambda: floorplan_making.walls(rows))
        return make_results(tmp_path_factory.mktemp("pieces"))


@pytest.fixture
def in_pieces(made_in_pieces, tmp_path):
    shutil.copytree(made_in_pieces.parents[1], tmp_path, dirs_exist_ok=True)
    return tmp_path / "results/office"


def south_wall(model):
    (wall,) = [w for w in model.by_type("IfcWall") if w.Tag == "0"]
    assert "6" not in {w.Tag for w in model.by_type("IfcWall")}
    return wall


def test_a_wall_of_two_pieces_removed_from_the_regular_model(in_pieces):
    def edit(model):
        wall = south_wall(model)
        (opening,) = [rel.RelatedOpeningElement for rel in wall.HasOpenings]
        (window,) = [rel.RelatedBuildingElement for rel in opening.HasFillings]
        for product in (window, opening, wall):
            model.remove(product)

    taken(in_pieces, edited_ifc(in_pieces, edit, "presentation.ifc"))
    assert [(e["element"], e["action"]) for e in entries_of(in_pieces)] == [("wall", "remove")] * 2
    assert run_again(in_pieces).walls["wall"].tolist() == [1, 2, 3, 4, 5]


def test_a_wall_of_two_pieces_moved_in_the_regular_files(in_pieces):
    lines_m = {
        "0": [[4.05, -0.3], [-0.1, -0.3]],
        "6": [[7.1, -0.3], [4.05, -0.3]],
    }
    edits = {
        "presentation.ifc": lambda m: shift(south_wall(m), y=-0.2),
        "presentation.dxf": lambda d: entity_of(d, wall=0)[0].translate(0, -0.2, 0),
    }
    for name, edit in edits.items():
        edited = (edited_ifc if name.endswith("ifc") else edited_dxf)(in_pieces, edit, name)
        write_entries(in_pieces)
        taken(in_pieces, edited)
        moved = [entry["line"] for entry in entries_of(in_pieces) if entry["element"] == "wall"]
        assert np.array(moved) == pytest.approx(np.array([*lines_m.values()]), abs=0.001), name
