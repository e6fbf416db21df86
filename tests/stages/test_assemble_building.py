"""Two storeys of the plan drawn by hand as one model, one drawing and one set of sheets."""

import re
from collections import Counter

import ezdxf
import ifcopenshell
import ifcopenshell.util.placement
import ifcopenshell.validate
import numpy as np
import pytest
from ezdxf.math import Vec3

from assemble_building import assemble_building
from export_files import export_files
from export_plan import export_plan
from helpers import floorplan_making
from helpers.default_settings import SETTINGS
from helpers.refusals import refused
from helpers.report_making import registration
from scanplan.exports.building.sheet_set import compose_sheets
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.plan import planning
from scanplan.project import stage_settings, words_file
from scanplan.store import schemas, tables

NAMES = ("geojson", "dxf", "svg", "pdf", "png", "ifc", "pgm", "yaml", "ids", "known")


@pytest.fixture(scope="module")
def floors(tmp_path_factory):
    """The files of two floors of different names, whose scans saw the floor at -0.3 m."""
    files = {kind: [] for kind in ("ifc", *planning.TABLES)}
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
            files[kind].append(outputs["ifc"] if kind == "ifc" else plan[kind])
    return files


def storey(name, elevation_m, place=(0.0, 0.0, 0.0), *, aligned=True):
    dataset = f"survey of {name}"
    stated = {"name": name, "dataset": dataset, "elevation_m": elevation_m}
    return stated | {"place": place, "aligned": aligned}


def building(floors, folder, *storeys):
    outputs = {kind: folder / f"building.{kind}" for kind in ("ifc", "dxf", "pdf")}
    drawing = stage_settings.select_drawing(SETTINGS)
    settings = [drawing for _ in storeys]
    assemble_building(floors, outputs, name="house", storeys=storeys, settings=settings)
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
    own = ezdxf.readfile(floors["ifc"][0].with_suffix(".dxf"))
    assert drawing.units == own.units
    entities = list(drawing.modelspace())
    own_kinds = Counter(e.dxftype() for e in own.modelspace())
    for prefix in ("1-", "2-"):
        of_storey = [e for e in entities if e.dxf.layer.startswith(prefix)]
        assert Counter(e.dxftype() for e in of_storey) == own_kinds
    names = {entity.dxf.layer for entity in own.modelspace()} - {"0", "Defpoints"}
    assert {f"{n}-{name}" for n in (1, 2) for name in names} <= {
        layer.dxf.name for layer in drawing.layers
    }


def test_the_same_floors_give_the_same_model(house, floors, tmp_path):
    upper = storey("First", 3.0, (10.0, 0.0, 90.0))
    again = building(floors, tmp_path, storey("Ground", 0.0), upper)
    assert {kind: file.read_bytes() for kind, file in again.items()} == {
        kind: file.read_bytes() for kind, file in house.items()
    }


def test_each_storey_has_a_layout_with_its_name_that_shows_it_alone(house):
    document = ezdxf.readfile(house["dxf"])
    assert document.layout_names_in_taborder() == ["Model", "1 Ground", "2 First"]
    # the corner of a room, in the frame of the map, in millimetres
    corner = Vec3(7100, 3000)
    upper = Vec3(10_000 - 3000, 7100)
    sides = []
    for name, number, place in (("1 Ground", 1, corner), ("2 First", 2, upper)):
        layout = document.layout(name)
        (title,) = layout.query("INSERT")
        said = {attribute.dxf.tag: attribute.dxf.text for attribute in title.attribs}
        assert (said["STOREY"], said["PROJECT"]) == (name[2:], "house")
        assert said["SHEET"].endswith(f"{number} of 2")
        (port,) = [v for v in layout.query("VIEWPORT") if v.dxf.status > 1]
        assert {layer[:2] for layer in port.frozen_layers} == {f"{3 - number}-"}
        shown = port.get_transformation_matrix().transform(place) - port.dxf.center
        sides.append((round(shown.x, 3), round(shown.y, 3)))
    # of both the corner is 3.6 m and 1.5 m off the middle, 1:50; they lie as in the building, a
    # chain of dimensions more, 8 mm, left and below
    assert sides == [(72.0 + 4, 30.0 + 4), (-30.0 + 4, 72.0 + 4)]


def test_evidence_and_dimensions_of_storeys_are_those_of_their_own_drawings(house, floors):
    own = ezdxf.readfile(floors["ifc"][0].with_suffix(".dxf"))
    document = ezdxf.readfile(house["dxf"])

    def said(drawing, prefix):
        axes = drawing.modelspace().query(f'LWPOLYLINE[layer=="{prefix}A-WALL-CNTR"]')
        dimensions = drawing.modelspace().query(f'DIMENSION[layer=="{prefix}A-ANNO-DIMS"]')
        blocks = [drawing.blocks.get(dimension.dxf.geometry) for dimension in dimensions]
        texts = [text.text for block in blocks for text in block.query("MTEXT")]
        return [axis.get_xdata("SCANPLAN") for axis in axes], sorted(texts)

    axes, texts = said(own, "")
    assert len(axes) == 6 and "~7.40" in texts
    assert said(document, "1-") == said(document, "2-") == (axes, texts)


def test_a_set_of_sheets_has_a_page_of_each_storey(house):
    made = house["pdf"].read_bytes()
    boxes = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", made)
    # one lies, one stands
    assert sorted(boxes[0]) == sorted(boxes[1]) and len(boxes) == 2
    assert b"Floor plans of house" in made


def test_sheets_of_a_set_have_one_scale_and_lie_alike():
    small, large = floorplan_making.plan(), floorplan_making.bare([(0, 0, 60, 40, -1)])
    facts = [SheetFacts(storey=name) for name in ("Ground", "First")]
    # A3 holds the large one at 1:200 where it lies along the sheet, A2 at 1:150 where it does not
    for turn, expected, scale in ((True, 30.0, 150), (False, 0.0, 200)):
        sheets = compose_sheets([small, large], facts, [np.radians(-30), 0.0], turn=turn)
        assert sheets[0].page.scale == sheets[1].page.scale == scale
        own = [sheet.page.turn_deg for sheet in sheets]
        assert own == pytest.approx([expected - 30, expected])
    loose = compose_sheets([small, large], facts, [0.0, None], turn=True)[1]
    assert loose.page.turn_deg == pytest.approx(-large.main_direction_deg)


def test_a_shared_frame_tells_the_elevations(floors, tmp_path):
    made = building(floors, tmp_path, storey("Ground", None), storey("First", 3.0))
    storeys = ifcopenshell.open(made["ifc"]).by_type("IfcBuildingStorey")
    assert [s.Elevation for s in storeys] == [-0.3, 3.0]


def test_floors_that_were_seen_at_one_height_are_told(floors, tmp_path, caplog):
    made = building(floors, tmp_path, storey("{x} ^ \\ ё", None), storey("a <b>/c", None))
    said = "survey of {x} ^ \\ ё and survey of a <b>/c lie 0 m apart, storeys are at least 0.5 m"
    assert said in caplog.text
    names = [s.Name for s in ifcopenshell.open(made["ifc"]).by_type("IfcBuildingStorey")]
    assert names == ["{x} ^ \\ ё", "a <b>/c"]
    drawing = ezdxf.readfile(made["dxf"])
    assert drawing.layout_names_in_taborder()[1:] == ["1 {x}     ё", "2 a  b  c"]
    assert not drawing.audit().errors


def test_a_storey_without_floor_and_elevation_ends_in_one_line(floors, tmp_path):
    free = tmp_path / "free.parquet"
    tables.write_table(free, planning.TABLES["free"], floorplan_making.free())
    files = floors | {"free": [free, floors["free"][1]]}
    with refused(value="storey Ground", remedy="elevation_m"):
        building(files, tmp_path, storey("Ground", None), storey("First", 3.0))


def test_sheets_and_layers_are_written_as_the_storeys_receivers_ask(floors, tmp_path):
    storeys = (storey("Ground", 0.0), storey("First", 3.0))
    outputs = {kind: tmp_path / f"building.{kind}" for kind in ("ifc", "dxf", "pdf")}
    drawing = stage_settings.select_drawing(SETTINGS)
    receiver = words_file.read_receiver({"language": "de", "layers": "din"})
    assemble_building(
        floors,
        outputs,
        name="house",
        storeys=storeys,
        settings=[drawing | {"units": "cm"}, drawing],
        receivers=[receiver, receiver],
    )
    document = ezdxf.readfile(outputs["dxf"])
    layers = {layer.dxf.name for layer in document.layers}
    assert {"1-A-340---E-WAND", "2-A-340---E-WAND"} <= layers and "1-A-WALL" not in layers
    ground, first = list(document.layout_names_in_taborder())[1:]
    heads = [{t.dxf.text for t in document.layout(of).query("TEXT")} for of in (ground, first)]
    assert all("Legende" in of and "Legend" not in of for of in heads)
    # perimeters of the ground floor in whole centimetres, above in metres with a comma
    assert {"1400", "14,00"} & heads[0] == {"1400"} and {"1400", "14,00"} & heads[1] == {"14,00"}
