"""A plan of which it is known where it lies: every file puts a known point at the same place."""

import io
import json
from dataclasses import replace

import ezdxf
import ifcopenshell
import laspy
import numpy as np
import pyogrio
import pytest
import shapely
import trimesh

from helpers import floorplan_making
from scanplan.exports import dxf, geojson, ifc
from scanplan.exports.data import element_ids, element_tables, geopackage, mesh, point_cloud
from scanplan.exports.model_origin import NOWHERE, ModelOrigin, Site, find_site
from scanplan.exports.sheet.composition import compose_sheet, paper_words
from scanplan.exports.sheet.facts import SheetFacts, state_frame
from scanplan.plan.floorplan import GeoReference

# Stuttgart, turned by 30 degrees
SITE = Site("EPSG:25832", 513_000.25, 5_402_000.5, 245.0, 30.0)
CORNER_M = np.array([4.0, 3.0])  # of the first room
# cos 30 = 0.8660254, sin 30 = 0.5
WORLD_M = np.array([513_000.25 + 4 * 0.8660254 - 3 * 0.5, 5_402_000.5 + 4 * 0.5 + 3 * 0.8660254])
PLAN = floorplan_making.plan(floor_z_m=-0.3)


def holds(corners_m, tolerance_m=1e-3):
    """Whether one of some corners is the known point."""
    return np.hypot(*(np.asarray(corners_m)[:, :2] - WORLD_M).T).min() < tolerance_m


@pytest.fixture(scope="module")
def ids():
    return element_ids.ids_from_places(PLAN)


def test_the_known_point_is_where_it_was_worked_out():
    assert SITE.place(CORNER_M) == pytest.approx(WORLD_M, abs=1e-6)
    assert NOWHERE.place(CORNER_M).tolist() == CORNER_M.tolist()


def test_geojson_lies_there():
    collection = json.loads(geojson.format_geojson(PLAN, site=SITE))
    assert collection["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::25832"
    assert "EPSG:25832" in collection["note"]
    (room, _) = [f for f in collection["features"] if f["properties"]["kind"] == "room"]
    assert holds(room["geometry"]["coordinates"][0])
    face = next(f for f in collection["features"] if f["properties"]["kind"] == "face")
    (x0, y0), (x1, y1) = face["geometry"]["coordinates"]
    normal = [face["properties"][name] for name in ("nx", "ny")]
    # to the left of its line, as before
    assert np.array(normal) @ [-(y1 - y0), x1 - x0] == pytest.approx(
        np.hypot(x1 - x0, y1 - y0), abs=1e-3
    )


def test_gdal_finds_the_geopackage_there(ids, tmp_path):
    path = tmp_path / "plan.gpkg"
    layers = geopackage.plan_layers(PLAN, element_tables.tabulate_elements(PLAN, ids))
    geopackage.write_geopackage(path, layers, 10**18, SITE)
    about, _, shapes, _ = pyogrio.raw.read(path, layer="rooms")
    assert about["crs"] == "EPSG:25832"
    assert holds(shapely.get_coordinates(shapely.from_wkb(shapes)), 1e-6)
    own = Site("site grid", 100.0, 200.0)
    geopackage.write_geopackage(tmp_path / "own.gpkg", layers, 10**18, own)
    _, _, shapes, _ = pyogrio.raw.read(tmp_path / "own.gpkg", layer="rooms")
    corners_m = shapely.get_coordinates(shapely.from_wkb(shapes))
    assert np.hypot(*(corners_m - (104.0, 203.0)).T).min() < 1e-6


def test_the_dxf_states_where_its_model_space_lies():
    text = dxf.format_dxf(compose_sheet(PLAN), site=SITE)
    document = ezdxf.filemanagement.read(io.StringIO(text))
    place, epsg = document.modelspace().get_geodata().get_crs_transformation()
    assert epsg == 25832 and document.audit().errors == []
    # millimetres
    assert holds([list(place.transform((4000.0, 3000.0, 0)))], 1e-4)
    corners = [(x, y) for line in document.modelspace().query("LWPOLYLINE[layer=='A-AREA']")
               for x, y in line.get_points("xy")]  # fmt: skip
    assert holds([list(place.transform((x, y, 0))) for x, y in corners])


def test_the_building_model_lies_there(ids):
    text = ifc.format_ifc(PLAN, ids, ModelOrigin(site=SITE))
    model = ifcopenshell.file.from_string(text)
    (conversion,) = model.by_type("IfcMapConversion")
    turn = np.array([conversion.XAxisAbscissa, conversion.XAxisOrdinate])
    east, north = CORNER_M @ [turn, (-turn[1], turn[0])]
    assert holds([(conversion.Eastings + east, conversion.Northings + north)], 1e-6)
    assert conversion.TargetCRS.Name == "EPSG:25832"
    (site,) = model.by_type("IfcSite")
    # 13,005.5 m of ground east of 9 degrees, on a parallel with a radius of 4,211 km
    latitude, longitude = (
        sum(part / 60**order for order, part in enumerate([*angle[:2], angle[2] + angle[3] / 1e6]))
        for angle in (site.RefLatitude, site.RefLongitude)
    )
    assert (latitude, longitude) == pytest.approx((48.7710, 9.1769), abs=2e-4)
    assert site.RefElevation == SITE.height_m
    (storey,) = model.by_type("IfcBuilding")
    assert storey.ElevationOfRefHeight == pytest.approx(244.7)


def test_the_glb_lies_there_and_its_floor_at_its_height(ids):
    content = mesh.format_glb(PLAN, ids, SITE)
    scene = trimesh.load_scene(io.BytesIO(content), file_type="glb")
    length = int.from_bytes(content[12:16], "little")
    nodes = json.loads(content[20 : 20 + length])["nodes"]
    stated = next(node["extras"] for node in nodes if node["name"] == "Grid")
    east, up, south = scene.to_geometry().vertices.T
    world_m = np.column_stack([stated["east_m"] + east, stated["north_m"] - south])
    # of floats
    assert holds(world_m, 1e-4)
    assert stated["crs"] == "EPSG:25832" and stated["height_m"] == pytest.approx(244.7)
    assert up.min() == 0


def test_the_cloud_lies_there(tmp_path):
    path = tmp_path / "cloud.laz"
    point = np.array([[*CORNER_M, 1.5]], np.float32)
    point_cloud.write_laz(path, [(7, point, None)], 0.0, 10**18, SITE)
    cloud = laspy.read(path)
    assert holds(np.column_stack([cloud.x, cloud.y]), 1e-3)
    assert np.array(cloud.z) == pytest.approx([246.5]) and np.array(cloud["scan_id"]) == [7]
    (keys,) = [vlr for vlr in cloud.header.vlrs if vlr.record_id == 34735]
    assert {key.id: key.value_offset for key in keys.geo_keys}[3072] == 25832


def test_the_sheet_says_where_its_frame_lies():
    said = state_frame(SITE, None)
    facts = SheetFacts(frame=said)
    words = " ".join(word.text for word in paper_words(compose_sheet(PLAN, facts)))
    assert "EPSG:25832: origin E 513000.250 N 5402000.500, x axis 30.0000° from E, scale 1" in words
    assert state_frame(NOWHERE, None) == ""


def test_grid_north_is_drawn_where_the_map_lies_in_a_grid():
    """Its x axis is turned by 30 degrees from east, so that north is 60 degrees from that."""
    north = SITE.north
    assert north is not None and NOWHERE.north is None
    assert (north.angle_deg, north.kind) == (60.0, "grid north")
    sheet = compose_sheet(PLAN, SheetFacts(north=north), turn_deg=0.0)
    (arrow,) = [mark for mark in sheet.paper_marks if mark.element == "axis-N"]
    way = np.diff(arrow.paths[0][:, :2], axis=0)[0]
    # in the system that is straight up
    assert np.degrees(np.arctan2(way[1], way[0])) + SITE.turn_deg == pytest.approx(90.0)
    assert "grid north" in {word.text for word in paper_words(sheet)}
    stated = replace(SITE, north_deg=61.5).north
    assert stated is not None and (stated.angle_deg, stated.kind) == (61.5, "true north")


def test_reference_points_outdo_the_settings():
    stated = {"crs": "EPSG:3857", "east_m": 1.0, "north_m": 2.0, "height_m": 245.0,
              "turn_deg": 0.0, "north_deg": None}  # fmt: skip
    measured = GeoReference("EPSG:25832", SITE.east_m, SITE.north_m, np.radians(30), 0.0123)
    found = find_site(measured, stated)
    assert found.place(CORNER_M) == pytest.approx(WORLD_M, abs=1e-6)
    assert (found.crs, found.height_m) == ("EPSG:25832", 245.0)
    assert "residual 12 mm" in state_frame(found, measured)
    assert "check" not in state_frame(found, measured)
    checked = replace(measured, check_off_m=[("K1", 0.03), ("K2", 0.04)])
    # the root of (9 + 16) / 2
    assert "checks 35 mm" in state_frame(found, checked)
    assert find_site(None, stated).crs == "EPSG:3857"
