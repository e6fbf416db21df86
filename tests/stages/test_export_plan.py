import json
from xml.etree import ElementTree

import ezdxf
import ifcopenshell
import numpy as np
import pytest
import yaml
from ifcopenshell.util.element import get_psets
from PIL import Image

from assemble_plan import assemble_plan
from export_plan import export_plan
from helpers import floorplan_making, house_making, ifc_volumes
from helpers.toy_rooms import HEIGHT_M
from scanplan.errors import StageError
from scanplan.plan import planning
from scanplan.store import schemas, tables

SETTINGS = {
    "assumed_thickness_m": 0.1, "assumed_height_m": 2.5, "map_cell_m": 0.05,
    "turn": True, "project": None, "storey": None, "dxf_unit": "mm",
}  # fmt: skip
TABLES = {
    "faces": (schemas.FACES, floorplan_making.faces),
    "walls": (schemas.PLAN_WALLS, floorplan_making.walls),
    "openings": (schemas.OPENINGS, floorplan_making.openings),
    "rooms": (schemas.ROOMS, floorplan_making.rooms),
    "free": (schemas.FREE, floorplan_making.free),
    "evidence": (schemas.EVIDENCE, floorplan_making.evidence),
}
NAMES = {
    "geojson": "plan.geojson", "dxf": "plan.dxf", "svg": "plan.svg", "pdf": "plan.pdf",
    "png": "plan.png", "ifc": "plan.ifc",
    "pgm": "map.pgm", "yaml": "map.yaml",
}  # fmt: skip


@pytest.fixture
def plan(tmp_path):
    paths = {name: tmp_path / f"{name}.parquet" for name in TABLES}
    for name, (schema, made) in TABLES.items():
        notes = {"floor_z_m": "0.0", "ceiling_z_m": str(floorplan_making.HEIGHT_M + 0.1)}
        tables.write_table(paths[name], schema, made(), notes=notes)
    return paths


def exported(plan, folder):
    outputs = {kind: folder / name for kind, name in NAMES.items()}
    export_plan(plan, outputs, name="office", settings=SETTINGS)
    return outputs


def test_all_files_hold_the_same_plan(plan, tmp_path):
    files = exported(plan, tmp_path / "plan")
    kinds = [f["properties"]["kind"] for f in json.loads(files["geojson"].read_text())["features"]]
    assert [kinds.count(kind) for kind in ("face", "wall", "opening", "room")] == [9, 6, 3, 2]
    assert len(ezdxf.readfile(files["dxf"]).modelspace().query('LWPOLYLINE[layer=="A-AREA"]')) == 2
    model = ifcopenshell.open(files["ifc"])
    heights = [
        get_psets(wall)["Qto_WallBaseQuantities"]["Height"] for wall in model.by_type("IfcWall")
    ]
    # up to the ceiling, which the scans show a little above what they show of the walls
    assert heights == pytest.approx([floorplan_making.HEIGHT_M + 0.1] * 6, abs=0.02)
    drawn = {e.get("id") for e in ElementTree.parse(files["svg"]).iter()}
    assert {"door-0", "door-1", "window-2"} <= drawn
    assert files["pdf"].read_bytes().startswith(b"%PDF")
    with Image.open(files["png"]) as picture:
        assert max(picture.size) == 2400
    about = yaml.safe_load(files["yaml"].read_text())
    with Image.open(files["yaml"].parent / about["image"]) as image:
        width, height = image.size
    assert (width * about["resolution"], height * about["resolution"]) == pytest.approx(
        (8.4, 4.4), abs=0.11
    )


def test_a_second_run_gives_the_same_bytes(plan, tmp_path):
    once, again = (exported(plan, tmp_path / folder) for folder in ("once", "again"))
    assert {kind: file.read_bytes() for kind, file in once.items()} == {
        k: f.read_bytes() for k, f in again.items()
    }


def test_faces_alone_are_enough(plan, tmp_path):
    tables.write_table(
        plan["walls"], schemas.PLAN_WALLS, floorplan_making.walls([]), allow_empty=True
    )
    tables.write_table(
        plan["openings"], schemas.OPENINGS, floorplan_making.openings([]), allow_empty=True
    )
    tables.write_table(plan["rooms"], schemas.ROOMS, floorplan_making.rooms([]), allow_empty=True)
    tables.write_table(plan["free"], schemas.FREE, floorplan_making.free([]), allow_empty=True)
    nobody = {name: values[:0] for name, values in floorplan_making.evidence().items()}
    tables.write_table(plan["evidence"], schemas.EVIDENCE, nobody, allow_empty=True)
    files = exported(plan, tmp_path / "plan")
    assert all(file.stat().st_size > 100 for file in files.values())


def test_a_planar_survey_has_the_assumed_height(plan, tmp_path):
    tables.write_table(plan["free"], schemas.FREE, floorplan_making.free())
    flat = floorplan_making.walls() | {"z_min_m": np.full(6, np.nan), "z_max_m": np.full(6, np.nan)}
    tables.write_table(plan["walls"], schemas.PLAN_WALLS, flat)
    model = ifcopenshell.open(exported(plan, tmp_path / "plan")["ifc"])
    wall = model.by_type("IfcWall")[0]
    assert get_psets(wall)["Qto_WallBaseQuantities"]["Height"] == SETTINGS["assumed_height_m"]
    assert get_psets(wall)["Scanplan_Evidence"]["HeightMeasured"] is False


def test_a_plan_of_nothing_is_told(plan, tmp_path):
    tables.write_table(plan["faces"], schemas.FACES, floorplan_making.faces([]), allow_empty=True)
    with pytest.raises(StageError, match="no rows"):
        exported(plan, tmp_path / "plan")


def true_house():
    """The wall between the house's two rooms as in truth.geojson; scans show no lintel: 2 m."""
    wall = {"kind": "wall", "thickness_m": 0.2, "height_m": HEIGHT_M}
    door = {"kind": "opening", "type": "door", "width_m": 0.9, "sill_m": 0.0, "lintel_m": 2.0}
    drawn = [(wall, [[4.1, 0.0], [4.1, 4.0]]), (door, [[4.1, 1.5], [4.1, 2.4]])]
    features = [
        {"type": "Feature", "properties": p, "geometry": {"type": "LineString", "coordinates": c}}
        for p, c in drawn
    ]
    return json.dumps({"type": "FeatureCollection", "features": features})


def test_walls_that_scans_show_from_both_sides_have_their_true_volume(tmp_path):
    inputs = house_making.write(tmp_path, house_making.segments())
    made = {name: tmp_path / f"plan_{name}.parquet" for name in planning.TABLES}
    assemble_plan(*inputs, made, settings=house_making.PLAN, n_scans=None, area_share=None)
    outputs = {kind: tmp_path / name for kind, name in NAMES.items()}
    # beams of 15 degrees hardly reach floor and ceiling of rooms of 4 m; another sensor's do
    free = tables.read_table(made["free"], schemas.FREE)
    heights = {"floor_z_m": "0.0", "ceiling_z_m": str(HEIGHT_M)}
    tables.write_table(made["free"], schemas.FREE, free, notes=heights)
    export_plan(made, outputs, name="house", settings=SETTINGS)
    model = ifcopenshell.open(outputs["ifc"])
    measured = [
        w
        for w in model.by_type("IfcWall")
        if get_psets(w)["Scanplan_Evidence"]["ThicknessMeasured"]
    ]
    found = {
        wall: ifc_volumes.match(wall, ifc_volumes.true_walls(true_house())) for wall in measured
    }
    assert len(found) == 1
    for wall, true_m3 in found.items():
        assert ifc_volumes.volume_m3(wall) == pytest.approx(true_m3, rel=0.03)
    assert ifc_volumes.compared(model, true_house())[1:] == pytest.approx([true_m3] * 2, rel=0.03)


def test_true_walls_that_meet_are_built_once(plan, tmp_path):
    model = ifcopenshell.open(exported(plan, tmp_path / "plan")["ifc"])
    thick = {"kind": "wall", "thickness_m": 0.2, "height_m": 2.5}
    lines = [
        ([7.1, -0.1], [-0.1, -0.1]),
        ([-0.1, -0.1], [-0.1, 3.1]),
        ([-0.1, 3.1], [7.1, 3.1]),
        ([4.05, -0.1], [4.05, 3.1]),
    ]
    drawn = [{"properties": thick, "geometry": {"coordinates": line}} for line in lines]
    count, _, true_m3 = ifc_volumes.compared(model, json.dumps({"features": drawn}))
    # each corner and each junction is in both its lines by a square, or a half, of the wall
    whole_m3 = (7.2 + 3.2 + 7.2 + 3.2) * 0.2 * 2.5
    assert count == 5
    assert true_m3 == pytest.approx(whole_m3 - (2 * 0.1**2 + 2 * 0.1 * 0.2) * 2.5)
