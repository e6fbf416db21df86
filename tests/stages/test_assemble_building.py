"""Two storeys of the plan drawn by hand as one model and one drawing."""

from collections import Counter

import ezdxf
import ifcopenshell
import ifcopenshell.util.placement
import ifcopenshell.validate
import numpy as np
import pytest

from assemble_building import assemble_building
from export_files import export_files
from export_plan import export_plan
from helpers import floorplan_making
from helpers.default_settings import SETTINGS
from helpers.report_making import registration
from scanplan.errors import StageError
from scanplan.plan import planning
from scanplan.project import stage_settings
from scanplan.store import schemas, tables

NAMES = ("geojson", "dxf", "svg", "pdf", "png", "ifc", "pgm", "yaml", "ids", "known")


@pytest.fixture(scope="module")
def floors(tmp_path_factory):
    """The files of two floors of different names, whose scans saw the floor at -0.3 m."""
    files = {"ifc": [], "dxf": [], "free": []}
    for name in ("floor_0", "floor_1"):
        folder = tmp_path_factory.mktemp(name)
        plan = {table: folder / f"{table}.parquet" for table in planning.TABLES}
        notes = {"floor_z_m": "-0.3", "ceiling_z_m": "2.3"}
        for table, schema in planning.TABLES.items():
            own = notes if table == "free" else None
            tables.write_table(plan[table], schema, getattr(floorplan_making, table)(), notes=own)
        plan["registration"] = folder / "registration.parquet"
        tables.write_table(plan["registration"], schemas.REGISTRATION, registration())
        outputs = {kind: folder / f"plan.{kind}" for kind in NAMES}
        export_plan(plan, outputs, name=name, settings=stage_settings.select_drawing(SETTINGS))
        of_files = stage_settings.select_files(SETTINGS)
        written = {kind: outputs[kind] for kind in ("ifc", "ids", "known")}
        export_files(plan, written, name=name, source=name, settings=of_files)
        for kind in files:
            files[kind].append(plan["free"] if kind == "free" else outputs[kind])
    return files


def storey(name, elevation_m, place=(0.0, 0.0, 0.0)):
    return {"name": name, "elevation_m": elevation_m, "place": place}


def building(floors, folder, *storeys):
    outputs = {kind: folder / f"building.{kind}" for kind in ("ifc", "dxf")}
    assemble_building(floors, outputs, name="house", storeys=storeys)
    return outputs


@pytest.fixture(scope="module")
def house(floors, tmp_path_factory):
    """The upper storey turned by a right angle, and moved by 10 m along x."""
    upper = storey("First", 3.0, (10.0, 0.0, 90.0))
    return building(floors, tmp_path_factory.mktemp("house"), storey("Ground", 0.0), upper)


def test_the_model_is_one_building_of_two_storeys(house, floors):
    model = ifcopenshell.open(house["ifc"])
    counts = {c: len(model.by_type(c)) for c in ("IfcProject", "IfcSite", "IfcBuilding")}
    assert set(counts.values()) == {1}
    storeys = model.by_type("IfcBuildingStorey")
    assert [(s.Name, s.Elevation) for s in storeys] == [("Ground", 0.0), ("First", 3.0)]
    of_one = ifcopenshell.open(floors["ifc"][0])
    for kind in ("IfcWall", "IfcDoor", "IfcWindow", "IfcSpace"):
        assert len(model.by_type(kind)) == 2 * len(of_one.by_type(kind))
    ids = {wall.GlobalId for wall in model.by_type("IfcWall")}
    assert {wall.GlobalId for wall in of_one.by_type("IfcWall")} < ids


def test_a_storey_lies_where_it_is_placed(house, floors):
    def corners(path):
        walls = ifcopenshell.open(path).by_type("IfcWall")
        places = [w.ObjectPlacement for w in walls]
        where = map(ifcopenshell.util.placement.get_local_placement, places)
        return np.array(sorted(tuple(np.round(matrix[:3, 3], 6)) for matrix in where))

    walls = corners(house["ifc"])
    own = corners(floors["ifc"][0])
    turned = np.column_stack([10 - own[:, 1], own[:, 0], own[:, 2] + 3.0])
    expected = sorted(map(tuple, np.concatenate([own, turned])))
    np.testing.assert_allclose(walls, expected, atol=2e-6)


# ifcopenshell leaves the file of its rules open
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_the_model_is_valid(house):
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(house["ifc"]), logger, express_rules=True)
    assert logger.statements == []


def test_the_drawing_has_each_storey_on_layers_of_its_own(house, floors):
    drawing = ezdxf.readfile(house["dxf"])
    assert not drawing.audit().has_errors
    own = ezdxf.readfile(floors["dxf"][0])
    assert drawing.units == own.units
    entities = list(drawing.modelspace())
    for prefix, file in zip(("1-", "2-"), floors["dxf"], strict=True):
        of_storey = [e for e in entities if e.dxf.layer.startswith(prefix)]
        own_kinds = Counter(e.dxftype() for e in ezdxf.readfile(file).modelspace())
        assert Counter(e.dxftype() for e in of_storey) == own_kinds
    names = {entity.dxf.layer for entity in own.modelspace()} - {"0", "Defpoints"}
    assert {f"{n}-{name}" for n in (1, 2) for name in names} <= {
        layer.dxf.name for layer in drawing.layers
    }


def test_the_same_floors_give_the_same_model(house, floors, tmp_path):
    upper = storey("First", 3.0, (10.0, 0.0, 90.0))
    again = building(floors, tmp_path, storey("Ground", 0.0), upper)
    assert again["ifc"].read_bytes() == house["ifc"].read_bytes()


def test_a_shared_frame_tells_the_elevations(floors, tmp_path):
    made = building(floors, tmp_path, storey("Ground", None), storey("First", 3.0))
    storeys = ifcopenshell.open(made["ifc"]).by_type("IfcBuildingStorey")
    assert [s.Elevation for s in storeys] == [-0.3, 3.0]


def test_a_storey_without_floor_and_elevation_ends_in_one_line(floors, tmp_path):
    free = tmp_path / "free.parquet"
    tables.write_table(free, planning.TABLES["free"], floorplan_making.free())
    files = floors | {"free": [free, floors["free"][1]]}
    with pytest.raises(StageError, match="no floor was seen in storey Ground; give its elevation"):
        building(files, tmp_path, storey("Ground", None), storey("First", 3.0))
