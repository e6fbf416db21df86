"""Overlays never raise, return one dimension, and areas add up."""

import json

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, MultiPoint, MultiPolygon, Point, Polygon, box

from helpers import floorplan_making, overlay_making
from scanplan.exports.sheet import composition
from scanplan.geometry import overlay_steps, overlays
from scanplan.geometry.fallbacks import take_fallbacks
from scanplan.plan.rooms.room import RoomSettings
from scanplan.plan.rooms.room_outlines import find_rooms
from scanplan.plan.wall_ground import Bounds
from scanplan.project import dataset_files
from scanplan.rays import free_space, ray_set
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey
from scanplan.registration import results

CORNER = box(0, 0, 2, 2)
# an edge of 1 m in common, the second 1 m over
BESIDE = box(2, 1, 4, 3)
ACROSS = LineString([(-1, 1), (3, 1)])
NUMBERS = st.sampled_from([0.0, 1e-300, 1e-9, 1e-3, 1.0, 1 + 1e-12, 8.0])
RINGS = st.lists(st.tuples(NUMBERS, NUMBERS), min_size=3, max_size=7)


@pytest.mark.parametrize("kind", overlay_making.KINDS)
def test_overlays_of_hard_areas_add_up(kind):
    rng = np.random.default_rng(51)
    for _ in range(30):
        assert overlay_making.find_faults(overlay_making.KINDS[kind](rng)) == []


@settings(max_examples=100)
@given(st.integers(0, 2**32))
def test_overlays_of_hard_areas_add_up_anywhere(seed):
    _, areas = overlay_making.arrange(seed)
    assert overlay_making.find_faults(areas) == []


@settings(max_examples=100)
@given(st.lists(RINGS.map(Polygon), min_size=3, max_size=3))
def test_overlays_of_any_corners_add_up(areas):
    assert overlay_making.find_faults(areas) == []


# raised, or lost a part, where GEOS was asked once
@pytest.mark.parametrize("seed", [1, 592, 1260, 10628, 14094, 15099, 19877, 41463, 92226])
def test_arrangements_that_went_wrong_add_up(seed):
    _, areas = overlay_making.arrange(seed)
    assert overlay_making.find_faults(areas) == []


def test_areas_that_touch_have_no_area_in_common_and_no_line():
    both = np.array([BESIDE, box(1, 1, 3, 3)], object)
    one, other = overlays.intersect_areas(CORNER, both)
    assert one.is_empty and one.geom_type in ("Polygon", "MultiPolygon")
    assert other.equals(box(1, 1, 2, 2))


def test_lines_keep_no_point():
    ends_at_edge = LineString([(2, 1), (4, 1)])
    assert overlays.intersect_lines(ends_at_edge, CORNER).is_empty
    assert overlays.intersect_lines(CORNER, ACROSS).length == 2
    assert overlays.subtract_lines(ACROSS, CORNER).length == 2
    assert overlays.cross_lines(ACROSS, LineString([(1, 0), (1, 2)])).equals(Point(1, 1))


def test_collections_are_divided():
    mixed = shapely.GeometryCollection([box(0, 0, 1, 1), ACROSS, Point(9, 9), MultiPoint([(8, 8)])])
    assert overlays.subtract_areas(mixed, box(0.5, 0, 1, 1), grid=1e-3).equals(box(0, 0, 0.5, 1))
    assert overlays.intersect_areas(CORNER, mixed, grid=1e-3).area == 1
    # an area and a line take from a line
    assert overlays.subtract_lines(LineString([(-2, 1), (3, 1)]), mixed, grid=1e-3).length == 1
    assert overlays.unite_areas([mixed, CORNER], grid=1e-3).equals(CORNER)


def test_nothing_has_no_overlay():
    assert overlays.unite_areas([]).area == overlays.unite_lines([]).length == 0
    assert overlays.unite_areas(np.empty(0, object)).geom_type == "MultiPolygon"
    assert len(overlays.subtract_areas(np.empty(0, object), CORNER)) == 0
    assert overlays.subtract_areas(Polygon(), CORNER).is_empty


def test_what_overlaps_in_a_collection_is_one_area():
    twice = shapely.GeometryCollection([box(0, 0, 2, 2), box(1, 0, 3, 2)])
    assert overlays.repair_areas(twice).area == 6
    # a ring that crosses itself encloses both sides
    assert overlays.repair_areas(Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])).area == 2


def test_shapes_that_are_sound_stay_as_geos_leaves_them_and_nothing_is_counted():
    areas = [shapely.Point(x, 0).buffer(1.0) for x in range(5)]
    take_fallbacks()
    united = overlays.unite_areas(areas)
    left = overlays.subtract_areas(np.array(areas, object), areas[2])
    assert shapely.equals_exact(united, shapely.union_all(areas), tolerance=0)
    assert shapely.equals_exact(left, shapely.difference(areas, areas[2]), tolerance=0).all()
    assert take_fallbacks() == 0


@pytest.mark.parametrize("failing", ["at all", "once"])
def test_where_geos_raises_another_way_is_found_and_counted(monkeypatch, failing):
    exact, refused = shapely.difference, []

    def difference(one, other, grid_size=None):
        if (failing == "at all" and (grid_size is None or grid_size < 1e-6)) or not refused:
            refused.append(grid_size)
            raise shapely.GEOSException("TopologyException: unable to assign free hole to a shell")
        return exact(one, other, grid_size=grid_size)

    monkeypatch.setattr(shapely, "difference", difference)
    take_fallbacks()
    assert overlays.subtract_areas(box(0, 0, 2, 1), box(1, 0, 2, 1)).equals(box(0, 0, 1, 1))
    assert refused[0] is None
    assert take_fallbacks() == (failing == "at all")


@pytest.mark.parametrize("thickness_m", [1e-300, 1e-12, 1e-6, 1e-3])
def test_walls_as_thin_as_nothing_are_drawn(thickness_m):
    rows = [(line, thickness_m, *others) for line, _, *others in floorplan_making.WALLS]
    sheet = composition.compose_sheet(floorplan_making.plan(walls=floorplan_making.walls(rows)))
    assert len(sheet.marks) > 10


@pytest.mark.parametrize("turn_deg", np.linspace(1, 89, 6))
def test_a_plan_turned_off_every_grid_is_drawn(turn_deg):
    """Corners of walls, rooms and floor lie on no grid, and edges are common but for rounding."""
    turned = floorplan_making.plan()
    turn = np.radians(turn_deg)
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    tables = {
        table: _turn_table(getattr(turned, table), rotation)
        for table in ("faces", "walls", "openings", "rooms", "free")
    }
    sheet = composition.compose_sheet(floorplan_making.plan(**tables))
    assert len(sheet.dimensions) == len(composition.compose_sheet(turned).dimensions)


def _turn_table(columns, rotation):
    columns = dict(columns)
    for x, y in (("x0_m", "y0_m"), ("x1_m", "y1_m"), ("x_m", "y_m"), ("nx", "ny")):
        if x in columns:
            columns[x], columns[y] = rotation @ np.array([columns[x], columns[y]])
    if "geometry" in columns:
        shapes = shapely.transform(
            shapely.from_wkb(columns["geometry"]), lambda xy: xy @ rotation.T
        )
        columns["geometry"] = np.asarray(shapely.to_wkb(shapes), object)
    return columns


@pytest.mark.recordings
def test_the_hole_that_ended_a_drawing_is_divided(recordings_dir):
    stored = json.loads((recordings_dir / "field/mixed_dimension.json").read_text())
    hole, built = (shapely.from_wkb(stored[name]) for name in ("hole", "built"))
    mixed = shapely.difference(hole, built, grid_size=stored["grid_m"])
    assert mixed.geom_type == "GeometryCollection"
    enclosed = overlays.subtract_areas(hole, built, grid=stored["grid_m"])
    assert (enclosed.geom_type, enclosed.area) == ("Polygon", mixed.area)
    # and what is given as a mixture is overlaid
    assert overlays.subtract_areas(mixed, built, grid=stored["grid_m"]).area == pytest.approx(
        mixed.area, abs=1e-3
    )


@pytest.mark.recordings
def test_rooms_with_curved_walls_are_found(recordings_dir):
    """Floor that scans saw along curved walls, united and closed without a grid."""
    files = dataset_files.find_files(str(recordings_dir / "maps/office_d"))
    with open_survey(files, Reading(min_range_m=0.1)) as survey:
        edges, stamps = survey.pose_edges(), survey.stamps()
        pose, _, covered = frame_edges.chain_poses(edges, stamps, max_gap_s=2.0)
        chosen = np.flatnonzero(covered)[::12].tolist()
        scans = [
            (scan.scan_id, results.move_to_map(scan.scan_id, scan.xyz_m, pose[scan.scan_id]))
            for scan in survey.scans(chosen)
        ]
    sensors_m = {scan_id: pose[scan_id][:3, 3] for scan_id, _ in scans}
    rays = ray_set.gather_rays(scans, sensors_m, planar=True)
    views = free_space.free_polygons(rays)
    floor = free_space.union_on_grid(views)
    for half_m in (0.05, 0.2):
        closed = free_space.close_shadows(floor, half_m)
        assert floor.area <= closed.area <= floor.area + 2 * half_m * floor.length
    rooms = find_rooms(
        Bounds([], unpaired_m=0.1),
        views,
        np.array([sensors_m[scan_id][:2] for scan_id in sensors_m]),
        RoomSettings(min_area_m2=1.0, min_walled=0.0, min_width_m=0.5),
        floor=floor,
    )
    assert sum(room.polygon.area for room in rooms) >= 0.9 * floor.area
    assert all(isinstance(room.polygon, Polygon | MultiPolygon) for room in rooms)


def test_collections_are_divided_where_any_dimension_is_asked_for():
    square, line = shapely.box(0, 0, 2, 2), shapely.LineString([(3, 0.5), (5, 0.5)])
    both = shapely.geometrycollections([square, line])
    found = overlays.intersect_shapes(both, shapely.box(1, 0, 4, 1))
    assert found.area == pytest.approx(1) and found.length == pytest.approx(4 + 1)


def test_what_areas_can_be_is_told_of_several_with_one():
    squares = np.array([shapely.box(0, 0, 1, 1), shapely.box(5, 0, 7, 2)])
    can_be = overlay_steps._can_be(shapely.union, (squares, shapely.box(0, 0, 2, 2)), [4.5, 3.0])
    assert can_be.tolist() == [True, False]
