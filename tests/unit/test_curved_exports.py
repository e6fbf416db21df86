"""Curved walls in drawings and models: a quarter of a ring between two straight walls."""

import io
import json
import math
import re

import ezdxf
import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.shape
import ifcopenshell.validate
import numpy as np
import pytest
import shapely

from helpers.quarter_disc import HEIGHT_M, INNER_M, OUTER_M, RADIUS_M, THICKNESS_M, WALLS, quarter
from scanplan.exports import dxf, envelope, geojson, ifc, svg
from scanplan.exports.data import element_tables
from scanplan.exports.drafting.presentation import compose_presentation
from scanplan.exports.drafting.regular_plan import DraftSettings, draft_plan
from scanplan.exports.sheet import composition

RING_M2 = math.pi / 4 * (OUTER_M**2 - INNER_M**2)


def test_the_ground_of_a_curved_wall_is_between_two_arcs():
    drawn = quarter()
    body = drawn.bodies[0]
    # a mitre gives as much outside as it takes inside; chords take a thousandth
    assert body.area == pytest.approx(RING_M2, rel=0.002)
    whole_m2 = RING_M2 + 2 * 5.0 * THICKNESS_M
    assert shapely.union_all(drawn.bodies).area == pytest.approx(whole_m2, rel=0.002)
    assert shapely.intersection(body, drawn.bodies[1]).area < 1e-6
    inside_m = np.hypot(*shapely.get_coordinates(body).T)
    assert np.abs(inside_m - RADIUS_M).max() < 2 * THICKNESS_M
    assert drawn.lengths_m == pytest.approx([math.pi / 2 * RADIUS_M, 5.0, 5.0])


def test_a_straight_wall_that_ends_at_a_curved_one_stops_at_its_surface():
    way = math.sqrt(0.5)
    radial = ((RADIUS_M * way, RADIUS_M * way, 7 * way, 7 * way), 0.1, -1, -1, "observed")
    drawn = quarter([*WALLS, radial])
    stub = drawn.bodies[3]
    assert stub.area == pytest.approx(0.1 * (7 - OUTER_M), rel=0.01)
    assert shapely.intersection(stub, drawn.bodies[0]).area < 1e-9


def test_a_curved_wall_seen_from_one_side_is_drawn_along_its_arc():
    single = [((5.0, 0.0, 0.0, 5.0), np.nan, 0, -1, "observed")]
    drawn = quarter(single)
    (line,) = shapely.get_parts(shapely.line_merge(shapely.union_all(drawn.single("observed"))))
    assert line.length == pytest.approx(math.pi / 2 * RADIUS_M, rel=1e-3)
    # what is assumed lies behind it, away from who saw it
    assert shapely.Point(0, 0).distance(drawn.bodies[0]) == pytest.approx(RADIUS_M, abs=0.003)


def test_svg_and_dxf_have_arcs_and_the_sheet_the_radius():
    sheet = composition.compose_sheet(quarter())
    assert "R 4.90" in {word.text for word in composition.plan_words(sheet)}
    radii_mm = {float(r) for r in re.findall(r"A([\d.]+) ", svg.format_svg_sheet(sheet))}
    scale = 1000 / sheet.page.scale
    for radius_m in (INNER_M, OUTER_M):
        assert min(abs(r - radius_m * scale) for r in radii_mm) < 0.05
    document = ezdxf.read(io.StringIO(dxf.format_dxf(sheet, "m")))
    axes = document.modelspace().query('LWPOLYLINE[layer=="A-WALL-CNTR"]')
    bulges = [abs(bulge) for axis in axes for *_, bulge in axis.get_points("xyb")]
    assert max(bulges) == pytest.approx(math.tan(math.pi / 8), abs=1e-6)
    walls = document.modelspace().query('LWPOLYLINE[layer=="A-WALL"]')
    assert any(bulge for wall in walls for *_, bulge in wall.get_points("xyb"))


def test_the_regular_drawing_has_arcs_too():
    measured = quarter()
    regular, changes = draft_plan(measured, DraftSettings(0.05, (THICKNESS_M,), (), (), 0.3))
    sheet = compose_presentation(measured, regular, changes)
    document = ezdxf.read(io.StringIO(dxf.format_dxf(sheet, "m")))
    for layer in ("A-WALL", "A-AREA"):
        outlines = document.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
        assert any(bulge for outline in outlines for *_, bulge in outline.get_points("xyb"))


def test_geojson_and_tables_have_the_length_of_the_arc():
    drawn = quarter()
    features = json.loads(geojson.format_geojson(drawn))["features"]
    (wall,) = (of for of in features if of["id"] == "wall-0")
    corners_m = np.array(wall["geometry"]["coordinates"])
    assert np.hypot(*corners_m.T) == pytest.approx(RADIUS_M, abs=1e-3)
    assert wall["properties"]["arc_radius_m"] == RADIUS_M
    assert wall["properties"]["length_m"] == pytest.approx(math.pi / 2 * RADIUS_M, abs=1e-4)
    assert features[-1]["id"] != "wall-0"
    ids = {"wall": ["a", "b", "c"], "opening": [], "room": ["d"]}
    rows = element_tables.tabulate_elements(drawn, ids)["walls"]
    assert rows["length_m"][0] == pytest.approx(math.pi / 2 * RADIUS_M, abs=1e-4)
    assert rows["arc_radius_m"] == [RADIUS_M, None, None]


def test_a_curved_wall_at_the_edge_is_external():
    assert envelope.find_external_walls(quarter()).all()


# the rules' module is opened and left open by ifcopenshell
@pytest.mark.filterwarnings(
    "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
def test_the_building_model_is_valid_with_arcs_as_axis_and_outline():
    model = ifcopenshell.file.from_string(ifc.format_ifc(quarter()))
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, log, express_rules=True)
    assert log.statements == []
    (wall,) = (of for of in model.by_type("IfcWall") if of.Tag == "0")
    axis, body = wall.Representation.Representations
    assert axis.Items[0].is_a("IfcTrimmedCurve")
    assert axis.Items[0].BasisCurve.Radius == pytest.approx(RADIUS_M)
    outline = body.Items[0].SweptArea.OuterCurve
    assert sum(part.is_a("IfcArcIndex") for part in outline.Segments) == 2
    shape = ifcopenshell.geom.create_shape(ifcopenshell.geom.settings(), wall)
    volume_m3 = ifcopenshell.util.shape.get_volume(shape.geometry)
    assert volume_m3 == pytest.approx(quarter().bodies[0].area * HEIGHT_M, rel=0.01)
