"""Drawings that are good, and the many that are not."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import simple_rooms as drawn
from scanplan.errors import StageError
from scanplan.lab.buildings import drawing_file


def area(kind, **values):
    """A square of 1 m in the box."""
    return drawn.feature(kind, "Polygon", [[[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]]], **values)


BAD_FEATURES = [
    (drawn.door(2, 0.2), r"feature 2 \(opening\): at \(2, 0.2\), 0.300 m off"),
    (drawn.door(3.9, -0.1), "reaches beyond its wall"),
    (drawn.door(2, -0.1, type="hatch"), "type is 'hatch'; expected one of door, window, passage"),
    (drawn.door(2, -0.1, sill_m=2.1), "lintel_m is 2.0; expected a number from 2.11"),
    (drawn.door(2, -0.1, lintel_m=9), "lintel_m is 9; expected a number from 0.01 to 2.5"),
    (drawn.door(2, -0.1, width_m="wide"), "width_m is 'wide'"),
    (drawn.wall((0, 0), (1, 1), thickness_m=None), "thickness_m is None"),
    (drawn.wall((0, 0), (1, 1), thickness_m=True), "thickness_m is True"),
    (
        drawn.wall((0, 0), (1, 1), thickness_m=200),
        "thickness_m is 200; expected a number from 0.01 to 2",
    ),
    (drawn.wall((0, 0), (1, float("nan"))), r"feature 2 \(wall\)"),
    (drawn.wall((1, 1), (1, 1)), r"feature 2 \(wall\)"),
    (
        drawn.wall((0, 0), (18000, 0)),
        "spans 18000.1 m, the limit is 2000 m; coordinates must be metres",
    ),
    (drawn.way((1, 1), (2, 2)), "1 walls and 2 features of kind waypoints"),
    (
        drawn.feature(
            "furniture", "Polygon", [[[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]], height_m=1
        ),
        "Self-intersection",
    ),
    (drawn.door(2, -0.1, glazed="yes"), "glazed is 'yes'; expected true or false"),
    (drawn.door(2, -0.1, leaf="folding"), "leaf is 'folding'; expected one of hinged, double"),
    (drawn.door(2, -0.1, leaf="hinged", open_deg=181), "open_deg is 181; expected a number from 0"),
    (drawn.door(2, -0.1, leaf="sliding", open_share=1.5), "open_share is 1.5"),
    (drawn.door(2, -0.1, leaf="hinged", hinge="top"), "hinge is 'top'; expected one of start, end"),
    (drawn.door(2, -0.1, leaf="hinged", side=3), "side is 3; expected one of left, right"),
    (drawn.door(2, -0.1, leaf="hinged", leaf_thickness_m=0), "leaf_thickness_m is 0"),
    (drawn.door(2, -0.1, leaf="hinged", leaf_glass=1), "leaf_glass is 1; expected true or false"),
    (drawn.door(2, -0.1, leaf="hinged", recess_m=0.3), "recess_m is 0.3; expected .* to 0.2"),
    (
        drawn.door(2, -0.1, leaf="hinged", recess_m=0.1, open_deg=120),
        "open_deg is 120 and its leaf hangs 0.080 m behind .* open it to 95",
    ),
    (drawn.door(2, -0.1, leaf="hinged", glazed=True), "has a leaf and is a door that is glazed"),
    (drawn.door(2, -0.1, leaf="hinged", type="passage"), "has a leaf and is a passage; expected"),
    (drawn.door(2, -0.1, frame_m=0.5), "frame_m is 0.5; expected a number from 0 to 0.49"),
    (drawn.wall((0, 0), (1, 1), material="brick"), "material is 'brick'; expected one of wall"),
    (drawn.wall((0, 0), (1, 1), material="glass"), "thickness_m is 0.2; expected .* to 0.05"),
    (drawn.wall((0, 0), (1, 1), curved="yes"), "curved is 'yes'; expected true or false"),
    (
        drawn.wall((0, 0), (1, 1), (2, 1), end_thickness_m=0.3),
        "end_thickness_m is 0.3, and it has 3 vertices; expected a wall of 2",
    ),
    (area("column", type="pillar"), "type is 'pillar'; expected one of column, pilaster"),
    (area("column", height_m=9), "height_m is 9; expected a number from 0.01 to 2.5"),
    (area("furniture", height_m=1, base_m=1), "base_m is 1; expected a number from 0 to 0.999"),
    (area("furniture", height_m=1, type=5), "type is 5; expected a word"),
    (area("ceiling"), "height_m is None"),
    (
        area("ceiling", height_m=2.0, rise_x=1.0),
        r"its underside is at 3.000 m at \(2, 1\); expected 0.01 to 2.5",
    ),
    (area("beam", underside_m=3), "underside_m is 3; expected a number from 0.01 to 2.5"),
    (area("void", depth_m=0), "depth_m is 0; expected a number from 0.1"),
    (area("stairs", rise_m=1, steps=1.5), "steps is 1.5, rise_m 1; expected a whole number"),
    (area("stairs", rise_m=0, steps=3), "steps is 3, rise_m 0; expected"),
    (area("stairs", rise_m=-1, steps=3), "lead down by 1 m, 1.00 m2 of them beside any void"),
    (
        drawn.feature("stairs", "Polygon", [[[1, 1], [2, 1], [1, 2], [1, 1]]], rise_m=1, steps=3),
        "has 3 corners and 0 holes; expected 4",
    ),
    (area("platform", height_m=3), "height_m is 3; expected a number from 0.01 to 2.5"),
    (
        drawn.feature("mirror", "LineString", [[1, -0.05], [2, -0.05]], lintel_m=2),
        r"at \(1.5, -0.05\), 0.050 m within a wall; draw it along the wall's face",
    ),
    (
        drawn.feature("mirror", "LineString", [[1, 0], [2, 0]], sill_m=1.0, lintel_m=0.5),
        "lintel_m is 0.5; expected a number from 1.01",
    ),
    (area("floor", polished="very"), "polished is 'very'; expected true or false"),
    (area("ground", z_m="low"), "z_m is 'low'"),
    (drawn.feature("facade", "LineString", [[9, 0], [9, 5]]), "height_m is None"),
    (drawn.feature("facade", "Point", [9, 0], height_m=3), "is a Point"),
    (drawn.feature("room", "Point", [9, 9], name="attic"), "'attic' at .* is not enclosed"),
    (drawn.feature("pond", "Point", [1, 1]), "kind is 'pond'; expected one of wall"),
    (drawn.feature("wall", "Point", [1, 1], thickness_m=0.1), "is a Point"),
    (drawn.feature("wall", "Circle", [1, 1], thickness_m=0.1), "cannot be read"),
    ({"type": "Feature", "properties": {"kind": "wall"}}, "cannot be read"),
    ("wall", "kind is None"),
]


def test_a_drawing_is_read():
    window = drawn.door(4.1, 1.5, type="window", sill_m=0.9)
    plan = drawn.plan(window, height_m=3.0)
    (opening,) = plan.openings
    assert (plan.height_m, plan.walls[0].height_m, plan.walls[0].thickness_m) == (3.0, 3.0, 0.2)
    assert (opening.thickness_m, opening.sill_m, opening.lintel_m, opening.type) == (
        0.2,
        0.9,
        2.0,
        "window",
    )
    assert sorted(opening.line_m.coords) == [(4.1, 1.0), (4.1, 2.0)]
    np.testing.assert_array_equal(plan.waypoints_m, [[1, 1], [3, 1], [3, 2]])


@pytest.mark.parametrize(("feature", "message"), BAD_FEATURES)
def test_wrong_features_are_refused_in_one_line(feature, message):
    with pytest.raises(StageError, match=message) as refusal:
        drawing_file.parse_drawing(drawn.text(drawn.WALLS, drawn.WAY, feature), "box.geojson")
    assert str(refusal.value).startswith("box.geojson:")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"", "is not JSON"),
        (b"\xff\xfe\x00", "is not JSON"),
        ("[" * 100_000, "is not JSON"),
        ("[]", "holds 'list'"),
        (json.dumps(drawn.WALLS), "holds 'Feature'"),
        ('{"type": "FeatureCollection"}', "FeatureCollection with its features"),
        (drawn.text(), "0 walls and 0 features of kind waypoints"),
        (drawn.text(drawn.WALLS, drawn.WAY, height_m=-1), "height_m is -1"),
    ],
)
def test_what_is_no_drawing_is_refused(text, message):
    with pytest.raises(StageError, match=message):
        drawing_file.parse_drawing(text, "box.geojson")


json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.floats()
    | st.text(max_size=5)
    | st.sampled_from(["wall", "LineString", "Point"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["kind", "type", "properties", "geometry", "coordinates"]),
            inner,
            max_size=4,
        )
    ),
    max_leaves=12,
)


@settings(max_examples=60)
@given(json_values)
def test_any_json_in_place_of_a_feature_is_refused_and_nothing_worse(value):
    with pytest.raises(StageError):
        drawing_file.parse_drawing(drawn.text(drawn.WALLS, drawn.WAY, value), "box.geojson")


@settings(max_examples=60)
@given(st.sampled_from(["thickness_m", "height_m", "material", "curved"]), json_values)
def test_any_value_of_a_property_is_taken_or_refused_and_nothing_worse(name, value):
    try:
        drawn.plan(drawn.wall((1, 2), (2, 2), **{name: value}))
    except StageError as refusal:
        assert name in str(refusal)


@settings(max_examples=60)
@given(
    st.sampled_from(["leaf", "open_deg", "hinge", "side", "frame_m", "recess_m", "leaf_glass"]),
    json_values,
)
def test_any_value_of_a_leafs_property_is_taken_or_refused_and_nothing_worse(name, value):
    try:
        drawn.plan(drawn.door(2, -0.1, **{"leaf": "hinged", name: value}))
    except StageError as refusal:
        assert name in str(refusal)
