import json

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from scanplan.exports import geojson


def features(drawn, kind=None, evidence=None):
    found = json.loads(geojson.format_geojson(drawn, evidence))["features"]
    return [f for f in found if kind in (None, f["properties"]["kind"])]


def test_every_face_is_a_line_with_its_figures():
    first = features(bare(), "face")[0]
    assert first["geometry"] == {"type": "LineString", "coordinates": [[0.0, 0.0], [4.0, 3.0]]}
    assert first["properties"] == {
        "kind": "face", "face": 0, "length_m": 5.0, "nx": -0.6, "ny": 0.8,
        "n_points": 100, "n_scans": 3,
        "rmse_m": 0.01, "z_min_m": 0.0, "z_max_m": 2.5, "state": "observed", "wall": -1,
    }  # fmt: skip


def test_walls_openings_and_rooms_have_the_columns_of_their_tables():
    walls, openings, rooms = (features(plan(), kind) for kind in ("wall", "opening", "room"))
    assert [w["properties"]["thickness_m"] for w in walls] == [0.2, None, 0.2, 0.2, 0.2, 0.1]
    assert (
        walls[2]["properties"]["state"] == "inferred" and walls[2]["properties"]["verify"] is True
    )
    assert [(o["properties"]["type"], o["properties"]["width_m"]) for o in openings] == [
        ("door", 1.0), ("door", 0.9), ("window", 1.2),
    ]  # fmt: skip
    assert [r["properties"]["area_m2"] for r in rooms] == [12.0, 9.0]
    shapes = [shapely.from_geojson(json.dumps(r["geometry"])) for r in rooms]
    assert [s.area for s in shapes] == pytest.approx([12.0, 9.0])
    assert all(s.exterior.is_ccw for s in shapes)


def test_a_wall_lists_the_scans_that_show_it():
    walls = features(plan(), "wall", floorplan_making.evidence())
    assert walls[0]["properties"]["scan_ids"] == [5, 9]
    assert walls[0]["properties"]["t_ns"] == [5 * 10**9, 9 * 10**9]
    assert walls[2]["properties"]["scan_ids"] == []


def test_identifiers_are_unique():
    ids = [f["id"] for f in features(plan())]
    assert len(ids) == len(set(ids)) == 20


def test_it_says_that_the_coordinates_are_local_metres():
    collection = json.loads(geojson.format_geojson(plan()))
    assert collection["type"] == "FeatureCollection" and collection["name"] == "office"
    assert collection["crs"]["properties"]["name"].startswith('ENGCRS["local metres')
    assert "not longitude and latitude" in collection["note"] and collection["units"] == "m"


def test_lengths_agree_with_geometry_and_table():
    drawn = [f for f in features(plan()) if f["geometry"]["type"] == "LineString"]
    measured = [shapely.from_geojson(json.dumps(f["geometry"])).length for f in drawn]
    np.testing.assert_allclose(measured, [f["properties"]["length_m"] for f in drawn], atol=1e-4)


def test_coordinates_have_a_tenth_of_a_millimetre_and_no_negative_zero():
    text = geojson.format_geojson(bare([(-1e-9, 0, 10, 1 / 3, -1)]))
    assert json.loads(text)["features"][0]["geometry"]["coordinates"] == [
        [0.0, 0.0],
        [10.0, 0.3333],
    ]
    assert "-0.0]" not in text


def test_an_infinite_number_is_refused():
    with pytest.raises(ValueError, match="JSON"):
        geojson.format_geojson(
            plan(faces=floorplan_making.faces() | {"z_max_m": np.full(9, np.inf)})
        )


def test_a_name_with_quotes_and_accents_survives():
    assert json.loads(geojson.format_geojson(plan(name='Bât. "A"')))["name"] == 'Bât. "A"'


def test_furniture_is_a_polygon_with_its_evidence():
    (piece,) = features(plan(furniture=floorplan_making.furniture()), "furniture")
    assert piece["id"] == "furniture-0"
    assert piece["properties"] == {
        "kind": "furniture", "furniture": 0, "area_m2": 0.5, "z_min_m": 0.3, "z_max_m": 0.9,
        "n_points": 60, "n_scans": 2, "named": "",
    }  # fmt: skip
    assert shapely.from_geojson(json.dumps(piece["geometry"])).area == pytest.approx(0.5)


def test_an_outline_that_touches_itself_but_for_rounding_is_valid():
    # two squares that meet at (1, 1), the second corner there off by a millionth of a millimetre
    pinched = shapely.Polygon(
        [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (1, 2), (1 - 1e-9, 1), (0, 1)]
    )
    drawn = plan(furniture=floorplan_making.furniture([pinched]))
    (piece,) = features(drawn, "furniture")
    shape = shapely.from_geojson(json.dumps(piece["geometry"]))
    assert pinched.is_valid and shape.is_valid and shape.area == pytest.approx(2)
