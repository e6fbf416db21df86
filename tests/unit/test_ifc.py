from dataclasses import replace
from datetime import UTC, datetime

import ifcopenshell
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.validate
import numpy as np
import pytest
import shapely
from ifctester import ids as requirements

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from helpers.ifc_volumes import volume_m3
from scanplan.exports import ifc
from scanplan.exports.data import element_ids
from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings
from scanplan.exports.model_origin import ModelOrigin, Site
from scanplan.exports.sheet.composition import compose_sheet
from scanplan.exports.sheet.locale import Locale, make_locale
from scanplan.project.catalogue_file import read_catalogue, translate_names
from scanplan.project.words_file import read_words

pytestmark = pytest.mark.wording

SEEN = {"floor_z_m": -0.3, "ceiling_z_m": 2.2}


def opened(drawn, **about):
    return ifcopenshell.file.from_string(ifc.format_ifc(drawn, **about))


def psets(product):
    return ifcopenshell.util.element.get_psets(product)


def faults(model, rules=False):
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, log, express_rules=rules)
    return log.statements


@pytest.fixture(scope="module")
def model():
    return opened(plan())


def short(element):
    """What an element is, and its number."""
    return element.Name.partition(",")[0]


@pytest.fixture(scope="module")
def seen():
    """The model of a plan whose floor and ceiling were seen."""
    return opened(plan(**SEEN))


# the rules' module is opened and left open by ifcopenshell
@pytest.mark.filterwarnings(
    "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
def test_it_is_valid_by_schema_and_by_the_rules_of_ifc4(seen):
    assert seen.schema == "IFC4"
    assert faults(seen, rules=True) == []


def test_walls_have_the_volume_of_the_plan(model):
    solid = [
        volume_m3(wall, disable_opening_subtractions=True) for wall in model.by_type("IfcWall")
    ]
    assert sum(solid) == pytest.approx(
        floorplan_making.FOOTPRINT_M2 * floorplan_making.HEIGHT_M, rel=1e-3
    )
    cut = [volume_m3(wall) for wall in model.by_type("IfcWall")]
    assert sum(cut) == pytest.approx(
        floorplan_making.FOOTPRINT_M2 * floorplan_making.HEIGHT_M - floorplan_making.VOID_M3,
        rel=1e-3,
    )


def test_a_wall_ends_where_it_was_seen_to_and_so_does_the_hole_in_it():
    top_m = np.array([np.nan] * 4 + [np.nan, 1.2])
    drawn = plan(walls=floorplan_making.walls() | {"top_m": top_m}, ceiling_z_m=2.5, floor_z_m=0.0)
    model = opened(drawn)
    assert faults(model) == []
    walls = model.by_type("IfcWall")
    stated = [ifcopenshell.util.element.get_psets(wall) for wall in walls]
    assert [s["Qto_WallBaseQuantities"]["Height"] for s in stated] == pytest.approx(
        [2.5] * 5 + [1.2]
    )
    assert [s["Scanplan_Evidence"]["HeightFrom"] for s in stated] == ["ceiling"] * 5 + [
        "top of the wall"
    ]
    solid_m3 = volume_m3(walls[5], disable_opening_subtractions=True)
    assert solid_m3 == pytest.approx(drawn.bodies[5].area * 1.2, rel=1e-3)
    assert volume_m3(walls[5]) == pytest.approx(solid_m3 - 0.9 * 0.1 * 1.2, rel=1e-3)
    door = next(d for d in model.by_type("IfcDoor") if short(d) == "Door 1")
    assert door.OverallHeight == pytest.approx(1.2)


def test_a_height_that_nothing_showed_is_said_to_be_assumed():
    walls = floorplan_making.walls() | {"z_max_m": np.full(6, 1.4)}
    model = opened(plan(walls=walls))
    stated = ifcopenshell.util.element.get_psets(model.by_type("IfcWall")[0])
    assert stated["Scanplan_Evidence"]["HeightFrom"] == "assumed"
    assert stated["Scanplan_Evidence"]["HeightMeasured"] is False


def test_the_tree_goes_from_the_project_to_walls_doors_and_spaces(model):
    (storey,) = model.by_type("IfcBuildingStorey")
    for wall in model.by_type("IfcWall"):
        assert ifcopenshell.util.element.get_container(wall) == storey
    for space in model.by_type("IfcSpace"):
        assert ifcopenshell.util.element.get_aggregate(space) == storey
    above = [ifcopenshell.util.element.get_aggregate(storey)]
    while above[-1] is not None:
        above.append(ifcopenshell.util.element.get_aggregate(above[-1]))
    assert [part.is_a() for part in above[:-1]] == ["IfcBuilding", "IfcSite", "IfcProject"]


def test_doors_and_windows_fill_openings_of_their_walls(model):
    assert len(model.by_type("IfcOpeningElement")) == 3
    hosts = {}
    for leaf in [*model.by_type("IfcDoor"), *model.by_type("IfcWindow")]:
        hole = leaf.FillsVoids[0].RelatingOpeningElement
        hosts[short(leaf)] = short(hole.VoidsElements[0].RelatingBuildingElement)
    assert hosts == {"Door 0": "Wall 4", "Door 1": "Wall 5", "Window 2": "Wall 0"}
    window = model.by_type("IfcWindow")[0]
    assert (window.OverallWidth, window.OverallHeight) == pytest.approx((1.2, 1.2))
    assert ifcopenshell.util.placement.get_local_placement(window.ObjectPlacement)[
        :3, 3
    ] == pytest.approx([1, -0.1, 0])


def test_spaces_are_the_rooms(model):
    for space, area in zip(model.by_type("IfcSpace"), (12.0, 9.0), strict=True):
        assert volume_m3(space) == pytest.approx(area * floorplan_making.HEIGHT_M)
        stated = ifcopenshell.util.element.get_psets(space)["Qto_SpaceBaseQuantities"]
        assert stated["NetFloorArea"] == pytest.approx(area)


def test_walls_say_how_well_they_are_known(model):
    east, north = (ifcopenshell.util.element.get_psets(model.by_type("IfcWall")[i]) for i in (1, 2))
    assert east["Scanplan_Evidence"]["ThicknessMeasured"] is False
    assert east["Qto_WallBaseQuantities"]["Width"] == pytest.approx(floorplan_making.ASSUMED_M)
    assert (
        north["Scanplan_Evidence"]["State"] == "inferred"
        and north["Scanplan_Evidence"]["VerifyOnSite"] is True
    )
    assert north["Scanplan_Evidence"]["OffsetStandardDeviation"] == pytest.approx(0.002)


def test_what_is_not_known_is_left_out():
    walls = floorplan_making.walls() | {"sigma_offset_m": np.full(6, np.nan)}
    model = opened(plan(walls=walls))
    stated = ifcopenshell.util.element.get_psets(model.by_type("IfcWall")[0])
    assert "OffsetStandardDeviation" not in stated["Scanplan_Evidence"]


def test_unknown_sills_and_lintels_are_as_usual_and_said_to_be():
    openings = floorplan_making.openings() | {
        "sill_m": np.full(3, np.nan),
        "lintel_m": np.full(3, np.nan),
    }
    model = opened(plan(openings=openings))
    door, window = model.by_type("IfcDoor")[0], model.by_type("IfcWindow")[0]
    assert (door.OverallHeight, window.OverallHeight) == pytest.approx((2.0, 1.1))
    assert ifcopenshell.util.element.get_psets(door)["Scanplan_Evidence"]["LintelMeasured"] is False
    assert faults(model) == []


def test_a_passage_is_a_hole_with_nothing_in_it():
    openings = floorplan_making.openings() | {"type": np.array(["passage"] * 3, object)}
    model = opened(plan(openings=openings))
    assert len(model.by_type("IfcOpeningElement")) == 3 and not model.by_type("IfcDoor")
    assert faults(model) == []


def test_a_door_in_no_wall_stands_alone():
    openings = floorplan_making.openings() | {"wall": np.full(3, -1, np.int32)}
    model = opened(plan(openings=openings))
    assert len(model.by_type("IfcDoor")) == 2 and not model.by_type("IfcOpeningElement")
    assert faults(model) == []


def test_identifiers_are_unique_and_the_same_for_the_same_plan(model):
    ids = [root.GlobalId for root in model.by_type("IfcRoot")]
    assert len(ids) == len(set(ids))
    assert ifc.format_ifc(plan()) == ifc.format_ifc(plan())


def test_two_walls_in_one_place_have_two_identifiers():
    walls = floorplan_making.walls([floorplan_making.WALLS[5], floorplan_making.WALLS[5]])
    model = opened(plan(walls=walls, openings=floorplan_making.openings([])))
    assert len({w.GlobalId for w in model.by_type("IfcWall")}) == 2


def test_a_plan_of_faces_alone_is_a_valid_model_without_walls():
    model = opened(bare())
    assert not model.by_type("IfcWall") and faults(model) == []


@pytest.mark.parametrize("drawn", [plan(**SEEN), plan(), bare()])
def test_it_states_what_the_repository_demands_of_it(drawn, project_root):
    demanded = requirements.open(str(project_root / "workflow/schemas/building_model.ids"))
    model = opened(drawn)
    demanded.validate(model)
    failed = {spec.name for spec in demanded.specifications if not spec.status}
    assert len(demanded.specifications) == 14 and failed == set()


def test_the_demands_are_such_that_a_model_can_fail_them(project_root):
    demanded = requirements.open(str(project_root / "workflow/schemas/building_model.ids"))
    model = opened(plan(**SEEN))
    model.remove(next(p for p in model.by_type("IfcPropertySingleValue") if p.Name == "State"))
    demanded.validate(model)
    assert [spec.name for spec in demanded.specifications if not spec.status] == ["Walls"]


def test_walls_say_whether_they_are_external_and_that_load_bearing_is_unknown(model):
    common = [psets(wall)["Pset_WallCommon"] for wall in model.by_type("IfcWall")]
    assert [values["IsExternal"] for values in common] == [True] * 5 + [False]
    assert all(values["LoadBearing"] is None for values in common)
    leaves = [*model.by_type("IfcDoor"), *model.by_type("IfcWindow")]
    external = {short(leaf): psets(leaf)[f"Pset_{leaf.is_a()[3:]}Common"] for leaf in leaves}
    assert {n: v["IsExternal"] for n, v in external.items()} == {
        "Door 0": True,
        "Door 1": False,
        "Window 2": True,
    }


def test_names_are_in_the_language_but_for_those_of_a_person():
    rooms = floorplan_making.rooms() | {"name": np.array(["wall", ""], object)}
    german = make_locale("cm", read_words("de"))
    drawn = replace(plan(rooms=rooms), room_word=german.say("Room"))
    model = opened(drawn, origin=ModelOrigin(locale=german))
    doors = [door.Name for door in model.by_type("IfcDoor")]
    assert doors == ["Tür 0, 100 cm, wall nach außen", "Tür 1, 90 cm, wall nach Raum 1"]
    walls = [wall.Name for wall in model.by_type("IfcWall")]
    assert walls[1] == "Wand 1, außen, Dicke angenommen" and walls[5] == "Wand 5, innen, 10 cm"


PROGRAMS = ("office", "scanplan", "Body", "Axis", "FootPrint", "Model", "Ours", "Us", "W", "D")
"""Names that are no words of a language: of the plan, of the program, of contexts and systems."""


def list_words(model):
    """The words that a model shows: names of its elements, and what their properties say.

    Kinds of openings (ObjectType) and enumerations of IFC are for programs.
    """
    shown = [
        *("IfcSpatialElement", "IfcBuildingElement", "IfcElementType", "IfcOpeningElement"),
        *("IfcMaterial", "IfcFurnishingElement", "IfcPresentationStyle", "IfcVirtualElement"),
    ]
    found = {of.Name for kind in shown for of in model.by_type(kind)}
    found |= {of.Category for of in model.by_type("IfcMaterial")}
    found |= {of.LayerSetName for of in model.by_type("IfcMaterialLayerSet")}
    found |= {of.FamilyName for of in model.by_type("IfcPerson")}
    values = [of.NominalValue for of in model.by_type("IfcPropertySingleValue")]
    found |= {value.wrappedValue for value in values if value is not None}
    texts = {text for text in found if isinstance(text, str) and any(map(str.isalpha, text))}
    return texts - {*PROGRAMS}


@pytest.mark.parametrize("is_regular", [False, True])
@pytest.mark.parametrize("language", ["de", "es", "fr"])
def test_nothing_that_a_person_reads_in_a_model_stays_english(language, is_regular):
    walls = floorplan_making.walls() | {"top_m": np.array([np.nan] * 5 + [1.2])}
    walls["corrected"][5] = "drawn by hand"
    walls["doubt"] = np.array(["", "may be open in part, bounds no room"] + [""] * 4, object)
    sizes = read_catalogue(None)

    def read(locale):
        drawn = plan(**SEEN, walls=walls, furniture=floorplan_making.furniture(kind="column"))
        drawn = replace(drawn, room_word=locale.say("Room"))
        named = translate_names(sizes, locale.say)
        if is_regular:
            drawn = draft_plan(drawn, make_draft_settings(0.05, named))[0]
        about = {"catalogue": named} if is_regular else {}
        return list_words(opened(drawn, origin=ModelOrigin(locale=locale), **about))

    english, other = read(make_locale("m", None)), read(make_locale("m", read_words(language)))
    assert len(english) > 30
    assert english & other == set()


def test_a_catalogue_of_ours_is_named_in_the_language_and_one_of_a_person_by_him(tmp_path):
    german = make_locale("m", read_words("de")).say
    ours = translate_names(read_catalogue(None), german)
    assert ours["walls"]["Ständerwand 100"] == 0.1 and ours["doors"]["Tür 90"] == 0.9
    path = tmp_path / "own.yaml"
    path.write_text(
        "walls: [{name: brick 115, size_m: 0.115, code: W}]\n"
        "doors: []\nwindows: []\nfacade_m: 0.3\n"
    )
    own = translate_names(read_catalogue(path), german)
    assert own["walls"] == {"brick 115": 0.115} and own["codes"]["walls"] == {"brick 115": "W"}
    assert translate_names(own | {"is_ours": True}, german)["codes"]["walls"] == {
        "Mauerwerk 115": "W"
    }
    # no two sizes of ours are of one name in any language
    for language in ("de", "es", "fr"):
        say = make_locale("m", read_words(language)).say
        for catalogue in (read_catalogue(None), read_catalogue("north_america")):
            named = translate_names(catalogue, say)
            for kind in ("walls", "doors", "windows"):
                assert len(named[kind]) == len(catalogue[kind])
                assert not set(named[kind]) & set(catalogue[kind])


def test_names_say_what_an_element_is_by_the_number_that_tables_have():
    rooms = floorplan_making.rooms() | {"name": np.array(["Foyer", ""], object)}
    walls = floorplan_making.walls() | {"top_m": np.array([np.nan] * 5 + [1.2])}
    model = opened(plan(rooms=rooms, walls=walls, ceiling_z_m=2.5, floor_z_m=0.0))
    names = {
        kind: [element.Name for element in model.by_type(f"Ifc{kind}")]
        for kind in ("Wall", "Door", "Window", "OpeningElement", "Slab")
    }
    assert names["Wall"] == [
        "Wall 0, exterior, 20 cm",
        "Wall 1, exterior, thickness assumed",
        "Wall 2, exterior, 20 cm, inferred",
        "Wall 3, exterior, 20 cm",
        "Wall 4, exterior, 20 cm",
        "Wall 5, interior, 10 cm, 1.20 m high",
    ]
    assert names["Door"] == ["Door 0, 1.00 m, Foyer to outside", "Door 1, 0.90 m, Foyer to Room 1"]
    assert names["Window"] == ["Window 2, 1.20 m, Foyer"]
    voids = ["Opening of door 0", "Opening of door 1", "Opening of window 2"]
    assert names["OpeningElement"] == voids and names["Slab"] == ["Floor slab"]
    for element in [*model.by_type("IfcWall"), *model.by_type("IfcDoor")]:
        assert short(element).split()[1] == element.Tag


@pytest.mark.parametrize(
    ("unit", "wall", "door"),
    [("m", "36.5 cm", "88.5 cm"), ("mm", "365 mm", "885 mm"), ("ft", "1'-2 1/4\"", "2'-10 3/4\"")],
)
def test_types_are_named_by_half_centimetres_in_the_unit_that_is_asked_for(unit, wall, door):
    walls, openings = floorplan_making.walls(), floorplan_making.openings()
    walls["thickness_m"][3] = 0.3649
    openings["y1_m"][1] = 1.886
    openings["width_m"][1] = 0.886
    drawn = plan(walls=walls, openings=openings)
    model = opened(drawn, origin=ModelOrigin(locale=Locale(unit)))
    layers = {
        of.Name: of.HasAssociations[0].RelatingMaterial.MaterialLayers[0].LayerThickness
        for of in model.by_type("IfcWallType")
    }
    assert layers[f"Wall {wall}"] == pytest.approx(0.365)
    assert f"Wall 3, exterior, {wall}" in {of.Name for of in model.by_type("IfcWall")}
    assert f"Door {door}" in {of.Name.partition(",")[0] for of in model.by_type("IfcDoorType")}


def test_walls_of_one_thickness_share_a_type_with_a_layer_of_it(model):
    types = {t.Name: t for t in model.by_type("IfcWallType")}
    assert {name: len(t.Types[0].RelatedObjects) for name, t in types.items()} == {
        "Wall 10 cm": 1,
        "Wall 10 cm, thickness assumed": 1,
        "Wall 20 cm": 4,
    }
    for wall in model.by_type("IfcWall"):
        usage = ifcopenshell.util.element.get_material(wall)
        layers = ifcopenshell.util.element.get_material(ifcopenshell.util.element.get_type(wall))
        assert usage.ForLayerSet == layers
        width_m = psets(wall)["Qto_WallBaseQuantities"]["Width"]
        assert layers.MaterialLayers[0].LayerThickness == pytest.approx(width_m)


def test_the_layer_lies_where_the_wall_does(model):
    offsets = {
        short(wall): ifcopenshell.util.element.get_material(wall).OffsetFromReferenceLine
        for wall in model.by_type("IfcWall")
    }
    # the east wall is seen from its left: all that is assumed lies to the right of its line
    assert offsets["Wall 0"] == pytest.approx(-0.1) and offsets["Wall 1"] == pytest.approx(-0.1)


def test_quantities_are_those_of_the_shapes(model):
    for wall in model.by_type("IfcWall"):
        stated = psets(wall)["Qto_WallBaseQuantities"]
        assert stated["NetVolume"] == pytest.approx(volume_m3(wall), rel=1e-3)
        solid_m3 = volume_m3(wall, disable_opening_subtractions=True)
        assert stated["GrossVolume"] == pytest.approx(solid_m3, rel=1e-3)
    north = psets(model.by_type("IfcWall")[5])["Qto_WallBaseQuantities"]
    assert north["NetSideArea"] == pytest.approx(3.2 * 2.5 - 0.9 * 2.0)
    door = next(d for d in model.by_type("IfcDoor") if short(d) == "Door 1")
    stated = psets(door)["Qto_DoorBaseQuantities"]
    assert (stated["Area"], stated["Perimeter"]) == pytest.approx((1.8, 5.8))
    hole = psets(door.FillsVoids[0].RelatingOpeningElement)["Qto_OpeningElementBaseQuantities"]
    assert (hole["Depth"], hole["Volume"]) == pytest.approx((0.1, 0.18), rel=1e-3)


def test_floor_and_ceiling_stand_where_they_were_seen(seen, model):
    assert not model.by_type("IfcSlab") and not model.by_type("IfcCovering")
    (slab,) = seen.by_type("IfcSlab")
    assert volume_m3(slab) == pytest.approx(7.4 * 3.4 * floorplan_making.ASSUMED_M, rel=1e-2)
    ceilings = seen.by_type("IfcCovering")
    assert [c.Name for c in ceilings] == ["Ceiling of Room 0", "Ceiling of Room 1"]
    covered = [c.CoversSpaces[0].RelatingSpace.LongName for c in ceilings]
    assert covered == ["Room 0", "Room 1"]
    (storey,) = seen.by_type("IfcBuildingStorey")
    assert storey.Elevation == 0.0
    placed = ifcopenshell.util.placement.get_local_placement(storey.ObjectPlacement)
    assert placed[2, 3] == pytest.approx(-0.3)


def test_spaces_say_what_bounds_them(seen):
    bounds = {}
    for rel in seen.by_type("IfcRelSpaceBoundary"):
        element = rel.RelatedBuildingElement
        at = (short(element), rel.InternalOrExternalBoundary, rel.PhysicalOrVirtualBoundary)
        bounds.setdefault(rel.RelatingSpace.LongName, []).append(at)
    assert sorted(bounds["Room 0"]) == [
        ("Ceiling of Room 0", "INTERNAL", "PHYSICAL"),
        ("Door 0", "EXTERNAL", "PHYSICAL"),
        ("Door 1", "INTERNAL", "PHYSICAL"),
        ("Floor slab", "INTERNAL", "PHYSICAL"),
        ("Wall 0", "EXTERNAL", "PHYSICAL"),
        ("Wall 3", "EXTERNAL", "PHYSICAL"),
        ("Wall 4", "EXTERNAL", "PHYSICAL"),
        ("Wall 5", "INTERNAL", "PHYSICAL"),
        ("Window 2", "EXTERNAL", "PHYSICAL"),
    ]


def corners_m(rel):
    """The corners of a boundary in the frame of its space, which is the storey's."""
    face = rel.ConnectionGeometry.SurfaceOnRelatingElement
    axes = ifcopenshell.util.placement.get_axis2placement(face.BasisSurface.Position)
    flat = np.array([p.Coordinates for p in face.OuterBoundary.Points])
    return flat @ axes[:3, :2].T + axes[:3, 3], axes[:3, 2]


def test_boundaries_lie_on_the_outline_and_face_outwards(seen):
    middle = np.array([2.0, 1.5, 1.25])
    for rel in seen.by_type("IfcRelSpaceBoundary"):
        if rel.RelatingSpace.LongName == "Room 0":
            corners, facing = corners_m(rel)
            assert (corners >= [-1e-6, -1e-6, -1e-6]).all()
            assert (corners <= [4 + 1e-6, 3 + 1e-6, 2.5 + 1e-6]).all()
            assert (corners.mean(axis=0) - middle) @ facing > 0.5
    door = next(
        r
        for r in seen.by_type("IfcRelSpaceBoundary")
        if (short(r.RelatedBuildingElement), r.RelatingSpace.LongName) == ("Door 1", "Room 0")
    )
    low, high = np.min(corners_m(door)[0], axis=0), np.max(corners_m(door)[0], axis=0)
    assert low == pytest.approx([4, 1.0, 0]) and high == pytest.approx([4, 1.9, 2])


def test_a_passage_is_a_virtual_boundary():
    openings = floorplan_making.openings() | {"type": np.array(["passage"] * 3, object)}
    model = opened(plan(openings=openings))
    virtual = {
        rel.RelatedBuildingElement.is_a()
        for rel in model.by_type("IfcRelSpaceBoundary")
        if rel.PhysicalOrVirtualBoundary == "VIRTUAL"
    }
    assert virtual == {"IfcOpeningElement"}


def test_walls_that_meet_are_connected_at_their_ends(model):
    met = {
        (short(r.RelatingElement), short(r.RelatedElement)): (
            r.RelatingConnectionType,
            r.RelatedConnectionType,
        )
        for r in model.by_type("IfcRelConnectsPathElements")
    }
    assert met["Wall 0", "Wall 1"] == ("ATSTART", "ATSTART")
    assert met["Wall 3", "Wall 4"] == ("ATEND", "ATSTART")
    assert met["Wall 0", "Wall 5"] == ("ATPATH", "ATSTART")
    assert ("Wall 1", "Wall 4") not in met and len(met) == 8


def test_elements_have_colours_and_doubt_its_own(model):
    colours = {}
    for wall in model.by_type("IfcWall"):
        solid = wall.Representation.Representations[1].Items[0]
        colours[short(wall)] = solid.StyledByItem[0].Styles[0].Name
    assert colours["Wall 0"] == "wall" and colours["Wall 2"] == "to verify"


def test_doubt_is_told_where_the_tables_have_it():
    openings = floorplan_making.openings() | {
        "p_true": np.array([0.9, 0.3, np.nan]),
        "verify": np.array([False, True, False]),
        "doubt": np.array(["", "few rays", ""], object),
    }
    model = opened(plan(openings=openings))
    evidence = {short(d): psets(d)["Scanplan_Evidence"] for d in model.by_type("IfcDoor")}
    assert evidence["Door 1"]["ProbabilityOfExistence"] == 0.3
    assert evidence["Door 1"]["Doubt"] == "few rays" and "Doubt" not in evidence["Door 0"]
    assert evidence["Door 1"]["VerifyOnSite"] is True
    assert evidence["Door 1"]["JoinsRooms"] == "Room 0 and Room 1"
    assert evidence["Door 0"]["JoinsRooms"] == "Room 0"


T_NS = 1_700_000_000 * 10**9


def test_author_organisation_and_the_surveys_time_stand_in_it():
    origin = ModelOrigin(author="A. Surveyor", organisation="Office", version="abc", t_ns=T_NS)
    model = opened(plan(), origin=origin)
    header = model.header.file_name
    assert header.time_stamp == "2023-11-14T22:13:20"
    assert header.author == ("A. Surveyor",) and header.organization == ("Office",)
    history = model.by_type("IfcWall")[0].OwnerHistory
    assert datetime.fromtimestamp(history.CreationDate, UTC).isoformat()[:10] == "2023-11-14"
    assert history.OwningUser.ThePerson.FamilyName == "A. Surveyor"
    assert history.OwningApplication.Version == "abc"
    assert faults(model) == []


def test_names_keep_their_letters_in_the_header():
    origin = ModelOrigin(author="Åsa \\ l'Ω", organisation="Géomètres SA")
    text = ifc.format_ifc(plan(name="étage"), origin=origin)
    assert text.isascii() and "?" not in text.partition("ENDSEC;")[0]
    header = ifcopenshell.file.from_string(text).header.file_name
    assert header.organization == ("Géomètres SA",)
    assert (header.name, *header.author) == ("étage", "Åsa \\ l'Ω")


def test_project_and_storey_are_named_as_they_are_stated():
    """Else by the survey, and as what was surveyed."""
    named = opened(plan(), origin=ModelOrigin(project="Town hall", storey="Ground floor"))
    kinds = ("IfcProject", "IfcBuilding", "IfcBuildingStorey")
    assert [named.by_type(kind)[0].Name for kind in kinds] == [
        *("Town hall", "Town hall", "Ground floor")
    ]
    assert opened(plan()).by_type("IfcProject")[0].Name == plan().name


def test_a_site_on_earth_is_stated_where_it_is_known(model):
    assert not model.by_type("IfcMapConversion")
    assert model.by_type("IfcGeometricRepresentationContext")[0].TrueNorth is None
    site = Site("EPSG:25832", 691000.5, 5334000.25, 512.0, turn_deg=90.0, north_deg=0.0)
    placed = opened(plan(), origin=ModelOrigin(site=site))
    (conversion,) = placed.by_type("IfcMapConversion")
    assert conversion.TargetCRS.Name == "EPSG:25832"
    assert (conversion.Eastings, conversion.Northings) == (691000.5, 5334000.25)
    assert (conversion.XAxisAbscissa, conversion.XAxisOrdinate) == pytest.approx((0, 1))
    context = placed.by_type("IfcGeometricRepresentationContext", include_subtypes=False)[0]
    assert context.TrueNorth.DirectionRatios == pytest.approx((1, 0))
    assert placed.by_type("IfcBuilding")[0].ElevationOfRefHeight == pytest.approx(512.0)
    assert faults(placed) == []


def test_given_ids_are_those_of_the_elements():
    drawn = plan()
    ids = element_ids.ids_from_places(plan(name="another"))
    model = opened(drawn, ids=ids)
    assert [wall.GlobalId for wall in model.by_type("IfcWall")] == ids["wall"]
    assert [space.GlobalId for space in model.by_type("IfcSpace")] == ids["room"]
    leaves = [*model.by_type("IfcDoor"), *model.by_type("IfcWindow")]
    assert [leaf.GlobalId for leaf in leaves] == ids["opening"]
    roots = [root.GlobalId for root in model.by_type("IfcRoot")]
    assert len(roots) == len(set(roots))


@pytest.mark.parametrize("name", ["it's", "line\nbreak", "<b>Raum</b>", 'Küche \\ "7"'])
def test_names_stay_words(name):
    drawn = plan(name=name, **SEEN)
    drawn.rooms["name"] = np.array([name, ""], object)
    model = opened(drawn)
    assert model.by_type("IfcProject")[0].Name == name
    assert model.by_type("IfcSpace")[0].LongName == name
    assert len(model.by_type("IfcWall")) == 6 and faults(model) == []


def test_a_column_is_as_high_as_the_storey_and_furniture_is_left_out():
    columns = floorplan_making.furniture(kind="column")
    model = opened(plan(furniture=columns, **SEEN))
    (column,) = model.by_type("IfcColumn")
    stated = psets(column)
    assert column.Name == "Column 0" and not faults(model)
    assert stated["Qto_ColumnBaseQuantities"]["GrossVolume"] == pytest.approx(0.5 * 2.5)
    assert volume_m3(column) == pytest.approx(0.5 * 2.5)
    assert stated["Scanplan_Evidence"]["Scans"] == 2
    assert not opened(plan(furniture=floorplan_making.furniture())).by_type("IfcColumn")


@pytest.mark.parametrize("is_regular", [False, True])
def test_rooms_have_their_area_between_walls_and_less_columns(is_regular):
    post = floorplan_making.furniture([shapely.box(1, 1, 1.5, 1.5)], kind="column")
    drawn = floorplan_making.plan(furniture=post, floor_z_m=0.0, ceiling_z_m=2.5)
    catalogue = read_catalogue(None) if is_regular else None
    if catalogue is not None:
        drawn, _ = draft_plan(drawn, make_draft_settings(0.05, catalogue))
    model = ifcopenshell.file.from_string(ifc.format_ifc(drawn, catalogue=catalogue))
    found = {
        space.Name: ifcopenshell.util.element.get_psets(space)["Qto_SpaceBaseQuantities"]
        for space in model.by_type("IfcSpace")
    }
    areas_m2 = [(of["GrossFloorArea"], of["NetFloorArea"]) for of in found.values()]
    assert areas_m2 == [pytest.approx((12, 11.75)), pytest.approx((9, 9))]
    assert found["0"]["NetVolume"] == pytest.approx(11.75 * 2.5)
    sheet = compose_sheet(drawn)
    assert [stamp.facts["AREA"] for stamp in sheet.stamps] == ["11.8 m²", "9.0 m²"]  # 11.75
