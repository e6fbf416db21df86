"""The regular plan as a building model that a modeller goes on with."""

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.classification
import ifcopenshell.util.element
import ifcopenshell.validate
import numpy as np
import pytest
import shapely
from ifctester import ids as requirements

from helpers import floorplan_making
from scanplan.exports import ifc
from scanplan.exports.data import element_ids
from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings

CATALOGUE = {
    "walls": {"board": 0.1, "brick": 0.2},
    "doors": {"leaf": 0.9, "gate": 1.0},
    "windows": {"pane": 1.2},
    "facade_m": 0.3,
    "classification": {
        **{"system": "Ours", "source": "Us", "walls": "W", "doors": "D", "windows": "G"},
        "titles": {"W": "Walls", "W.1": "Brickwork"},
    },
    "codes": {"walls": {"brick": "W.1"}, "doors": {"pane": "D.9"}, "windows": {}},
}
SETTINGS = make_draft_settings(0.05, CATALOGUE)
# an open leaf of the door between the rooms, hinged at its south jamb and standing to the east
LEAF = shapely.box(4.1, 0.98, 4.95, 1.02)
PIECE = shapely.box(1, 1, 2, 1.5)


def modelled(**tables):
    measured = floorplan_making.plan(**{"floor_z_m": 0.0} | tables)
    regular, _ = draft_plan(measured, SETTINGS)
    ids = element_ids.ids_from_places(measured)
    own_ids = element_ids.take_ids(ids, measured, regular)
    text = ifc.format_ifc(regular, own_ids, catalogue=CATALOGUE)
    return ifcopenshell.file.from_string(text)


def furnished():
    columns = floorplan_making.furniture([LEAF, PIECE])
    columns["kind"][0] = "leaf"
    return columns


@pytest.fixture(scope="module")
def model():
    return modelled(furniture=furnished(), ceiling_z_m=2.5)


def elements(model, ifc_class):
    return {element.Tag or element.Name: element for element in model.by_type(ifc_class)}


def psets(element):
    return ifcopenshell.util.element.get_psets(element)


# the rules' module is opened and left open by ifcopenshell
@pytest.mark.filterwarnings(
    "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
def test_it_is_valid_and_of_the_view_for_design_transfer(model):
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, log, express_rules=True)
    assert log.statements == []
    assert "DesignTransferView" in model.header.file_description.description[0]


def complete():
    """A model with all that may stand in one."""
    named = {"toilet": 1.0, "cooker": 1.6, "stairs": 2.2}
    columns = floorplan_making.furniture(
        [LEAF, PIECE, *(shapely.box(5, y, 5.5, y + 0.5) for y in (*named.values(), 0.2))]
    )
    columns["kind"][0], columns["kind"][-1] = "leaf", "column"
    columns["named"][2:5] = [*named]
    parting = ((2.0, 0.5, 2.0, 1.5), -1, "passage", np.nan, np.nan, 0, 1)
    rows = floorplan_making.openings([*floorplan_making.OPENINGS, parting])
    halves = [shapely.box(0, 0, 1.99, 3), shapely.box(2.01, 0, 4, 3), floorplan_making.ROOMS[1]]
    rooms = floorplan_making.rooms(halves)
    return modelled(furniture=columns, openings=rows, rooms=rooms, ceiling_z_m=2.5)


def test_it_keeps_what_we_promise_to_modellers(project_root):
    model = complete()
    path = project_root / "workflow/schemas/presentation_model.ids"
    demanded = requirements.open(str(path))
    demanded.validate(model)
    assert [spec.name for spec in demanded.specifications if not spec.status] == []
    # each is asked of something
    assert [of.name for of in demanded.specifications if not of.applicable_entities] == []
    # of another wall it is not told whether its thickness was measured
    torn = ifcopenshell.file.from_string(model.to_string())
    torn.remove(
        next(p for p in torn.by_type("IfcPropertySingleValue") if p.Name == "ThicknessFrom")
    )
    demanded.validate(torn)
    assert [spec.name for spec in demanded.specifications if not spec.status] == ["Walls"]


def test_types_are_those_of_the_catalogue_with_the_deviation_beside_them():
    walls = [*floorplan_making.WALLS]
    walls[5] = (walls[5][0], 0.112, *walls[5][2:])
    rows = [(((4.05, 1.0, 4.05, 1.88)), 5, "door", 0.0, 2.0, 0, 1), *floorplan_making.OPENINGS[::2]]
    model = modelled(walls=floorplan_making.walls(walls), openings=floorplan_making.openings(rows))
    named = {t.Name: sorted(w.Tag for w in t.Types[0].RelatedObjects)
             for t in model.by_type("IfcWallType")}  # fmt: skip
    assumed = "Wall 30 cm, thickness assumed"
    assert named == {"board": ["5"], "brick": ["0", "2", "3", "4"], assumed: ["1"]}
    assert sorted(t.Name for t in model.by_type("IfcDoorType")) == ["gate", "leaf"]
    assert [t.Name for t in model.by_type("IfcWindowType")] == ["pane"]
    board = psets(elements(model, "IfcWall")["5"])["Scanplan_Nominal"]
    assert board["MeasuredThickness"] == pytest.approx(0.112)
    assert board["ThicknessDeviation"] == pytest.approx(-0.012)
    leaf = psets(elements(model, "IfcDoor")["0"])["Scanplan_Nominal"]
    assert (leaf["MeasuredWidth"], leaf["WidthDeviation"]) == pytest.approx((0.88, 0.02))
    outer = elements(model, "IfcWall")["1"]
    assert psets(outer)["Scanplan_Nominal"]["ThicknessFrom"] == "assumed"
    assert psets(outer)["Scanplan_Nominal"]["PerhapsFurniture"] is False
    assert psets(outer)["Pset_WallCommon"]["IsExternal"] is True
    assert psets(outer)["Scanplan_Evidence"]["ThicknessMeasured"] is False


def test_codes_are_those_of_the_list_or_of_the_entry(model):
    def codes(element):
        return {
            (reference.ReferencedSource.Name, reference.Identification)
            for reference in ifcopenshell.util.classification.get_references(element)
        }

    walls = elements(model, "IfcWall")
    assert codes(walls["0"]) == {("Ours", "W.1")} and codes(walls["5"]) == {("Ours", "W")}
    assert codes(elements(model, "IfcDoor")["1"]) == {("Ours", "D")}
    assert codes(elements(model, "IfcWindow")["2"]) == {("Ours", "G")}
    (system,) = model.by_type("IfcClassification")
    assert (system.Source, system.Edition) == ("Us", None)


def test_codes_bear_their_titles_and_none_where_none_is_known(model):
    references = model.by_type("IfcClassificationReference")
    named = {reference.Identification: reference.Name for reference in references}
    assert named == {"W": "Walls", "W.1": "Brickwork", "D": None, "G": None}


@pytest.mark.parametrize(
    ("leaf", "operation"),
    [
        (LEAF, "SINGLE_SWING_RIGHT"),  # looking east, the south jamb is on the right
        (shapely.box(4.1, 1.88, 4.95, 1.92), "SINGLE_SWING_LEFT"),
        (shapely.box(3.15, 0.98, 4.0, 1.02), "SINGLE_SWING_LEFT"),  # to the west
    ],
)
def test_a_door_opens_as_its_leaf_stood(leaf, operation):
    columns = floorplan_making.furniture([leaf], "leaf")
    model = modelled(furniture=columns)
    door = elements(model, "IfcDoor")["1"]
    assert door.OperationType == operation
    assert ifcopenshell.util.element.get_type(door).OperationType == operation
    # it opens along its own y axis
    x, y, _ = door.ObjectPlacement.RelativePlacement.RefDirection.DirectionRatios
    to_leaf_m = np.array([leaf.centroid.x - 4.05, 0.0])
    assert np.array([-y, x]) @ to_leaf_m > 0


def test_what_is_cut_in_a_plan_has_a_symbol_in_it(model):
    for ifc_class in ("IfcWall", "IfcDoor", "IfcWindow", "IfcSpace", "IfcFurniture"):
        for element in model.by_type(ifc_class):
            shapes = {s.RepresentationIdentifier: s for s in element.Representation.Representations}
            (curves,) = shapes["FootPrint"].Items
            assert curves.Elements
    # a leaf 0.9 m long from its hinge, and the quarter of its way
    door = elements(model, "IfcDoor")["1"]
    *_, drawn = door.Representation.Representations
    leaf, way = drawn.Items[0].Elements
    assert np.ptp(leaf.Points.CoordList, axis=0) == pytest.approx([0.0, 0.9])
    assert [segment.is_a() for segment in way.Segments] == ["IfcArcIndex"]


def test_furniture_is_as_high_as_it_was_seen(model):
    (piece,) = model.by_type("IfcFurniture")
    shape = ifcopenshell.geom.create_shape(ifcopenshell.geom.settings(), piece)
    corners_m = np.array(shape.geometry.verts).reshape(-1, 3)
    assert np.ptp(corners_m, axis=0) == pytest.approx([1.0, 0.5, 0.9])


def test_elements_keep_the_ids_of_the_measured_model(model):
    measured = floorplan_making.plan(furniture=furnished(), floor_z_m=0.0, ceiling_z_m=2.5)
    ids = element_ids.ids_from_places(measured)
    assert [wall.GlobalId for wall in model.by_type("IfcWall")] == ids["wall"]
    assert [space.GlobalId for space in model.by_type("IfcSpace")] == ids["room"]
    # and only the model that is to be looked at has none of this
    looked_at = ifcopenshell.file.from_string(ifc.format_ifc(measured))
    assert looked_at.by_type("IfcFurniture") == looked_at.by_type("IfcClassification") == ()
