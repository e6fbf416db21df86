"""Walls, faces and evidence of houses known on paper."""

import re
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st

from helpers import house_making
from helpers.observation_making import observation
from helpers.plan_wall_making import wall
from helpers.toy_rooms import laser
from helpers.wall_making import moved, walls
from scanplan.geometry.lines import Line
from scanplan.plan import messages, planning, uncertainty, wall_faces, wall_ground
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.rays import beam_spread, free_space, ray_set

SETTINGS = planning.make_plan_settings(house_making.PLAN)
TRUST = SETTINGS.trust
SENSORS = np.array(house_making.SENSORS, float)


@pytest.fixture(scope="module")
def house():
    return house_making.looked()


def plan(looked, table=None, sensors=SENSORS, settings=SETTINGS, threads=1):
    made = house_making.segments() if table is None else table
    t_ns = house_making.T_NS[: len(sensors)]
    chosen = planning.ChosenScans(made, looked, t_ns)
    return planning.make_plan(chosen, sensors[:, :2], settings, threads=threads)


class TestPlan:
    @settings(max_examples=4, deadline=None)
    @example(2.2, (0.0, 0.0))
    @given(st.floats(-3.1, 3.1), st.tuples(st.floats(-200, 200), st.floats(-200, 200)))
    def test_neither_place_nor_turn_of_the_map_matters(self, yaw_rad, shift):
        points = [(i, house_making.moved(xyz, yaw_rad, shift)) for i, xyz in house_making.scans()]
        sensors = house_making.moved(SENSORS, yaw_rad, shift)
        there = ray_set.gather_rays(points, dict(enumerate(sensors)), planar=False)
        made = plan(there, moved(house_making.segments(), yaw_rad, shift), sensors)
        np.testing.assert_allclose(np.sort(made.rooms["area_m2"]), [15.2, 16], rtol=0.02)
        assert len(made.walls["wall"]) == 5
        np.testing.assert_allclose(made.openings["width_m"], [0.9], atol=0.07)

    def test_faces_of_two_rooms_do_not_run_through_the_wall_between_them(self, house):
        made = plan(house)
        faces = np.column_stack([made.faces[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(
            -1, 2, 2
        )
        inside = shapely.box(4.03, -0.5, 4.17, 1.4)
        crossing = shapely.intersects(shapely.linestrings(faces), inside)
        assert not crossing.any()

    def test_the_plan_does_not_depend_on_the_cores(self, house):
        alone, shared = plan(house), plan(house, threads=2)
        for name in planning.TABLES:
            one, two = getattr(alone, name), getattr(shared, name)
            assert one.keys() == two.keys()
            for column, values in one.items():
                np.testing.assert_array_equal(values, two[column], err_msg=f"{name}.{column}")

    def test_what_one_scan_of_one_room_shows(self):
        made = plan(
            house_making.looked(sensors=SENSORS[:1]),
            walls(house_making.ROOM_A, scan_id=[0] * 5),
            SENSORS[:1],
        )
        assert made.rooms["area_m2"][0] == pytest.approx(16, rel=0.03)
        assert made.walls["verify"].all()
        assert np.isnan(made.walls["thickness_m"]).all()

    def test_a_planar_scanner_makes_a_plan_too(self):
        flat = [
            (i, np.column_stack([xyz[:, :2], 0 * xyz[:, 2]])) for i, xyz in house_making.scans()
        ]
        flat = [(i, xyz[:: 16 // 2]) for i, xyz in flat]
        made = plan(ray_set.gather_rays(flat, dict(enumerate(SENSORS)), planar=True))
        assert np.isnan(made.openings["sill_m"]).all() and np.isnan(made.walls["top_m"]).all()
        np.testing.assert_allclose(np.sort(made.rooms["area_m2"]), [15.2, 16], rtol=0.03)

    def test_floor_under_a_box_is_of_its_room_whether_others_saw_it_or_not(self):
        """It is 1.2 m long and wide; who moved it saw the floor there."""
        corners = [(2.2, 2.2), (3.4, 2.2), (3.4, 3.4), (2.2, 3.4)]
        box = [(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
        points = house_making.scans(house_making.HOUSE + box, SENSORS[:2])
        flat = [(i, (xyz * [1, 1, 0])[::8]) for i, xyz in points]
        rays = ray_set.gather_rays(flat, dict(enumerate(SENSORS[:2])), planar=True)

        table = walls(house_making.ROOM_A * 2, scan_id=[0] * 5 + [1] * 5)
        chosen = planning.ChosenScans(table, rays, house_making.T_NS[:2])
        for find_floor in (None, lambda: shapely.box(2, 2, 4, 4)):
            others = planning.OtherScans(find_floor)
            made = planning.make_plan(chosen, SENSORS[:2, :2], SETTINGS, others=others)
            assert float(made.rooms["area_m2"].max()) == pytest.approx(16, rel=0.02)

    @pytest.mark.parametrize("sensor_z_m", [0.4, 0.9])
    def test_a_table_is_no_wall(self, sensor_z_m):
        desk = [(3, 0.3, 3.8, 0.3), (3.8, 0.3, 3.8, 0.8), (3.8, 0.8, 3, 0.8), (3, 0.8, 3, 0.3)]
        sensors = SENSORS[:2] * [1, 1, 0] + [0, 0, sensor_z_m]
        outward = [(x1, y1, x0, y0) for x0, y0, x1, y1 in desk]
        shown = walls((house_making.ROOM_A + outward) * 2, scan_id=[0] * 9 + [1] * 9)
        made = plan(_with_low_box(desk, 0.7, sensors), shown, sensors)
        faces = np.column_stack([made.faces[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(
            -1, 2, 2
        )
        assert not shapely.intersects(
            shapely.linestrings(faces), shapely.box(2.9, 0.2, 3.9, 0.9)
        ).any()

    @pytest.mark.parametrize(("sensors", "walls_"), [(1, 0), (2, 1)])
    def test_a_short_wall_is_believed_if_two_scans_show_it(self, sensors, walls_):
        pillar = [(3.4, 2.4, 2.8, 2.4)]
        looked = house_making.looked(
            house_making.HOUSE + pillar, SENSORS[:2] * [1, 0.5, 1] + [0, 0.3, 0]
        )
        table = walls(pillar[:1], scan_id=[0])
        t_ns = house_making.T_NS[:sensors]
        chosen = planning.ChosenScans(table, _first(looked, sensors), t_ns)
        made = planning.make_plan(chosen, SENSORS[:1, :2], SETTINGS)
        # in its line, beyond a gap that leads to no room, is a jamb of the partition
        assert len(made.walls["wall"]) == 2 * walls_ and made.openings["wall"].max() < 0
        ends_m = np.minimum(made.walls["x0_m"], made.walls["x1_m"])
        assert np.count_nonzero(ends_m < 3.5) == walls_

    def test_a_round_room_is_drawn_as_a_chain_of_chords(self):
        turn = np.linspace(0, 2 * np.pi, 181)
        ring = 5 * np.column_stack([np.cos(turn), np.sin(turn)])
        sensors = np.array([(0.3, 0.2, 0.9), (-0.5, 0.4, 0.9), (0.2, -0.8, 0.9)])
        looked = house_making.looked(np.hstack([ring[:-1], ring[1:]]).tolist(), sensors)
        chords = [ring[(np.arange(0, 181, 8) + 3 * scan) % 180] for scan in range(3)]
        segments = np.concatenate([np.hstack([c[:-1], c[1:]]) for c in chords])
        table = walls(segments, scan_id=np.repeat([0, 1, 2], len(segments) // 3))
        # a room without any flat wall says nothing of constant errors of ranges
        ranges = replace(SETTINGS.ranges, sigma_m=0.0)
        made = plan(looked, table, sensors, replace(SETTINGS, ranges=ranges))
        faces = np.column_stack([made.faces[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(
            -1, 2, 2
        )
        drawn = shapely.linestrings(faces)
        assert shapely.length(drawn).sum() == pytest.approx(10 * np.pi, rel=0.03)
        assert shapely.distance(shapely.points(ring), shapely.union_all(drawn)).max() < 0.1
        assert made.rooms["area_m2"].tolist() == [pytest.approx(25 * np.pi, rel=0.01)]

    @pytest.mark.parametrize("count", [0, 1000])
    def test_segments_where_no_point_is_make_no_wall(self, house, count):
        y = np.arange(count) * 0.02 + 100
        made = plan(house, walls(np.column_stack([0 * y, y, 0 * y + 3, y])))
        assert len(made.walls["wall"]) == 0
        assert made.n_dropped == made.n_lines

    def test_a_plan_half_a_kilometre_wide(self):
        far = house_making.moved(SENSORS, 0.0, (500, 0))
        points = house_making.scans() + [
            (i + 4, house_making.moved(p, 0.0, (500, 0))) for i, p in house_making.scans()
        ]
        both = np.concatenate([SENSORS, far])
        near = house_making.segments()
        away = moved(near, 0.0, (500, 0)) | {"scan_id": near["scan_id"] + 4}
        table = {c: np.concatenate([near[c], away[c]]) for c in near}
        found = ray_set.gather_rays(points, dict(enumerate(both)), planar=False)
        made = planning.make_plan(
            planning.ChosenScans(table, found, np.arange(8)), both[:, :2], SETTINGS
        )
        assert len(made.rooms["room"]) == 4
        assert len(made.walls["wall"]) == 10


def _first(looked, count):
    """Rays of the first scans alone."""
    points = [(i, looked.xyz_m[looked.rows[i]]) for i in looked.scan_ids[:count].tolist()]
    return ray_set.gather_rays(points, dict(enumerate(looked.sensors_m)), planar=False)


def _with_low_box(desk, height_m, sensors):
    """Rays of the house where a desk stands: those that meet it below its top end there."""
    houses = house_making.HOUSE, house_making.HOUSE + desk
    full, cut = (house_making.scans(house, sensors, columns=1800) for house in houses)
    points = [
        (i, np.concatenate([far[far[:, 2] > height_m], near[near[:, 2] <= height_m]]))
        for (i, far), (_, near) in zip(full, cut, strict=True)
    ]
    return ray_set.gather_rays(points, dict(enumerate(sensors)), planar=False)


class TestFreeSpace:
    def test_a_scan_sees_its_room(self, house):
        assert free_space.free_polygons(house)[0].intersection(
            shapely.box(0, 0, 4, 4)
        ).area == pytest.approx(16, rel=0.02)

    @pytest.mark.parametrize("beams", [240, 360, 1440])
    def test_a_laser_sees_its_room_however_far_apart_its_beams_are(self, beams):
        flat = laser(SENSORS[0], np.array(house_making.HOUSE, float), beams=beams)
        found = free_space.free_polygons(
            ray_set.gather_rays([(0, flat)], {0: SENSORS[0]}, planar=True)
        )
        assert found[0].intersection(shapely.box(0, 0, 4, 4)).area == pytest.approx(16, rel=0.06)

    @pytest.mark.parametrize("spread", [0.01, 0.65, 0.95])
    @pytest.mark.parametrize("columns", [240, 360, 1440])
    def test_beams_above_one_another_see_their_room_however_far_apart_their_columns_are(
        self, columns, spread
    ):
        """However much of the way to the next column the rays of one are spread over, too."""
        flat = laser(SENSORS[0], np.array(house_making.HOUSE, float), beams=columns)
        turns = np.linspace(0, spread * 2 * np.pi / columns, 16)[:, None]
        way = flat[:, :2] - SENSORS[0][:2]
        beside = np.column_stack([-way[:, 1], way[:, 0]])
        near = [SENSORS[0][:2] + way * np.cos(turn) + beside * np.sin(turn) for turn in turns]
        rise = np.tan(np.radians(np.linspace(-15, 15, 16)))[:, None] * np.hypot(*way.T)
        points = np.column_stack([np.concatenate(near), SENSORS[0][2] + rise.ravel()])
        gathered = ray_set.gather_rays([(0, points)], {0: SENSORS[0]}, planar=False)
        assert free_space.free_polygons(gathered)[0].intersection(
            shapely.box(0, 0, 4, 4)
        ).area == pytest.approx(16, rel=0.06)
        spacing_rad = beam_spread.column_spacing_rad(
            gathered.azimuth_rad, gathered.xyz_m - SENSORS[0]
        )
        assert np.degrees(spacing_rad) == pytest.approx(360 / columns, abs=0.02)

    def test_rays_too_far_apart_for_an_opening_are_told(self):
        """In a room of 4 m most walls are some 2 to 3 m away.

        0.5 m of them hold two rays that are 5 degrees apart.
        """
        told = {}
        for beams in (360, 90, 45):
            flat = laser(SENSORS[0], np.array(house_making.HOUSE, float), beams=beams)
            told[beams] = messages.measure_sparse_rays(
                ray_set.gather_rays([(0, flat)], {0: SENSORS[0]}, planar=True), 0.5
            )
        assert [found.is_beyond for found in told.values()] == [False, False, True]
        finding = told[45].finding
        assert "lie 8.0 degrees apart" in finding.said and "up to 1.8 m away" in finding.said
        assert "n_azimuth" in finding.remedy

    @pytest.mark.parametrize(
        ("directions_deg", "spacing_deg"),
        [(np.arange(-30, 31, 2.0), 2), (np.array([-120.0, 120.0]), 0), (np.empty(0), 0)],
    )
    def test_the_end_of_a_sensors_field_is_no_gap_between_its_columns(
        self, directions_deg, spacing_deg
    ):
        azimuth_rad = np.radians(directions_deg)
        level = np.column_stack([np.cos(azimuth_rad), np.sin(azimuth_rad), 0 * azimuth_rad])
        assert beam_spread.column_spacing_rad(azimuth_rad, level) == pytest.approx(
            np.radians(spacing_deg)
        )

    def test_a_scan_of_no_points_sees_nothing(self):
        empty = ray_set.gather_rays([(0, np.empty((0, 3)))], {0: np.zeros(3)}, planar=True)
        assert free_space.free_polygons(empty)[0].is_empty

    def test_an_unpaired_wall_stands_behind_its_face(self):
        (ground,) = wall_ground.wall_strips([wall(0, 0, 4, 0, np.nan)], 0.1)
        assert ground.bounds == (0, -0.1, 4, 0)


class TestFaces:
    def test_a_face_is_cut_where_a_wall_butts_against_it(self):
        long = _shown(wall(0, 0, 8, 0, np.nan, closed=[(6, 7)]), (0, 6), (7, 8))
        cut = wall_faces.cut_wall_faces(
            [long, wall(4, 3, 4, 0, 0.2), wall(6.5, 3, 6.5, 0, 0.2)],
            max_beyond_m=1,
            door_height_m=1.9,
        )
        observed = sorted(face.ends[:, 0].tolist() for one in cut for face in one.members)
        inferred = sorted(face.ends[:, 0].tolist() for one in cut for face in one.inferred)
        np.testing.assert_allclose(observed, [(0, 3.91), (4.09, 6), (7, 8)], atol=0.001)
        np.testing.assert_allclose(inferred, [(6, 6.41), (6.59, 7)], atol=0.001)

    def test_the_unseen_side_of_a_seen_wall_is_inferred_but_not_in_openings(self):
        one = wall(0, 0, 8, 0, 0.2, openings=[(3, 4)])
        one = replace(
            _shown(one, (0, 3), (4, 8)),
            right=[_stretch(one, -0.1, (0, 1)), _stretch(one, -0.1, (6, 6.5))],
        )
        (cut,) = wall_faces.cut_wall_faces([one], max_beyond_m=2, door_height_m=1.9)
        spans = sorted(np.sort(face.ends[:, 0]).tolist() for face in cut.inferred)
        np.testing.assert_allclose(spans, [(1, 3), (4, 6), (6.5, 8)], atol=0.001)
        np.testing.assert_allclose([face.ends[:, 1] for face in cut.inferred], -0.1)
        assert not any(face.is_left for face in cut.inferred)
        (cut,) = wall_faces.cut_wall_faces([one], max_beyond_m=1, door_height_m=1.9)
        assert max(face.ends[:, 0].max() for face in cut.inferred) == pytest.approx(6)

    @pytest.mark.parametrize(
        ("free_m", "openings", "expected"),
        [
            ((4, 5), (), [(3, 4), (5, 6)]),
            ((4, 4.2), (), [(3, 6)]),
            ((3.2, 5.8), [(3, 6)], []),
        ],
        ids=["a niche", "a stray trace", "an opening is one already"],
    )
    @pytest.mark.parametrize(("step_m", "planar"), [(0.01, False), (0.06, True)])
    def test_no_face_is_inferred_where_rays_go_in(self, free_m, openings, expected, step_m, planar):
        one = _shown(wall(0, 0, 8, 0, 0.2, openings=openings), (0, 3), (6, 8))
        one = replace(one, right=[_stretch(one, -0.1, (0, 8))])
        line, places_m = one.left[0].line, np.arange(0.01, 8, step_m)
        shown = [(along_m, 0.5) for along_m in places_m if not 3 < along_m < 6]
        through = [(a, 0.5) for a in places_m if free_m[0] < a < free_m[1]]
        seen = observation(line, shown, through, planar=planar)
        one = replace(one, left=[FaceInterval(seen, 0.0, 3.0), FaceInterval(seen, 6.0, 8.0)])
        (cut,) = wall_faces.cut_wall_faces([one], max_beyond_m=1, door_height_m=1.9)
        spans = sorted(np.sort(face.ends[:, 0]).tolist() for face in cut.inferred)
        np.testing.assert_allclose(
            np.reshape(spans, (-1, 2)), np.reshape(expected, (-1, 2)), atol=0.11
        )


def _shown(of, *spans):
    """A wall whose left side points show."""
    return replace(of, left=[_stretch(of, of.half_m, span) for span in spans])


def _stretch(of, offset_m, span):
    sign = 1 if offset_m >= 0 else -1
    line = Line(of.line.centre + offset_m * of.line.normal, sign * of.line.normal)
    low, high = np.sort(sign * np.array(span, float))
    seen = observation(line, [(along_m, 0) for along_m in np.linspace(low, high, 100)])
    return FaceInterval(seen, float(low), float(high))


class TestEvidence:
    def test_scans_that_show_a_wall_are_counted(self, house):
        made = plan(house)
        seen_by = np.array(
            [len(np.unique(made.evidence["scan_id"][made.evidence["wall"] == w])) for w in range(5)]
        )
        np.testing.assert_array_equal(made.walls["n_scans"], seen_by)
        # nothing is known of the poses: all may be off together, as one scan usually is
        np.testing.assert_allclose(made.walls["sigma_offset_m"], 0.02, rtol=1e-3)
        assert not made.walls["verify"].any()
        for name in ("p_wall", "p_solid"):
            assert (made.walls[name] > 0.5).all()

    def test_a_wall_that_few_points_show_is_to_be_verified(self):
        known = {
            "rmse_m": 0.01,
            "n_points": 9,
            "points": np.array([9]),
            "z_m": (0, 1),
            "top_m": np.nan,
        }
        sure = {
            "sigma_offset_m": 0.01,
            "sigma_end_m": (0.01, 0.01),
            "scans": np.arange(2),
            "observed": 1.0,
        }
        assert not uncertainty.WallEvidence(**known, **sure).needs_a_visit(TRUST)
        free_end = {"sigma_end_m": (0.01, 0.1)}
        assert not uncertainty.WallEvidence(**known, **(sure | free_end)).needs_a_visit(TRUST)
        for doubt in (
            {"sigma_offset_m": 0.1},
            {"scans": np.arange(1)},
            {"observed": 0.2},
        ):
            assert uncertainty.WallEvidence(**known, **(sure | doubt)).needs_a_visit(TRUST)


@pytest.mark.parametrize(
    ("errors_mm", "said"),
    [
        ([0, 0], []),
        ([0, -0.3, -0.31], ["-0.3"]),
        ([0, -0.3, -2], ["-2.0", "-0.3"]),
        ([0, 4, 12.5], ["+4.0", "+12.5"]),
        ([-1, 3], ["-1.0", "+3.0"]),
    ],
)
def test_the_bias_of_ranges_is_told_from_the_most_too_short_to_the_most_too_long(errors_mm, said):
    told = messages.summarise_range_bias(np.array(errors_mm) / 1000)
    assert re.findall(r"[+-]\d+\.\d", told) == said
