import json
from xml.etree import ElementTree

import ezdxf
import pytest
import yaml
from PIL import Image

from export_plan import export_plan
from helpers import floorplan_making
from scanplan.errors import StageError
from scanplan.store import schemas, tables

SETTINGS = {
    "assumed_thickness_m": 0.1, "assumed_height_m": 2.5, "map_cell_m": 0.05,
    "turn": True, "project": None, "storey": None, "dxf_unit": "mm",
    "author": "A. Bee", "organisation": None,
    "units": "m", "site": {},
    "range_offset_sigma_m": 0.01, "range_scale_sigma": 0.0002,
}  # fmt: skip
TABLES = {
    "faces": (schemas.FACES, floorplan_making.faces),
    "walls": (schemas.PLAN_WALLS, floorplan_making.walls),
    "openings": (schemas.OPENINGS, floorplan_making.openings),
    "rooms": (schemas.ROOMS, floorplan_making.rooms),
    "free": (schemas.FREE, floorplan_making.free),
    "furniture": (schemas.FURNITURE, floorplan_making.furniture),
    "evidence": (schemas.EVIDENCE, floorplan_making.evidence),
}
NAMES = {
    "geojson": "plan.geojson", "dxf": "plan.dxf", "svg": "plan.svg", "pdf": "plan.pdf",
    "png": "plan.png",
    "pgm": "map.pgm", "yaml": "map.yaml",
}  # fmt: skip


@pytest.fixture
def plan(tmp_path):
    paths = {name: tmp_path / f"{name}.parquet" for name in TABLES}
    for name, (schema, made) in TABLES.items():
        notes = {"floor_z_m": "0.0", "ceiling_z_m": str(floorplan_making.HEIGHT_M + 0.1)}
        tables.write_table(paths[name], schema, made(), notes=notes)
    return paths


def exported(plan, folder, **stated):
    outputs = {kind: folder / name for kind, name in NAMES.items()}
    export_plan(plan, outputs, name="office", settings=SETTINGS | stated)
    return outputs


def test_a_pdf_is_titled_by_the_project_that_is_named(plan, tmp_path):
    assert b"Floor plan of office" in exported(plan, tmp_path / "a")["pdf"].read_bytes()
    named = exported(plan, tmp_path / "b", project="Town hall")
    assert b"Floor plan of Town hall" in named["pdf"].read_bytes()


def test_all_files_hold_the_same_plan(plan, tmp_path):
    files = exported(plan, tmp_path / "plan")
    kinds = [f["properties"]["kind"] for f in json.loads(files["geojson"].read_text())["features"]]
    assert [kinds.count(kind) for kind in ("face", "wall", "opening", "room")] == [9, 6, 3, 2]
    assert len(ezdxf.readfile(files["dxf"]).modelspace().query('LWPOLYLINE[layer=="A-AREA"]')) == 2
    drawn = {e.get("id") for e in ElementTree.parse(files["svg"]).iter()}
    assert {"door-0", "door-1", "window-2"} <= drawn
    content = files["pdf"].read_bytes()
    assert content.startswith(b"%PDF") and b"A. Bee" in content
    assert "A. Bee" in files["svg"].read_text()
    with Image.open(files["png"]) as picture:
        assert picture.size == (1753, 1240)  # 150 dots an inch of A4
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


def test_a_plan_of_nothing_is_told(plan, tmp_path):
    tables.write_table(plan["faces"], schemas.FACES, floorplan_making.faces([]), allow_empty=True)
    with pytest.raises(StageError, match="no rows"):
        exported(plan, tmp_path / "plan")
