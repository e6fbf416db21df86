"""GDAL reads the layers of a GeoPackage as they are."""

import sqlite3

import numpy as np
import pyogrio.raw
import pytest
import shapely

from helpers.floorplan_making import FOOTPRINT_M2, bare, plan
from scanplan.exports.data import element_ids, element_tables, geopackage


def layers_of(drawn):
    rows = element_tables.tabulate_elements(drawn, element_ids.ids_from_places(drawn))
    return geopackage.plan_layers(drawn, rows)


def written(path, drawn, t_ns=10**18):
    geopackage.write_geopackage(path, layers_of(drawn), t_ns)
    return path


def read(path, layer):
    about, _, shapes, columns = pyogrio.raw.read(path, layer=layer)
    return shapely.from_wkb(shapes), dict(zip(about["fields"], columns, strict=True)), about


def test_gdal_reads_walls_openings_rooms_and_free_space(tmp_path):
    file = written(tmp_path / "plan.gpkg", plan())
    found = dict(pyogrio.list_layers(file).tolist())
    assert found == dict.fromkeys(("walls", "openings", "rooms", "free_space"), "Polygon")
    walls, columns, about = read(file, "walls")
    assert shapely.union_all(walls).area == pytest.approx(FOOTPRINT_M2, rel=1e-3)
    assert columns["wall"].tolist() == [0, 1, 2, 3, 4, 5]
    assert columns["verify"].tolist() == [False, False, True, False, False, False]
    assert np.isnan(columns["thickness_m"][1]) and columns["thickness_m"][0] == 0.2
    assert "4326" not in about["crs"]
    rooms, columns, _ = read(file, "rooms")
    assert shapely.area(rooms).tolist() == pytest.approx([12.0, 9.0])
    assert columns["name"].tolist() == ["Room 0", "Room 1"]
    _, columns, _ = read(file, "openings")
    assert columns["type"].tolist() == ["door", "door", "window"]
    assert columns["room_b_name"].tolist() == [None, "Room 1", None]


def test_the_file_says_what_it_is(tmp_path):
    file = written(tmp_path / "plan.gpkg", plan())
    with sqlite3.connect(file) as database:
        assert database.execute("PRAGMA application_id").fetchone() == (0x47504B47,)
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert database.execute("PRAGMA foreign_key_check").fetchall() == []
        changed = database.execute("SELECT DISTINCT last_change FROM gpkg_contents").fetchall()
    assert changed == [("2001-09-09T01:46:40.000Z",)]


def test_the_same_plan_gives_the_same_bytes(tmp_path):
    once, again = (written(tmp_path / f"{n}.gpkg", plan()).read_bytes() for n in (1, 2))
    assert once == again


def test_layers_without_rows_are_layers(tmp_path):
    file = written(tmp_path / "plan.gpkg", bare())
    assert len(pyogrio.list_layers(file)) == 4
    assert len(read(file, "rooms")[0]) == 0


def test_names_stay_words(tmp_path):
    evil = "x'); DROP TABLE walls;--\n<b>"
    drawn = plan()
    drawn.rooms["name"] = np.array([evil, ""], object)
    _, columns, _ = read(written(tmp_path / "plan.gpkg", drawn), "rooms")
    assert columns["name"].tolist() == [evil, "Room 1"]
