"""Models and drawings read back have the elements that they were made of, in the same places."""

import re

import numpy as np
import pytest
import shapely

from helpers.floorplan_making import OPENINGS, WALLS, furniture, openings, plan, walls
from helpers.quarter_disc import quarter
from scanplan.edited.dxf_reading import read_dxf
from scanplan.edited.ifc_reading import read_ifc
from scanplan.exports import dxf, ifc
from scanplan.exports.data import element_ids
from scanplan.exports.drafting.presentation import compose_presentation
from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings
from scanplan.exports.sheet.composition import compose_sheet

CATALOGUE = {
    "walls": {"brick": 0.2, "board": 0.1},
    "doors": {},
    "windows": {},
    "facade_m": 0.1,
    "classification": {},
    "codes": {"walls": {}, "doors": {}, "windows": {}},
}
# the east wall has one side, at x = 7.1: 0.1 m are assumed behind it
ROWS = [
    *OPENINGS,
    ((7.1, 1.0, 7.1, 2.0), 1, "door", 0.0, 2.0, 1, -1),
    ((7.1, 2.2, 7.1, 2.9), 1, "gap", np.nan, np.nan, 1, -1),
    ((4.05, 2.2, 4.05, 2.9), 5, "passage", np.nan, np.nan, 0, 1),
    ((2.0, 0.5, 3.0, 0.5), -1, "passage", np.nan, np.nan, 0, 1),
    ((2.0, 2.5, 3.0, 2.5), -1, "door", 0.0, 2.0, 0, 1),
    ((2.0, 1.5, 3.0, 1.5), -1, "glass", 0.0, 2.0, 0, 1),
]
MIDDLES_M = [
    ((-0.1, 1.0), (-0.1, 2.0)),
    ((4.05, 1.0), (4.05, 1.9)),
    ((1.0, -0.1), (2.2, -0.1)),
    ((7.15, 1.0), (7.15, 2.0)),
    ((7.15, 2.2), (7.15, 2.9)),
    ((4.05, 2.2), (4.05, 2.9)),
    ((2.0, 0.5), (3.0, 0.5)),
    ((2.0, 2.5), (3.0, 2.5)),
    ((2.0, 1.5), (3.0, 1.5)),
]
# leaves that stand open: hinged in the south, of one door to either side, and at both jambs
LEAVES = [
    shapely.box(6.2, 0.98, 7.1, 1.02),
    shapely.box(4.1, 0.98, 4.95, 1.02),
    shapely.box(-1.1, 1.98, -0.2, 2.02),
]


@pytest.fixture
def surveyed():
    columns = furniture(LEAVES)
    columns["kind"][:] = "leaf"
    return plan(openings=openings(ROWS), furniture=columns, floor_z_m=0.0, ceiling_z_m=2.5)


@pytest.fixture
def model_of(tmp_path):
    """Elements of a plan's model by number, or of the regular one of it."""

    def read(of, catalogue=None):
        ids = element_ids.ids_from_places(of)
        path = tmp_path / "plan.ifc"
        path.write_text(ifc.format_ifc(of, ids, catalogue=catalogue), encoding="utf-8")
        numbers = {
            global_id: (kind, number)
            for kind, columns in (("wall", of.walls), ("opening", of.openings))
            for global_id, number in zip(ids[kind], columns[kind].tolist(), strict=True)
        }
        found = [e for e in read_ifc(path).elements if e.kind in ("wall", "opening")]
        assert len(found) == len(numbers)
        return {numbers[element.key]: element for element in found}

    return read


@pytest.fixture
def drawing_of(tmp_path):
    """Elements of a sheet's drawing by number."""

    def read(sheet, unit="mm", edit=str):
        path = tmp_path / "plan.dxf"
        path.write_text(edit(dxf.format_dxf(sheet, unit)), encoding="utf-8")
        found = [e for e in read_dxf(path).elements if e.kind in ("wall", "opening")]
        return {(element.kind, int(element.key)): element for element in found}

    return read


def assert_openings(elements, rows=ROWS, middles_m=MIDDLES_M):
    for number, (row, middle_m) in enumerate(zip(rows, middles_m, strict=True)):
        found = elements["opening", number]
        assert found.facts["kind"] == row[2]
        ends_m = found.line_m[np.lexsort(found.line_m.T)]
        assert ends_m == pytest.approx(np.array(middle_m), abs=1e-4), row


def test_openings_of_a_model_are_where_they_were(surveyed, model_of):
    elements = model_of(surveyed)
    assert_openings(elements)
    assert elements["opening", 6].host == elements["opening", 7].host == ""


@pytest.mark.parametrize("unit", ["mm", "m"])
def test_openings_of_a_drawing_are_where_they_were(surveyed, drawing_of, unit):
    elements = drawing_of(compose_sheet(surveyed), unit)
    assert_openings(elements)
    # three leaves, of which each stands where it stood, hinged in the side that it opens to
    opens_m = {n: of.facts["opens_m"] for (_, n), of in elements.items() if "opens_m" in of.facts}
    assert opens_m.keys() == {0, 1, 3}
    assert opens_m[3] == pytest.approx([6.15, 1.0]) and opens_m[1] == pytest.approx([4.95, 1.0])


def test_a_regular_model_and_its_drawing_have_the_same_openings(surveyed, model_of, drawing_of):
    regular, drafted = draft_plan(surveyed, make_draft_settings(0.05, CATALOGUE))
    modelled = model_of(regular, CATALOGUE)
    drawn = drawing_of(compose_presentation(surveyed, regular, drafted))
    walls_of = {key for key in modelled if key[0] == "wall"}
    assert walls_of == {key for key in drawn if key[0] == "wall"} and len(walls_of) == 6
    for key in drawn:
        ends_m = [of[key].line_m[np.lexsort(of[key].line_m.T)] for of in (modelled, drawn)]
        across = np.abs(np.diff(ends_m, axis=0))[0].max(axis=0).min()
        assert across < 1e-4, key


def test_a_recess_is_in_the_drawing_as_in_the_model(model_of, drawing_of):
    # a gap of the east wall, and a face 0.2 m behind it
    gap = ((7.1, 1.0, 7.1, 2.2), 1, "gap", 0.0, 2.5, 1, -1)
    back = ((7.3, 1.0, 7.3, 2.2), np.nan, 0, -1, "observed")
    of = plan(walls=walls([*WALLS, back]), openings=openings([*OPENINGS, gap]))
    catalogue = {**CATALOGUE, "facade_m": 0.3}
    regular, drafted = draft_plan(of, make_draft_settings(0.05, catalogue))
    modelled = model_of(regular, catalogue)["opening", 3]
    drawn = drawing_of(compose_presentation(of, regular, drafted))["opening", 3]
    assert drawn.facts["kind"] == modelled.facts["kind"] == "gap"
    assert np.sort(drawn.line_m, 0) == pytest.approx(np.sort(modelled.line_m, 0), abs=1e-4)


def test_a_door_that_is_drawn_ajar_opens_to_its_side(model_of, drawing_of):
    # the leaf stands in the east, where a wall of 0.1 m ends in the way of its arc
    leaf = furniture([LEAVES[1]])
    leaf["kind"][:] = "leaf"
    pier = ((4.7, 1.2, 5.6, 1.2), 0.2, -1, -1, "observed")
    of = plan(walls=walls([*WALLS, pier]), furniture=leaf, floor_z_m=0.0, ceiling_z_m=2.5)
    sheet = compose_sheet(of)
    assert [symbol.block for symbol in sheet.symbols if symbol.is_hinged] == ["SWING-RIGHT-45"]
    regular, _ = draft_plan(of, make_draft_settings(0.05, CATALOGUE))
    for elements in (drawing_of(sheet), model_of(regular, CATALOGUE)):
        door = elements["opening", 1].facts
        assert door["kind"] == "door" and door["opens_m"][0] > 4.5


def test_walls_are_read_in_their_middle_whatever_their_corners(surveyed, model_of, drawing_of):
    # a spur of a mitre is no part of a wall's width, and neither is a hole as high as it is
    for elements in (model_of(surveyed), drawing_of(compose_sheet(surveyed))):
        assert elements["wall", 1].line_m[:, 0] == pytest.approx([7.15, 7.15], abs=1e-4)
        assert elements["wall", 5].line_m[:, 0] == pytest.approx([4.05, 4.05], abs=1e-4)


def test_a_wall_that_is_thicker_than_long_keeps_its_way(model_of):
    pier = ((2.0, 1.0, 2.1, 1.0), 0.3, -1, -1, "observed")
    element = model_of(plan(walls=walls([*WALLS, pier])))["wall", 6]
    assert element.line_m[:, 1] == pytest.approx([1.0, 1.0], abs=1e-4)
    assert element.facts["thickness_m"] == pytest.approx(0.3, abs=1e-4)


def test_doors_of_a_curved_wall_are_read_and_the_wall_as_a_whole(model_of, drawing_of):
    # 0.9 m along the chord in its middle, at 45 degrees
    middle, way = np.array([5.0, 5.0]) / np.sqrt(2), np.array([-1.0, 1.0]) / np.sqrt(2)
    line_m = np.array([middle - 0.45 * way, middle + 0.45 * way])
    door = (tuple(line_m.ravel()), 0, "door", 0.0, 2.0, 0, -1)
    ring = quarter(openings=openings([door], [(None, 0.2)]))
    for elements in (model_of(ring), drawing_of(compose_sheet(ring))):
        assert elements["wall", 0].is_bent
        assert_openings(elements, [door], [line_m[np.lexsort(line_m.T)]])


def test_blocks_of_older_releases_are_doors(surveyed, drawing_of):
    older = {"DOOR": "DOORWAY", "SWING-LEFT": "DOOR-1", "SWING-RIGHT": "DOOR-2"}

    def rename(text):
        return re.sub(
            r"^(DOOR|SWING-LEFT|SWING-RIGHT)$", lambda m: older[m[1]], text, flags=re.MULTILINE
        )

    now = drawing_of(compose_sheet(surveyed))
    before = drawing_of(compose_sheet(surveyed), edit=rename)
    assert now.keys() == before.keys()
    assert {before[key].facts["kind"] for key in now if now[key].facts.get("kind") == "door"} == {
        "door"
    }
