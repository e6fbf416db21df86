import json

import numpy as np
import pytest
import shapely

from scanplan import faces, plangeojson
from wallmaking import BARE, lengths_m, walls


@pytest.fixture
def merged():
    return faces.merge(walls([(0, 0, 4, 3), (10, 0, 10, 1 / 3)]), faces.MergeSettings(**BARE))


def test_every_face_is_a_line_with_its_figures(merged):
    collection = json.loads(plangeojson.dumps(merged, "office"))
    assert collection["type"] == "FeatureCollection"
    assert collection["name"] == "office"
    first = collection["features"][0]
    assert first["geometry"] == {"type": "LineString", "coordinates": [[0.0, 0.0], [4.0, 3.0]]}
    assert first["properties"] == {
        "kind": "face", "face": 0, "length_m": 5.0, "nx": -0.6, "ny": 0.8, "n_points": 100, "n_scans": 1,
        "rmse_m": 0.01, "z_min_m": 0.0, "z_max_m": 2.5,
    }  # fmt: skip


def test_it_says_that_the_coordinates_are_local_metres(merged):
    collection = json.loads(plangeojson.dumps(merged, "office"))
    assert "crs" not in collection
    assert "metres" in collection["note"]
    assert "not longitude and latitude" in collection["note"]


def test_lengths_agree_with_geometry_and_table(merged):
    features = json.loads(plangeojson.dumps(merged, "office"))["features"]
    drawn = [shapely.length(shapely.from_geojson(json.dumps(f["geometry"]))) for f in features]
    np.testing.assert_allclose(drawn, [f["properties"]["length_m"] for f in features], atol=1e-4)
    np.testing.assert_allclose(drawn, lengths_m(merged), atol=2e-4)


def test_coordinates_have_a_tenth_of_a_millimetre(merged):
    assert json.loads(plangeojson.dumps(merged, "office"))["features"][1]["geometry"]["coordinates"][1] == [
        10.0,
        0.3333,
    ]


def test_no_negative_zeros():
    merged = faces.merge(walls([(-1e-9, 0, 4, -1e-9)]), faces.MergeSettings(**BARE))
    assert "-0.0" not in plangeojson.dumps(merged, "office")


def test_a_number_that_is_not_finite_is_refused(merged):
    with pytest.raises(ValueError, match="JSON"):
        plangeojson.dumps(merged | {"z_max_m": np.full(2, np.inf)}, "office")


def test_a_name_with_quotes_and_accents_survives(merged):
    assert json.loads(plangeojson.dumps(merged, 'Bât. "A"'))["name"] == 'Bât. "A"'
