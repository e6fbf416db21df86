import re

import ifcopenshell
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.validate
import numpy as np
import pytest

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from helpers.ifc_volumes import volume_m3
from scanplan.exports import ifc


def opened(drawn):
    return ifcopenshell.file.from_string(ifc.format_ifc(drawn))


def faults(model, rules=False):
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, log, express_rules=rules)
    return log.statements


@pytest.fixture(scope="module")
def model():
    return opened(plan())


# the rules' module is opened and left open by ifcopenshell
@pytest.mark.filterwarnings(
    "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
def test_it_is_valid_by_schema_and_by_the_rules_of_ifc4(model):
    assert model.schema == "IFC4"
    assert faults(model, rules=True) == []


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
    door = next(d for d in model.by_type("IfcDoor") if d.Name == "Door 1")
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
        hosts[leaf.Name] = hole.VoidsElements[0].RelatingBuildingElement.Name
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
    assert re.search(r"FILE_NAME\('office','1970-01-01T00:00:00'", ifc.format_ifc(plan()))


def test_a_wall_keeps_its_identifier_when_another_goes():
    fewer = {name: values[2:] for name, values in floorplan_making.walls().items()}
    openings = floorplan_making.openings([])

    def identifiers(walls):
        model = opened(plan(walls=walls, openings=openings))
        return {wall.GlobalId for wall in model.by_type("IfcWall")}

    before = identifiers(floorplan_making.walls())
    after = identifiers(fewer)
    assert len(before) == 6 and len(after) == 4 and after < before


def test_two_walls_in_one_place_have_two_identifiers():
    walls = floorplan_making.walls([floorplan_making.WALLS[5], floorplan_making.WALLS[5]])
    model = opened(plan(walls=walls, openings=floorplan_making.openings([])))
    assert len({w.GlobalId for w in model.by_type("IfcWall")}) == 2


def test_a_plan_of_faces_alone_is_a_valid_model_without_walls():
    model = opened(bare())
    assert not model.by_type("IfcWall") and faults(model) == []
