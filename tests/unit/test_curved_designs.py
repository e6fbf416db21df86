"""Curved walls of designs: read of what is drawn, and compared with what was built."""

import math
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers.curved_floor import CENTRE_M as BENT_M
from helpers.curved_floor import ENDS_M, HALF_M, surveyed
from helpers.curved_floor import RADIUS_M as RADIUS_OF_BENT_M
from helpers.drawn_floor_making import storey
from scanplan.changes import comparison
from scanplan.design import design_plan, design_reading, ifc_design
from scanplan.design.curved_ground import CurvedGround, find_curved_ground
from scanplan.design.deviations import DEVIATES, MISSING, WITHIN, rate_deviations
from scanplan.design.drawn_storey import DrawnWall, Solid
from scanplan.design.ifc_file import IfcBuilding, IfcPart
from scanplan.design.tolerances import Tolerances
from scanplan.geometry.arcs import trace_arc

CENTRE_M, RADIUS_M, THICK_M = np.array([2.0, 1.0]), 4.0, 0.2


LIMITS = Tolerances("ours", (3.0, math.inf), {"wall": (0.016, 0.02)})


def ends(begin_deg, end_deg, radius_m=RADIUS_M, centre_m=CENTRE_M):
    at = np.radians([begin_deg, end_deg])
    return centre_m + radius_m * np.column_stack([np.cos(at), np.sin(at)])


@given(
    radius_m=st.floats(1.5, 30),
    thickness_m=st.floats(0.06, 0.6),
    begin_deg=st.floats(-180, 180),
    turned_deg=st.floats(40, 165),
)
def test_ground_between_two_arcs_gives_its_middle_and_thickness(
    radius_m, thickness_m, begin_deg, turned_deg
):
    ends_m = ends(begin_deg, begin_deg + turned_deg, radius_m)
    ground = CurvedGround(ends_m, CENTRE_M, thickness_m).ground
    (found,) = find_curved_ground(ground)
    assert found.thickness_m == pytest.approx(thickness_m, abs=0.002)
    assert found.centre_m == pytest.approx(CENTRE_M, abs=0.01)
    assert found.ends_m == pytest.approx(ends_m, abs=0.01)


@pytest.mark.parametrize(
    "ground",
    [
        shapely.box(0, 0, 5, 0.2),
        shapely.Point(0, 0).buffer(0.3),
        shapely.Point(0, 0).buffer(3.0).difference(shapely.Point(0, 0).buffer(2.8)),
        shapely.Polygon([(0, 0), (5, 0), (5, 4), (4.8, 4), (4.8, 0.2), (0, 0.2)]),
    ],
    ids=["straight", "column", "full ring", "corner"],
)
def test_what_is_straight_or_goes_around_is_no_curved_wall(ground):
    assert find_curved_ground(ground) == []


def test_a_wall_that_stands_at_an_arc_takes_nothing_of_it():
    bent = CurvedGround(ends(10, 120), CENTRE_M, THICK_M)
    spur = shapely.box(1.9, 4.9, 2.1, 8.0)
    found = find_curved_ground(shapely.union(bent.ground, spur))
    length_m = sum(shapely.LineString(trace_arc(of.ends_m, of.centre_m)).length for of in found)
    assert length_m == pytest.approx(math.radians(110) * RADIUS_M, abs=0.4)
    assert all(of.centre_m == pytest.approx(CENTRE_M, abs=0.02) for of in found)


@pytest.mark.parametrize("as_arcs", [True, False])
def test_arcs_and_bulges_of_a_drawing_are_curved_walls(tmp_path, as_arcs):
    document = ezdxf.new()
    document.units = 6
    space = document.modelspace()
    inner, outer = RADIUS_M - THICK_M / 2, RADIUS_M + THICK_M / 2
    corners = [ends(20, 110, radius) for radius in (inner, outer)]
    on = {"layer": "A-WALL"}
    if as_arcs:
        for radius in (inner, outer):
            space.add_arc(CENTRE_M, radius, 20, 110, dxfattribs=on)
        for first, second in zip(*corners, strict=True):
            space.add_line(first, second, dxfattribs=on)
    else:
        bulge = math.tan(math.radians(90) / 4)
        ring = [
            (*corners[1][0], bulge),
            (*corners[1][1], 0),
            (*corners[0][1], -bulge),
            (*corners[0][0], 0),
        ]
        space.add_lwpolyline(ring, format="xyb", close=True, dxfattribs=on)
    path = tmp_path / "round.dxf"
    document.saveas(path)
    (found,) = design_reading.read_design(path)
    (wall,) = found.walls
    assert wall.centre_m == pytest.approx(CENTRE_M, abs=0.01)
    assert wall.thickness_m == pytest.approx(THICK_M, abs=0.005)
    plan = design_plan.make_plan(found, "round")
    assert plan.axes[0].length == pytest.approx(math.pi / 2 * RADIUS_M, abs=0.02)
    assert plan.walls["arc_radius_m"] == pytest.approx([RADIUS_M], abs=0.01)


def prism(ground, low_m=0.0, high_m=2.6):
    """The top and the bottom of a body over convex pieces of some ground, as triangles."""
    flat = [
        shapely.get_coordinates(part)[:3]
        for part in shapely.get_parts(shapely.constrained_delaunay_triangles(ground))
    ]
    return np.array(
        [[[x, y, z_m] for x, y in corners] for corners in flat for z_m in (low_m, high_m)]
    )


def part(kind, ground, guid, *, host="", fills="", heights_m=(0.0, 2.6)):
    triangles_m = prism(ground, *heights_m)
    along, clear = np.array([1.0, 0.0]), np.zeros(len(triangles_m), bool)
    ifc_class = {"wall": "IfcWall", "opening": "IfcOpeningElement"}[kind]
    return IfcPart(
        *(kind, ifc_class, guid, fills, "", host, guid),
        *(along, False, triangles_m, clear),
    )


def test_a_curved_wall_of_a_model_has_an_arc_and_its_door_lies_on_it():
    bent = CurvedGround(ends(10, 130), CENTRE_M, THICK_M).ground
    hole = CurvedGround(ends(60, 75), CENTRE_M, THICK_M + 0.1).ground
    parts = (
        part("wall", bent, "w"),
        part("opening", hole, "d", host="w", fills="door", heights_m=(0.0, 2.1)),
    )
    (found,) = ifc_design.list_storeys(IfcBuilding((("Ground", 0.0),), parts, ()))
    (wall,), (door,) = found.walls, found.openings
    assert wall.centre_m == pytest.approx(CENTRE_M, abs=0.01) and not found.others
    assert wall.line_m == pytest.approx(ends(10, 130), abs=0.02)
    assert door.line_m == pytest.approx(ends(60, 75), abs=0.02) and door.kind == "door"


def bent_wall(by_m=(0.0, 0.0)):
    """A quarter of a ring in the larger room of the floor, as `test_curved_changes` has it."""
    bent = CurvedGround(ENDS_M + by_m, BENT_M + np.array(by_m), 2 * HALF_M)
    solid = Solid(bent.ground, 0.0, 2.8)
    return DrawnWall("bent", "bent", bent.ends_m, bent.thickness_m, solid, bent.centre_m)


def designed(*walls):
    drawn = storey(inner=(), doors=())
    return replace(drawn, walls=[*drawn.walls, *walls])


def test_faces_of_a_curved_wall_have_their_normals_out_of_it():
    faces = design_plan.make_plan(designed(bent_wall()), "round").faces
    is_bent = faces["wall"] == 4
    places_m = [(faces[f"{axis}0_m"] + faces[f"{axis}1_m"]) / 2 for axis in "xy"]
    outward_m = np.column_stack(places_m)[is_bent] - BENT_M
    leads_out = np.einsum(
        "nj,nj->n", outward_m, np.column_stack([faces["nx"], faces["ny"]])[is_bent]
    )
    is_outer = np.hypot(*outward_m.T) > RADIUS_OF_BENT_M
    assert ((leads_out > 0) == is_outer).all() and {*is_outer.tolist()} == {True, False}


def compare(drawn, built):
    tie = comparison.tie_plans(design_plan.make_plan(drawn, "design"), built.plan)
    design = design_plan.see_design(drawn, "design")
    compared = comparison.compare_placed(design, built, tie)
    rated = rate_deviations(compared, drawn, LIMITS)
    return [of for of in rated if of.guid == "bent"], rated


def test_a_curved_wall_built_as_designed_is_within_its_tolerance_all_along():
    of_bent, rated = compare(designed(bent_wall()), surveyed())
    assert {of.verdict for of in of_bent} == {WITHIN}
    length_m = sum(of.change.shape.length for of in of_bent)
    assert length_m == pytest.approx(math.pi / 2 * RADIUS_OF_BENT_M, abs=0.3)
    assert not any(of.is_fault for of in rated)


def test_a_curved_wall_built_elsewhere_deviates_by_as_much():
    ((moved,), _) = compare(designed(bent_wall()), surveyed(by_m=(0.3, -0.2)))
    assert moved.verdict == DEVIATES and moved.is_fault
    assert moved.change.moved_m == pytest.approx((0.3, -0.2), abs=0.01)


def test_a_curved_wall_that_was_not_built_is_missing():
    of_bent, _ = compare(designed(bent_wall()), surveyed(has_arc=False))
    assert {of.verdict for of in of_bent} == {MISSING}
