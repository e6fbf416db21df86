"""One plan of several surveys: which rays are overtaken, what each shows, on a floor on paper."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import toy_rooms
from helpers.changing_floor import DOOR, INNER, OUTER, SENSORS, sides, survey, without
from helpers.changing_floor import cast as measure
from helpers.default_settings import SETTINGS
from helpers.sheet_words import LANGUAGES, find_english
from scanplan.arrays import array_plan
from scanplan.changes import growth, growth_table
from scanplan.changes.contributions import rate_contributions, sum_lengths_m
from scanplan.changes.joined_scans import Drive, JoinedScans, place_drive
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.stale_rays import StalePlaces
from scanplan.changes.verdicts import CHANGED, GONE, MOVED, SAME, Change
from scanplan.exports import drawing
from scanplan.exports.changes import compared_sheet, growth_sheet
from scanplan.rays.azimuth_sectors import middles_rad
from scanplan.store import schemas, tables
from scanplan.store.registered_scans import RegisteredScans

TURNED = PlaneMotion(np.radians(30), 4.0, -1.0)
WEST = [sensor for sensor in SENSORS if sensor[0] < 5]
EAST = [sensor for sensor in SENSORS if sensor[0] > 5]
NOWHERE = StalePlaces(shapely.Polygon(), shapely.Polygon(), 0.0)


class Store:
    """Scans as a ScanStore reads them, in the frame that a motion leads from."""

    def __init__(self, scans, motion, planar=True):
        self.planar = planar
        back = motion.inverse()
        self.known = {
            scan_id: np.column_stack([back.move(xyz_m[:, :2]), xyz_m[:, 2]]).astype(np.float32)
            for scan_id, xyz_m in scans
        }

    def scans(self, scan_ids=None):
        for scan_id in self.known if scan_ids is None else scan_ids:
            yield int(scan_id), self.known[int(scan_id)]


def own_scans(inner, doors, sensors, motion=None, *, from_ns=0):
    """The scans of a survey of the floor, and where they were taken, in a frame of its own."""
    motion = motion or PlaneMotion()
    faces = [face for line in OUTER for face in sides(line, np.nan)]
    faces += [face for line in inner for face in sides(line, 0.2)]
    solids = np.array([part for face in faces for part in without(face, doors)])
    poses = np.tile(np.eye(4), (len(sensors), 1, 1))
    back = motion.inverse()
    poses[:, :2, :2] = back.rotation
    poses[:, :2, 3] = back.move(np.array(sensors, float))
    n = len(sensors)
    t_ns = from_ns + np.arange(n, dtype=np.int64) * 10**9
    covariance = np.tile(np.diag([4e-4, 1e-4, 1e-6]), (n, 1, 1))
    registered = RegisteredScans(np.arange(n, dtype=np.int32), t_ns, poses, covariance)
    return Store(measure(sensors, solids), motion), registered


def test_rays_that_meet_or_cross_what_changed_are_found_and_no_others():
    wall = shapely.box(2.0, -1.0, 2.2, 1.0)
    places = replace(NOWHERE, built=wall)
    ends_m = np.array([[1.9, 0, 0], [2.1, 0, 0], [5.0, 0, 0], [5.0, 4.0, 0], [-5.0, 0, 0]])
    found = places.find_rays(np.zeros(3), ends_m, planar=True)
    assert found.tolist() == [False, True, True, False, False]


def test_rays_over_furniture_that_was_carried_stay_where_heights_are_known():
    places = replace(NOWHERE, stood=shapely.box(2, -1, 3, 1), top_m=0.8)
    ends_m = np.array([[5.0, 0, 0.5], [5.0, 0, 1.5]])
    sensor_m = np.array([0, 0, 1.2])
    assert places.find_rays(sensor_m, ends_m, planar=False).tolist() == [True, False]
    assert places.find_rays(sensor_m, ends_m, planar=True).all()


@given(st.floats(-3, 3), st.floats(-20, 20), st.floats(-20, 20))
def test_scans_of_two_frames_lie_in_that_of_the_first(yaw_rad, x_m, y_m):
    motion = PlaneMotion(yaw_rad, x_m, y_m)
    first = Drive("a", own_scans([INNER], [DOOR], WEST), PlaneMotion(), 0.0, 0.0)
    second = Drive("b", own_scans([INNER], [DOOR], EAST, motion), motion, 0.0, 0.0)
    joined = JoinedScans([first, second], {})
    assert joined.scan_ids.tolist() == list(range(len(WEST) + len(EAST)))
    places_m = np.array([joined.sensors_m[i][:2] for i in joined.scan_ids.tolist()])
    assert np.abs(places_m - [*WEST, *EAST]).max() < 1e-4
    for scan_id, xyz_m in joined.scans(joined.scan_ids[::-2]):
        assert len(xyz_m) == joined.n_points[scan_id]
        assert ((xyz_m[:, :2] > -1e-3) & (xyz_m[:, :2] < [8 + 1e-3, 5 + 1e-3])).all()
    # errors turn with the frame: their sum stays
    spread = np.trace(joined.known.covariance[:, :2, :2], axis1=1, axis2=2)
    assert spread == pytest.approx(5e-4)


def test_what_a_later_survey_overtook_is_left_out_and_the_rest_kept():
    own = own_scans([INNER], [], WEST)
    places = replace(NOWHERE, built=shapely.box(4.8, 0, 5.2, 5))
    drive = Drive("a", own, PlaneMotion(), 0.0, 0.0, (places,))
    for (_, kept), (_, known) in zip(drive.scans(), own[0].scans(), strict=True):
        assert 0 < len(kept) < len(known) and kept[:, 0].max() < 4.8
    # from (1, 1) the ground is seen from atan(-1 / 3.8) to atan(4 / 3.8): -14.7 to 46.5 degrees
    degrees = np.degrees(middles_rad(drive.left_out[0]))
    np.testing.assert_allclose(degrees, np.arange(-12.5, 48.0, 5.0))
    assert not replace(drive, stale=()).left_out[0].any()
    everything = replace(drive, stale=(replace(NOWHERE, built=shapely.box(-9, -9, 9, 9)),))
    assert len(everything.known.scan_ids) == 0


def test_what_one_survey_alone_saw_is_as_likely_to_have_changed_as_what_both_did():
    a, b = survey(doors=[], sensors=EAST), survey(doors=[], sensors=WEST)
    line = shapely.LineString([(0, 0), (1, 0)])
    changes = [Change("wall", 0, 0, SAME, 0.99, line), Change("wall", 1, -1, GONE, 0.99, line)]
    day_ns = 86_400 * 10**9
    found = rate_contributions(a.plan, [a, b], [0, 7 * day_ns], [changes])
    walls = {of.number: of for of in found if of.table == "wall"}
    # the far wall in the east, and that between both
    assert walls[1].seen_by == (0,) and walls[1].is_stale and walls[1].age_days == 7
    assert walls[1].p_stands == pytest.approx(1 - (1 + 1) / (1 / CHANGED + 2))
    assert walls[4].seen_by == (0, 1) and walls[4].p_stands == 1 and walls[4].age_days == 0
    east_m, west_m, both_m = sum_lengths_m(found)
    assert east_m == pytest.approx(walls[1].shape.length) and west_m == walls[3].shape.length
    assert east_m + west_m + both_m == pytest.approx(a.plan.lengths_m.sum())


def test_a_door_is_seen_by_whoever_looked_at_it():
    a, b = survey(sensors=EAST), survey(sensors=WEST[:1], doors=[])
    (door,) = [
        of for of in rate_contributions(a.plan, [a, b], [0, 1], [[]]) if of.table == "opening"
    ]
    assert door.shares[0] == 1.0 and 1 in door.seen_by
    assert not door.is_stale and door.p_stands == 1


def grown_floor(tmp_path=None):
    """The floor after the inner wall was moved, of two surveys with frames of their own."""
    later = (5.3, 0, 5.3, 5)
    a, b = survey(doors=[]), survey([later], [], motion=TURNED)
    scans = (
        own_scans([INNER], [], SENSORS),
        own_scans([later], [], SENSORS, TURNED, from_ns=10**12),
    )
    seen = []

    def assemble(joined):
        seen.append(joined)
        return survey([later], []).plan, tables.no_rows(schemas.EVIDENCE)

    return growth.grow_plan([(a.plan, scans[0]), (b.plan, scans[1])], {}, assemble), seen[0]


def test_a_plan_of_both_is_made_without_the_wall_that_was_moved(tmp_path):
    grown, joined = grown_floor()
    (step,) = grown.steps
    (wall,) = [c for c in step.changes if c.table == "wall" and c.is_change]
    assert wall.verdict == MOVED and grown.n_scans == [len(SENSORS), len(SENSORS)]
    points_m = np.concatenate([xyz_m for _, xyz_m in joined.scans()])
    is_old = (np.abs(points_m[:, 0] - 5.0) < 0.11) & (np.abs(points_m[:, 1] - 2.5) < 2.0)
    is_new = (np.abs(points_m[:, 0] - 5.3) < 0.11) & (np.abs(points_m[:, 1] - 2.5) < 2.0)
    assert not is_old.any() and is_new.sum() > 100
    columns = growth_table.tabulate_contributions(grown)
    path = tmp_path / "grown.parquet"
    notes = growth_table.state_surveys(grown)
    tables.write_table(path, schemas.CONTRIBUTIONS, columns, notes=notes)
    read = tables.read_table(path, schemas.CONTRIBUTIONS)
    assert len(read["number"]) == 2 * len(grown.contributions)
    moved = (read["element"] == "wall") & (read["number"] == 4)
    assert read["seen_share"][moved].tolist() == pytest.approx([0.0, 1.0], abs=0.05)
    assert "1 moved" in "\n".join(growth_table.summarise_growth(grown))


def test_a_third_survey_is_compared_with_the_plan_of_the_two_before_it():
    later = (5.3, 0, 5.3, 5)
    plans = [survey(doors=[]), survey([later], [], motion=TURNED), survey([later], [])]
    scans = [
        own_scans([INNER], [], SENSORS),
        own_scans([later], [], SENSORS, TURNED, from_ns=10**12),
        # of one room alone
        own_scans([later], [], WEST, from_ns=10**15),
    ]

    def assemble(joined):
        return plans[2].plan, tables.no_rows(schemas.EVIDENCE)

    known = [(of.plan, own) for of, own in zip(plans, scans, strict=True)]
    grown = growth.grow_plan(known, {}, assemble)
    moved = [[c for c in of.changes if c.table == "wall" and c.is_change] for of in grown.steps]
    assert [len(of) for of in moved] == [1, 0]
    walls = {of.number: of for of in grown.contributions if of.table == "wall"}
    # that in the east was seen by the first two, the one that was moved not by the first
    assert walls[1].seen_by == (0, 1) and walls[1].age_days == pytest.approx(11.5, abs=0.2)
    assert walls[4].seen_by == (1, 2) and not walls[4].is_stale
    assert growth_table.summarise_growth(grown)[-1].startswith("not seen by the latest survey: ")


def test_the_sheet_of_both_marks_what_the_latest_alone_saw():
    grown, _ = grown_floor()
    facts = compared_sheet.ComparedFacts("", ("1 May 2024", "2 May 2024"), "")
    sheet = growth_sheet.compose_growth_sheet(grown, facts)
    kinds = {mark.element: mark.kind for mark in sheet.marks}
    assert kinds["wall-4"] == "lately" and kinds["wall-0"] == "unchanged"
    (stood,) = [mark for mark in sheet.marks if mark.kind == "gone"]
    assert np.unique(stood.paths[0][:, 0].round(6)) == pytest.approx([4.9, 5.1])
    assert drawing.draw_sheet(sheet).axes


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_sheet_of_both_is_in_the_language_of_the_receiver(language):
    grown, _ = grown_floor()

    def compose(locale):
        days = ("2026-02-17", "2026-02-18")
        facts = compared_sheet.ComparedFacts("", days, "", locale)
        return growth_sheet.compose_growth_sheet(grown, facts)

    assert find_english(compose, language) == {*grown.names}


PARTED = np.array(
    [
        *((0, 0, 9, 0), (9, 0, 9, 4), (0, 4, 9, 4), (0, 0, 0, 4)),
        *((6, 0, 6, 1.5), (6, 2.4, 6, 4), (6.2, 0, 6.2, 1.5), (6.2, 2.4, 6.2, 4)),
        *((6, 1.5, 6.2, 1.5), (6, 2.4, 6.2, 2.4)),
    ],
    float,
)
"""A room of 6 m, a wall of 0.2 m with a doorway of 0.9 m, and a room of 2.8 m, 4 m deep."""
LIFTED_M = 0.7
"""Of the map in space above that of the planar scanner, whose plane is 0.3 m above the floor."""


def scan_plane(place_m, segments, *, seed):
    """A planar scan of so many beams that its height has more returns than the floor."""
    return toy_rooms.laser(place_m, segments, beams=2160, seed=seed)


def toy_drive(name, make, places_m, *, lift_m=0.0):
    """A drive through the two rooms; heights are of a map so far below the floor's."""
    up_m = np.array([0, 0, lift_m])
    poses = np.tile(np.eye(4), (len(places_m), 1, 1))
    poses[:, :3, 3] = np.array(places_m, float) + up_m
    n = len(places_m)
    scans = [
        (i, make(np.array(place_m), PARTED, seed=i) + up_m) for i, place_m in enumerate(places_m)
    ]
    store = Store(scans, PlaneMotion(), planar=make is scan_plane)
    covariance = np.tile(np.diag([4e-4, 4e-4, 1e-6]), (n, 1, 1))
    known = RegisteredScans(np.arange(n, dtype=np.int32), 10**9 * np.arange(n), poses, covariance)
    return name, (store, known)


def space_and_plane():
    """Scans in space of the first room and in the plane of both, planar ones given first."""
    across = [(x, y) for y in (1.2, 2.8) for x in (1.0, 2.0, 3.0, 4.0, 5.0)]
    beyond = [(x, y) for y in (1.0, 2.0, 3.0) for x in (6.8, 7.6, 8.4)]
    solid = toy_drive("s", toy_rooms.vlp16, [(*xy, 0.9) for xy in across], lift_m=LIFTED_M)
    flat = toy_drive("p", scan_plane, [(*xy, 0.3) for xy in (*across, *beyond)])
    level = replace(survey().plan, floor_z_m=LIFTED_M)
    drives = [
        place_drive(own, replace(level, name=name), PlaneMotion(), level)
        for name, own in (flat, solid)
    ]
    return JoinedScans(drives, SETTINGS), len(across)


def test_planar_scans_among_others_are_of_one_elevation():
    joined, n_solid = space_and_plane()
    assert not joined.planar and [part.planar for part in joined.parts] == [False, True]
    solid, flat = joined.parts
    assert [*solid.scan_ids, *flat.scan_ids] == joined.scan_ids.tolist()
    assert len(solid.scan_ids) == n_solid
    for part, is_lost in ((solid, False), (flat, True)):
        for scan_id, xyz_m in part.scans():
            np.testing.assert_array_equal(xyz_m, next(joined.scans([scan_id]))[1])
            assert (joined.left_out[scan_id] == is_lost).all()
            # alone they are planar scans, of which all is known
            assert not part.left_out[scan_id].any()
            if part is flat:
                np.testing.assert_allclose(xyz_m[:, 2], LIFTED_M + 0.3, atol=1e-6)


@pytest.mark.parametrize(("own_m", "above_m"), [(0.5, 0.5), (0.0, 0.3), (9.0, 0.3)])
def test_a_planar_survey_is_as_high_as_its_map_says_if_one_may_be_mounted_there(own_m, above_m):
    _, own = toy_drive("p", scan_plane, [(1.0, 1.0, own_m)])
    level = replace(survey().plan, floor_z_m=LIFTED_M)
    drive = place_drive(own, level, PlaneMotion(), level)
    assert drive.known.map_from_sensor[0, 2, 3] == pytest.approx(LIFTED_M + above_m)
    assert place_drive(own, level, PlaneMotion(), None).lift_m == 0.0


def lift(own, up_m, *, planar=True):
    """The scans of a survey in a map whose heights are so much larger."""
    store, known = own
    scans = [(i, xyz_m + np.array([0, 0, up_m])) for i, xyz_m in store.scans()]
    poses = known.map_from_sensor.copy()
    poses[:, 2, 3] += up_m
    return Store(scans, PlaneMotion(), planar), replace(known, map_from_sensor=poses)


def test_planar_surveys_before_one_in_space_are_compared_with_it_at_their_own_height():
    plan = survey().plan
    in_space = replace(plan, floor_z_m=LIFTED_M)
    own = [own_scans([INNER], [DOOR], SENSORS, from_ns=day * 10**15) for day in range(3)]
    known = [(plan, lift(of, 0.3)) for of in own[:2]]
    known.append((in_space, lift(own[2], LIFTED_M + 0.3, planar=False)))
    seen = []

    def assemble(joined):
        seen.append(np.unique(joined.known.map_from_sensor[:, 2, 3]))
        return (plan if joined.planar else in_space), tables.no_rows(schemas.EVIDENCE)

    grown = growth.grow_plan(known, {}, assemble)
    heights_m = [step.a.sight.plane.height_m for step in grown.steps]
    assert heights_m == pytest.approx([0.3, 0.3])
    # and from then on they lie on its floor
    assert [of.tolist() for of in seen] == [pytest.approx([0.3]), pytest.approx([LIFTED_M + 0.3])]
    assert {c.verdict for step in grown.steps for c in step.changes if c.table == "wall"} == {SAME}


def test_one_plan_of_space_and_plane_has_the_rooms_of_both():
    joined, _ = space_and_plane()
    made = array_plan.assemble_plan(joined, "both", 1)
    plan = array_plan.rate_plan(made, joined)
    assert sorted(plan.rooms["area_m2"]) == pytest.approx([2.8 * 4, 6 * 4], abs=0.2)
    assert plan.openings["type"].tolist() == ["door"]
    assert plan.openings["width_m"] == pytest.approx([0.9], abs=0.02)
    assert plan.floor_z_m == pytest.approx(LIFTED_M, abs=0.03)
    far = np.minimum(plan.walls["x0_m"], plan.walls["x1_m"]) > 8.9
    assert far.sum() == 1 and (plan.walls["p_true"] > 0.5).all()


def test_surveys_lie_on_one_floor_or_under_one_ceiling():
    own = own_scans([INNER], [DOOR], EAST)
    own[0].planar = False
    plan = survey().plan
    low = replace(plan, floor_z_m=0.1, ceiling_z_m=2.4)
    for high, lift_m in (
        (replace(plan, floor_z_m=1.0), 0.9),
        (replace(plan, ceiling_z_m=3.0), 0.6),
        (plan, 0.0),
    ):
        assert place_drive(own, low, PlaneMotion(), high).lift_m == pytest.approx(lift_m)
