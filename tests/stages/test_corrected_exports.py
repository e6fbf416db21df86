"""What a person corrected says so in every export, and names are letters to every reader."""

import json
import struct
from dataclasses import replace
from xml.etree import ElementTree

import ezdxf
import ifcopenshell
import numpy as np
import pandas as pd
import pyogrio
import pytest
from ifcopenshell.util.element import get_psets
from PIL import Image

from helpers.corrected_files import exported, read_texts
from scanplan.plan import floorplan_files, planning
from scanplan.store import schemas, tables
from scanplan.validation import confidence
from scanplan.validation.confidence_coefficients import COEFFICIENTS

CORRECTIONS = [
    {"element": "room", "at": [5, 1], "name": "Küche"},
    {"element": "wall", "at": [5.5, 3.0], "action": "keep"},
    {"element": "opening", "at": [1.6, -0.1], "kind": "door"},
    {"element": "opening", "at": [4.05, 1.5], "action": "remove"},
    {"element": "wall", "action": "add", "line": [[1, 2], [3, 2]], "thickness_m": 0.2},
]
# by hand: wall 2 kept, wall 5 without its door, wall 6 added; window 2 a door; room 1 named
SAID = {
    "wall": {2: "kept by hand", 5: "changed by hand", 6: "added by hand"},
    "opening": {2: "changed by hand"},
    "room": {1: "changed by hand"},
}


@pytest.fixture(scope="module")
def corrected(tmp_path_factory):
    return exported(tmp_path_factory.mktemp("corrected"), CORRECTIONS)


def said(numbers, corrections):
    pairs = zip(numbers, corrections, strict=True)
    return {int(number): text for number, text in pairs if isinstance(text, str) and text}


def test_geojson_says_so(corrected):
    features = json.loads(corrected["geojson"].read_text())["features"]
    for kind, expected in SAID.items():
        rows = [f["properties"] for f in features if f["properties"]["kind"] == kind]
        assert said([r[kind] for r in rows], [r["corrected"] for r in rows]) == expected


@pytest.mark.wording
@pytest.mark.parametrize("what", ["ifc", "editable"])
def test_building_models_say_so(corrected, what):
    model = ifcopenshell.open(corrected[what])
    found = {}
    for kind, classes in {"wall": ["IfcWall"], "opening": ["IfcDoor", "IfcWindow"]}.items():
        products = [p for ifc_class in classes for p in model.by_type(ifc_class)]
        texts = [get_psets(p)["Scanplan_Evidence"].get("Corrected") for p in products]
        found[kind] = said([p.Tag for p in products], texts)
    spaces = model.by_type("IfcSpace")
    texts = [get_psets(space)["Scanplan_Evidence"].get("Corrected") for space in spaces]
    assert found == {kind: SAID[kind] for kind in found}
    assert dict(zip([s.LongName for s in spaces], texts, strict=True)) == {
        "Room 0": None, "Küche": "changed by hand"
    }  # fmt: skip


def test_tables_and_layers_say_so(corrected):
    for kind, expected in SAID.items():
        rows = pd.read_csv(corrected[f"{kind}s_csv"])
        assert said(rows[kind], rows["corrected"]) == expected
        about, _, _, columns = pyogrio.raw.read(corrected["gpkg"], layer=f"{kind}s")
        layer = dict(zip(about["fields"], columns, strict=True))
        assert said(layer[kind], layer["corrected"]) == expected
    graph = json.loads(corrected["json"].read_text())
    ways = graph["ways"]
    assert said([w["opening"] for w in ways], [w["corrected"] for w in ways]) == SAID["opening"]
    assert (
        said([r["room"] for r in graph["rooms"]], [r["corrected"] for r in graph["rooms"]])
        == (SAID["room"])
    )


@pytest.mark.wording
def test_the_3d_model_says_so(corrected):
    content = corrected["glb"].read_bytes()
    (length,) = struct.unpack_from("<I", content, 12)
    nodes = json.loads(content[20 : 20 + length])["nodes"]
    found = {n["name"]: n["extras"]["corrected"] for n in nodes if "corrected" in n["extras"]}
    walls = {f"Wall {number}": text for number, text in SAID["wall"].items()}
    assert found == walls | {"Door 2": "changed by hand", "Küche": "changed by hand"}


@pytest.mark.wording
@pytest.mark.parametrize(("what", "n_around"), [("dxf", 4), ("regular", 0)])
def test_drawings_say_so_the_measured_one_on_a_layer_of_its_own(corrected, what, n_around):
    document = ezdxf.readfile(corrected[what])
    assert not document.audit().errors
    space = document.modelspace()
    assert len(space.query('LWPOLYLINE[layer=="A-ANNO-REVS"]')) == n_around
    axes = space.query('LWPOLYLINE[layer=="A-WALL-CNTR"]')
    facts = [[value for _, value in axis.get_xdata("SCANPLAN")] for axis in axes]
    walls = {f[f.index("wall") + 1]: f[f.index("corrected") + 1] for f in facts if "corrected" in f}
    assert walls == SAID["wall"]
    inserts = [{a.dxf.tag: a.dxf.text for a in i.attribs} for i in space.query("INSERT")]
    stated = {a.get("TAG", a.get("NAME")): a["CORRECTED"] for a in inserts}
    assert stated == {
        "door-0": "no", "door-2": "changed by hand", "Room 0": "no", "Küche": "changed by hand"
    }  # fmt: skip


@pytest.mark.wording
def test_sheets_show_it_and_explain_it(corrected, tmp_path):
    root = ElementTree.parse(corrected["svg"]).getroot()
    names = {e.get("id") for e in root.iter()}
    assert {"corrected-wall-2", "corrected-wall-5", "corrected-wall-6"} < names
    assert "corrected-door-2" in names and "corrected-door-0" not in names
    texts = ["".join(e.itertext()) for e in root.iter("{http://www.w3.org/2000/svg}text")]
    assert "corrected by hand *" in texts and "Küche *" in texts
    assert "Floor plan, as surveyed; 5 corrections by hand" in texts
    with Image.open(corrected["png"]) as image:
        shown = np.asarray(image.convert("L"), float)
    with Image.open(exported(tmp_path)["png"]) as image:
        before = np.asarray(image.convert("L"), float)
    assert shown.shape == before.shape and (np.abs(shown - before) > 60).mean() > 1e-3


def test_who_has_looked_at_an_element_need_not_verify_it(tmp_path):
    exported(tmp_path, CORRECTIONS)
    files = {table: tmp_path / f"corrected/{table}.parquet" for table in planning.TABLES}
    validation = {name: np.zeros(1) for name in schemas.VALIDATION.columns}
    validation["kind"] = np.array(["plan_rays"], object)
    # a level that nothing reaches
    strict = {name: models | {"level": 2.0} for name, models in COEFFICIENTS.items()}
    seen = replace(floorplan_files.read_floorplan(files), floor_z_m=0.0)
    rated = confidence.rate_elements(seen, validation, 0.05, strict)
    files["confidence"] = tmp_path / "confidence.parquet"
    tables.write_table(files["confidence"], schemas.CONFIDENCE, rated)
    plan = floorplan_files.read_floorplan(files)
    for table, kind in (("walls", "wall"), ("openings", "opening"), ("rooms", "room")):
        columns = getattr(plan, table)
        is_by_hand = np.isin(columns[kind], list(SAID[kind]))
        assert is_by_hand.any() and (columns["verify"] == ~is_by_hand).all()
        assert ((columns["doubt"] == "") == is_by_hand).all()


@pytest.mark.parametrize(
    "name",
    [
        *("=1+1", "'); DROP TABLE rooms; --", '"a", "b" & c', "$x_2$", "{dataset} (a]"),
        "a ^ C:\\P <b>ü</b> %%c",
    ],
)
def test_a_name_is_the_same_letters_to_every_reader(name, tmp_path):
    entry = {"element": "room", "at": [5, 1], "name": name}
    files = exported(tmp_path, [entry], name="office", project=name, storey=name)
    found = read_texts(files)
    # a spreadsheet shows no formula
    quoted = f"'{name}" if name.startswith("=") else name
    assert quoted in found.pop("csv")
    assert [kind for kind, texts in found.items() if name not in texts] == []
    document = ezdxf.readfile(files["dxf"])
    stamps = document.modelspace().query("INSERT")
    assert sum(stamp.dxf.name.startswith("ROOM-STAMP") for stamp in stamps) == 2
    assert not document.audit().errors


@pytest.mark.filterwarnings("ignore:Glyph")
def test_letters_that_the_font_lacks_are_told(tmp_path, caplog):
    files = exported(tmp_path, [{"element": "room", "at": [5, 1], "name": "厨房 Ж 🏠"}])
    assert "export_plan: 厨 房 🏠 are boxes in PDF and PNG" in caplog.text
    found = read_texts(files)
    assert all("厨房 Ж 🏠" in found[kind] for kind in ("ifc", "dxf", "svg", "geojson"))
    caplog.clear()
    exported(tmp_path, [{"element": "room", "at": [5, 1], "name": "Küche Ж"}])
    assert "boxes" not in caplog.text
