"""The plan's files for other programs hold one plan, and its elements keep their ids."""

import json
import sqlite3
import zipfile
from unittest.mock import Mock

import bcf.v2.bcfxml
import ifcopenshell
import numpy as np
import pandas as pd
import pyogrio
import pytest
import trimesh
from evo.tools import file_interface
from ifcopenshell.util.element import get_psets

from assemble_plan import assemble_plan
from export_files import export_files
from helpers import floorplan_making, house_making, ifc_volumes
from helpers.default_settings import SETTINGS
from helpers.toy_rooms import HEIGHT_M
from scanplan.errors import StageError
from scanplan.exports import grid_map
from scanplan.plan import planning
from scanplan.project import export_formats, stage_settings
from scanplan.project.words_file import read_words
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import pose_columns

TABLES = {
    "faces": (schemas.FACES, floorplan_making.faces),
    "walls": (schemas.PLAN_WALLS, floorplan_making.walls),
    "openings": (schemas.OPENINGS, floorplan_making.openings),
    "rooms": (schemas.ROOMS, floorplan_making.rooms),
    "free": (schemas.FREE, floorplan_making.free),
}
FILES = export_formats.list_files(export_formats.FILES)
LAST_S = 1_712_345_678


def registration():
    scans = np.arange(4, dtype=np.int32)
    xyz_m = np.column_stack([scans, scans, np.full(4, 0.3)]).astype(float)
    known = {
        "scan_id": scans,
        "t_ns": (LAST_S - 3 + scans.astype(np.int64)) * 10**9,
        **pose_columns(xyz_m, np.tile([0.0, 0.0, 0.0, 1.0], (4, 1))),
    }
    graded = {
        **dict.fromkeys(
            ("prior_fitness", "refined_fitness", "rmse_m", *schemas.COVARIANCE), np.ones(4)
        ),
        "kept": np.array([True, False, True, True]),
        "reason": np.array(["", "icp_diverged", "", ""], object),
    }
    localised = {"gap_s": np.zeros(4), "covered": np.array([True, True, True, False])}
    return known | graded, known | localised


@pytest.fixture
def plan(tmp_path):
    paths = {name: tmp_path / f"{name}.parquet" for name in (*TABLES, "registration", "poses")}
    for name, (schema, made) in TABLES.items():
        notes = {"floor_z_m": "0.0", "ceiling_z_m": str(floorplan_making.HEIGHT_M + 0.1)}
        tables.write_table(paths[name], schema, made(), notes=notes)
    registered, localised = registration()
    tables.write_table(paths["registration"], schemas.REGISTRATION, registered)
    tables.write_table(paths["poses"], schemas.POSES, localised)
    return paths


def exported(plan, folder, wanted=FILES, source="a", words=None, **settings):
    outputs = {what: folder / FILES[what] for what in wanted}
    outputs |= {"ids": folder / "ids.parquet", "known": folder / "known_elements.parquet"}
    own = stage_settings.select_files(SETTINGS) | settings
    export_files(
        plan, outputs, name="office", source=source, settings=own, words=words, version="abc"
    )
    return outputs


def test_names_of_rooms_that_nobody_named_are_in_the_language_in_all_files(plan, tmp_path):
    rooms = floorplan_making.rooms() | {"name": np.array(["Room", ""], object)}
    tables.write_table(plan["rooms"], schemas.ROOMS, rooms)
    wanted = ["ifc", "rooms_csv", "imdf"]
    made = exported(plan, tmp_path / "de", wanted, words=read_words("de"), language="de")
    assert pd.read_csv(made["rooms_csv"])["name"].tolist() == ["Room", "Raum 1"]
    spaces = ifcopenshell.open(made["ifc"]).by_type("IfcSpace")
    assert [space.LongName for space in spaces] == ["Room", "Raum 1"]
    features = json.loads(made["imdf"].read_text())["features"]
    names = [f["properties"]["name"] for f in features if f["feature_type"] == "unit"]
    assert names == [{"de": "Room"}, {"de": "Raum 1"}]


def test_ways_are_as_wide_as_the_regular_drawing_has_them(plan, tmp_path):
    """The door between the rooms was seen 2 cm too narrow: it is drawn, and passed, as of 0.9 m."""
    openings = floorplan_making.openings()
    openings["y1_m"][1] -= 0.02
    openings["width_m"][1] = 0.88
    tables.write_table(plan["openings"], schemas.OPENINGS, openings)
    made = exported(plan, tmp_path, ["json", "openings_csv", "editable"])
    content = json.loads(made["json"].read_text())
    assert [(way["width_m"], way["nominal_width_m"]) for way in content["ways"]] == [
        *((1.0, 1.0), (0.88, 0.9))
    ]
    assert content["wheelchair"]["groups"] == [[0, 1]] and content["wheelchair"]["to_tape"] == [1]
    door = ifcopenshell.open(made["editable"]).by_guid(content["ways"][1]["global_id"])
    assert door.OverallWidth == pytest.approx(0.9)
    # drawn as measured
    made = exported(plan, tmp_path, ["openings_csv"], max_change_m=0.0)
    assert pd.read_csv(made["openings_csv"])["nominal_width_m"].isna()[1]


def exported_model(plan, folder):
    return ifcopenshell.open(exported(plan, folder, ["ifc"])["ifc"])


def test_independent_readers_find_the_same_plan_in_all_files(plan, tmp_path):
    files = exported(plan, tmp_path / "office")
    model = ifcopenshell.open(files["ifc"])
    ids = [wall.GlobalId for wall in model.by_type("IfcWall")]
    assert pd.read_csv(files["walls_csv"])["global_id"].tolist() == ids
    about, _, _, columns = pyogrio.raw.read(files["gpkg"], layer="walls")
    assert dict(zip(about["fields"], columns, strict=True))["global_id"].tolist() == ids
    rooms = [space.GlobalId for space in model.by_type("IfcSpace")]
    assert [r["global_id"] for r in json.loads(files["json"].read_text())["rooms"]] == rooms
    assert pd.read_csv(files["rooms_csv"])["global_id"].tolist() == rooms
    assert len(pd.read_csv(files["openings_csv"])) == 3
    assert len(trimesh.load_scene(files["glb"]).geometry) == 11
    written = tables.read_table(files["ids"], schemas.ELEMENT_IDS)
    assert written["global_id"][written["kind"] == "wall"].tolist() == ids


def test_no_date_is_invented_where_the_clock_was_not_set(plan, tmp_path):
    """It began at New Year, as computers without a battery do, and ended two hours later."""
    registered, _ = registration()
    new_year_s = 1_704_067_200
    registered["t_ns"] = (new_year_s + np.array([5, 6, 7, 7200], np.int64)) * 10**9
    tables.write_table(plan["registration"], schemas.REGISTRATION, registered)
    made = exported(plan, tmp_path, ["ifc", "bcf", "gpkg"])
    model = ifcopenshell.open(made["ifc"])
    assert model.by_type("IfcOwnerHistory")[0].CreationDate == 0
    assert model.header.file_name.time_stamp.startswith("1970-01-01")
    with zipfile.ZipFile(made["bcf"]) as topics:
        assert not any(b"2024" in topics.read(name) for name in topics.namelist())
    about = sqlite3.connect(made["gpkg"]).execute("SELECT last_change FROM gpkg_contents")
    assert {stamp[:10] for (stamp,) in about} == {"1970-01-01"}


def test_topics_select_what_is_in_the_model_that_they_name(plan, tmp_path):
    """A loose piece of wall in a room, to be verified, is left out of the regular model."""
    ends = {"x0_m": 1.0, "y0_m": 1.0, "x1_m": 1.3, "y1_m": 1.0}
    walls = floorplan_making.walls()
    made = {name: np.append(values, values[-1:]) for name, values in walls.items()}
    made |= {"wall": np.arange(7, dtype=np.int32), "verify": np.arange(7) == 6}
    for name, value in (ends | {"thickness_m": np.nan, "face_right": -1}).items():
        made[name][6] = value
    tables.write_table(plan["walls"], schemas.PLAN_WALLS, made)
    files = exported(plan, tmp_path, ["bcf", "ifc", "editable"])
    texts = {files[what].name: files[what].read_text() for what in ("ifc", "editable")}
    found = bcf.v2.bcfxml.BcfXml.load(files["bcf"])
    named = set()
    for handler in found.topics.values():
        (file,) = handler.markup.header.file
        (view,) = handler.viewpoints.values()
        for component in view.visualization_info.components.selection.component:
            assert f"'{component.ifc_guid}'" in texts[file.filename]
        named.add(file.filename)
    assert "plan.ifc" in named


def test_a_mask_is_drawn_once_for_its_image_and_its_settings(plan, tmp_path, monkeypatch):
    masks = ("draw_keepout", "draw_speed")
    drawn = {of: Mock(wraps=getattr(grid_map, of)) for of in masks}
    for of in masks:
        monkeypatch.setattr(grid_map, of, drawn[of])
    files = exported(plan, tmp_path, ["keepout_pgm", "keepout_yaml", "speed_pgm", "speed_yaml"])
    assert [drawn[of].call_count for of in masks] == [1, 1]
    assert "image: speed.pgm" in files["speed_yaml"].read_text()


def test_walls_are_as_high_as_the_ceiling_that_the_scans_show(plan, tmp_path):
    model = exported_model(plan, tmp_path)
    stated = [get_psets(wall)["Qto_WallBaseQuantities"] for wall in model.by_type("IfcWall")]
    heights = [quantities["Height"] for quantities in stated]
    assert heights == pytest.approx([floorplan_making.HEIGHT_M + 0.1] * 6, abs=0.02)


def test_evo_and_gdal_read_the_way_of_the_sensor(plan, tmp_path):
    files = exported(plan, tmp_path)
    kept = file_interface.read_tum_trajectory_file(str(files["trajectory"]))
    assert kept.timestamps.tolist() == [LAST_S - 3, LAST_S - 1, LAST_S]
    assert kept.positions_xyz.tolist() == [[0, 0, 0.3], [2, 2, 0.3], [3, 3, 0.3]]
    localised = file_interface.read_tum_trajectory_file(str(files["localiser"]))
    assert localised.positions_xyz[:, 0].tolist() == [0, 1, 2]
    layers = dict(pyogrio.list_layers(files["gpkg"]).tolist())
    assert (layers["trajectory"], layers["scans"]) == ("LineString", "Point")


def test_the_models_time_is_that_of_the_last_scan_and_the_keys_reach_it(plan, tmp_path):
    site = SETTINGS["plan"]["export"]["site"] | {"crs": "EPSG:25832", "east_m": 7.0}
    files = exported(plan, tmp_path, ["ifc"], author="A. Surveyor", organisation="X", site=site)
    model = ifcopenshell.open(files["ifc"])
    assert model.header.file_name.author == ("A. Surveyor",)
    assert model.by_type("IfcOwnerHistory")[0].CreationDate == LAST_S
    assert model.by_type("IfcMapConversion")[0].Eastings == 7.0


def test_only_what_is_asked_for_is_written(plan, tmp_path):
    exported(plan, tmp_path / "few", ["rooms_csv"])
    written = {p.name for p in (tmp_path / "few").rglob("*") if p.is_file()}
    assert written == {"rooms.csv", "ids.parquet", "known_elements.parquet"}


def test_files_of_formats_no_longer_asked_for_go(plan, tmp_path):
    before = exported(plan, tmp_path)
    outputs = {what: before[what] for what in ("ids", "known", "ifc")}
    settings = stage_settings.select_files(SETTINGS)
    unwanted = [before["glb"], tmp_path / "never.gpkg"]
    export_files(plan, outputs, name="office", source="a", settings=settings, unwanted=unwanted)
    assert not before["glb"].exists() and before["ifc"].exists()


def test_a_second_run_gives_the_same_bytes_with_its_register_and_without(plan, tmp_path):
    once = {w: f.read_bytes() for w, f in exported(plan, tmp_path / "once").items()}
    again = {w: f.read_bytes() for w, f in exported(plan, tmp_path / "once").items()}
    anew = {w: f.read_bytes() for w, f in exported(plan, tmp_path / "anew").items()}
    assert once == again == anew


def moved(columns, by_m):
    return columns | {end: columns[end] + by_m for end in ("x0_m", "y0_m", "x1_m", "y1_m")}


def test_elements_keep_their_ids_when_settings_move_them_a_little(plan, tmp_path):
    first = [wall.GlobalId for wall in exported_model(plan, tmp_path / "p").by_type("IfcWall")]
    (tmp_path / "p/plan/plan.ifc").unlink()
    tables.write_table(plan["walls"], schemas.PLAN_WALLS, moved(floorplan_making.walls(), 0.03))
    model = exported_model(plan, tmp_path / "p")
    assert [wall.GlobalId for wall in model.by_type("IfcWall")] == first
    without = exported_model(plan, tmp_path / "q").by_type("IfcWall")
    assert not set(first) & {wall.GlobalId for wall in without}


def test_another_source_has_ids_of_its_own(plan, tmp_path):
    exported(plan, tmp_path, ["ifc"], source="a")
    tables.write_table(plan["walls"], schemas.PLAN_WALLS, moved(floorplan_making.walls(), 0.03))
    other = exported(plan, tmp_path, ["ifc"], source="b")
    known = tables.read_table(other["known"], schemas.KNOWN_ELEMENTS)
    assert len(known["kind"]) == 11


def test_a_damaged_register_is_told(plan, tmp_path):
    (tmp_path / "known_elements.parquet").write_bytes(b"nothing")
    with pytest.raises(StageError, match="known_elements"):
        exported(plan, tmp_path, ["ifc"])


def test_faces_alone_are_enough(plan, tmp_path):
    for name in ("walls", "openings", "rooms", "free"):
        schema, made = TABLES[name]
        tables.write_table(plan[name], schema, made([]), allow_empty=True)
    files = exported(plan, tmp_path)
    assert all(file.stat().st_size > 50 for file in files.values())


def test_a_planar_survey_has_the_assumed_height(plan, tmp_path):
    tables.write_table(plan["free"], schemas.FREE, floorplan_making.free())
    flat = floorplan_making.walls() | {"z_min_m": np.full(6, np.nan), "z_max_m": np.full(6, np.nan)}
    tables.write_table(plan["walls"], schemas.PLAN_WALLS, flat)
    model = exported_model(plan, tmp_path)
    wall = model.by_type("IfcWall")[0]
    assert (
        get_psets(wall)["Qto_WallBaseQuantities"]["Height"]
        == SETTINGS["plan"]["export"]["assumed_height_m"]
    )
    assert get_psets(wall)["Scanplan_Evidence"]["HeightMeasured"] is False


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
    *inputs, registration = house_making.write(tmp_path, house_making.segments())
    made = {name: tmp_path / f"plan_{name}.parquet" for name in planning.TABLES}
    assemble_plan(
        *inputs, registration, made, settings=house_making.PLAN, n_scans=None, area_share=None
    )
    # beams of 15 degrees hardly reach floor and ceiling of rooms of 4 m; another sensor's do
    free = tables.read_table(made["free"], schemas.FREE)
    heights = {"floor_z_m": "0.0", "ceiling_z_m": str(HEIGHT_M)}
    tables.write_table(made["free"], schemas.FREE, free, notes=heights)
    model = exported_model(made | {"registration": registration}, tmp_path)
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
    model = exported_model(plan, tmp_path)
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


def test_reference_points_say_where_the_model_lies(plan, tmp_path):
    """A quarter of a turn, and an origin of their own; the settings have no say then."""
    points = {"crs": "EPSG:25833", "east_m": 5.0, "north_m": 6.0, "residual_m": 0.01}
    heights = {"floor_z_m": "0.0", "ceiling_z_m": "2.7"}
    notes = heights | {"georeference": json.dumps(points | {"rotation_rad": np.pi / 2})}
    tables.write_table(plan["free"], schemas.FREE, floorplan_making.free(), notes=notes)
    (conversion,) = exported_model(plan, tmp_path / "placed").by_type("IfcMapConversion")
    assert (conversion.Eastings, conversion.Northings) == (5.0, 6.0)
    assert (conversion.XAxisAbscissa, conversion.XAxisOrdinate) == pytest.approx((0.0, 1.0))
    assert conversion.TargetCRS.Name == "EPSG:25833"
