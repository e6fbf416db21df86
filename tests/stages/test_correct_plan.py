"""Corrections carried out on the plan of two rooms drawn by hand."""

import json

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.correcting import MADE, corrected, faces_of, write_plan
from helpers.refusals import assert_told, refused
from scanplan.errors import StageError
from scanplan.plan import planning
from scanplan.report.wording import state_reference
from scanplan.stage.witness_table import SKETCH
from scanplan.store import tables
from scanplan.validation.verdict import judge_plan


@pytest.fixture
def plan(tmp_path):
    return write_plan(tmp_path)


def test_no_entry_changes_nothing(plan):
    found = corrected(plan)
    for name in ("faces", "walls", "openings", "rooms", "free"):
        before = MADE[name]()
        for column, values in getattr(found, name).items():
            np.testing.assert_array_equal(values, before[column], err_msg=column)
    assert found.floor_z_m == 0.0 and found.georeference is None


def test_a_room_is_named_where_the_place_lies(plan):
    found = corrected(plan, {"element": "room", "at": [5, 1], "name": "Küche"})
    assert found.room_names == ["Room 0", "Küche"]
    assert found.rooms["corrected"].tolist() == ["", "changed by hand"]


def test_a_door_becomes_a_window_and_a_doubtful_wall_is_kept(plan):
    found = corrected(
        plan,
        {"element": "opening", "at": [4.1, 1.4], "kind": "window"},
        {"element": "wall", "at": [5.5, 3.0], "action": "keep"},
    )
    assert found.openings["type"].tolist() == ["door", "window", "window"]
    assert found.openings["corrected"].tolist() == ["", "changed by hand", ""]
    assert MADE["walls"]()["verify"][2] and not found.walls["verify"].any()
    assert found.walls["corrected"][2] == "kept by hand"


def test_with_a_wall_go_its_faces_openings_and_evidence(plan):
    found = corrected(plan, {"element": "wall", "at": [3, 3.2], "action": "remove"},
                      {"element": "wall", "at": [4.0, 0.4], "action": "remove"})  # fmt: skip
    assert found.walls["wall"].tolist() == [0, 1, 2, 4]
    assert not set(found.faces["wall"]) & {3, 5}
    assert found.openings["opening"].tolist() == [0, 2]
    assert len(found.rooms["room"]) == 2


def test_a_removed_room_is_named_by_no_door(plan):
    found = corrected(plan, {"element": "room", "at": [5, 1], "action": "remove"})
    assert found.rooms["room"].tolist() == [0]
    assert found.openings["room_b"].tolist() == [-1, -1, -1]


def test_a_removed_opening_is_wall(plan):
    found = corrected(plan, {"element": "opening", "at": [4.05, 1.5], "action": "remove"})
    assert found.openings["opening"].tolist() == [0, 2]
    lines = faces_of(found, 5)
    # of 0.1 m thickness, on either side where the door was, from 1.0 to 1.9
    closed = {tuple(map(tuple, line.round(6).tolist())) for line in lines[-2:]}
    assert closed == {((4.0, 1.0), (4.0, 1.9)), ((4.1, 1.9), (4.1, 1.0))}
    assert found.solid("observed").covers(shapely.Point(4.05, 1.5))


def test_a_wall_is_added_with_its_faces(plan):
    found = corrected(
        plan,
        {"element": "wall", "action": "add", "line": [[1, 2], [3, 2]], "thickness_m": 0.2},
        {"element": "wall", "action": "add", "line": [[5, 0.5], [5, 1.5]]},
    )
    assert found.walls["wall"].tolist() == list(range(8))
    assert found.walls["corrected"][6:].tolist() == ["added by hand"] * 2
    np.testing.assert_allclose(faces_of(found, 6), [[[1, 2.1], [3, 2.1]], [[3, 1.9], [1, 1.9]]])
    np.testing.assert_allclose(faces_of(found, 7), [[[5, 0.5], [5, 1.5]]])
    assert found.walls["face_right"][7] == -1 and np.isnan(found.walls["thickness_m"][7])
    assert found.solid("inferred").covers(shapely.Point(2, 2))


def test_an_opening_is_added_in_the_nearest_wall_and_cuts_its_faces(plan):
    line = [[4.2, 2.9], [4.0, 2.1]]
    found = corrected(plan, {"element": "opening", "action": "add", "line": line, "kind": "door"})
    row = {name: values[-1] for name, values in found.openings.items()}
    assert (row["opening"], row["wall"], row["type"]) == (3, 5, "door")
    assert [row[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")] == pytest.approx(
        [4.05, 2.1, 4.05, 2.9]
    )
    assert (row["width_m"], row["thickness_m"]) == pytest.approx((0.8, 0.1))
    # to the left of the wall, which runs upwards, lies the western room
    assert (row["room_a"], row["room_b"], row["n_rays"]) == (0, 1, 0)
    cut = sorted(np.sort(line[:, 1]).tolist() for line in faces_of(found, 5))
    np.testing.assert_allclose(cut, [[0, 2.1], [0, 2.1], [2.9, 3], [2.9, 3]])
    assert not found.solid("observed").covers(shapely.Point(4.05, 2.5))


def test_one_that_matches_nothing_is_told(plan, caplog):
    caplog.set_level("INFO")
    before = floorplan_making.plan()
    found = corrected(
        plan,
        {"element": "wall", "at": [20, 20], "action": "remove"},
        {"element": "room", "at": [20, 20], "name": "nowhere"},
        {"element": "opening", "at": [20, 20], "kind": "door"},
        {"element": "opening", "action": "add", "kind": "door", "line": [[20, 20], [21, 20]]},
    )
    said = caplog.text
    assert "entry 1: (20, 20) lies within 0.5 m of no wall: not applied" in said
    why = "entry 1: (20, 20) lies within 0.5 m of no wall: not applied"
    assert found.unmatched_corrections[0] == why
    assert "entry 2: (20, 20) lies in no room" in said and "entry 3: (20, 20) lies within" in said
    assert "entry 4: no wall lies within 0.5 m" in said
    assert "0 of 4 corrections applied" in said
    assert len(found.walls["wall"]) == len(before.walls["wall"])


def test_two_of_the_same_element_end_in_one_line(plan):
    with refused(value=("entry 2", "wall 1", "entry 1"), remedy="keep one"):
        corrected(
            plan,
            {"element": "wall", "at": [7.1, 1], "action": "keep"},
            {"element": "wall", "at": [7.1, 2], "action": "remove"},
        )


def test_nothing_left_ends_in_one_line(plan):
    for name in ("walls", "openings", "evidence"):
        rows = {k: v[:1] if name == "walls" else v[:0] for k, v in MADE[name]().items()}
        tables.write_table(plan[name], planning.TABLES[name], rows, allow_empty=True)
    faces = {k: v[:1] for k, v in MADE["faces"]().items()}
    tables.write_table(plan["faces"], planning.TABLES["faces"], faces)
    with refused(remedy="remove fewer"):
        corrected(plan, {"element": "wall", "at": [3, -0.1], "action": "remove"})


def test_reference_points_say_where_the_plan_lies(plan, caplog):
    caplog.set_level("INFO")
    # the map turned by a right angle: its x axis points north
    points = [((0, 0), (1000, 2000)), ((4, 0), (1000, 2004)), ((0, 3), (997, 2000))]
    found = corrected(
        plan,
        *(
            {
                "element": "reference_point",
                "at": list(at),
                "world": list(world),
                "crs": "EPSG:25832",
            }
            for at, world in points
        ),
    )
    reference = found.georeference
    assert (reference.crs, reference.residual_m) == ("EPSG:25832", pytest.approx(0, abs=1e-9))
    where = (reference.east_m, reference.north_m, reference.rotation_rad)
    assert where == pytest.approx((1000, 2000, np.pi / 2))
    note = tables.read_note(plan["free"].parent / "corrected/free.parquet",
                            planning.TABLES["free"], "georeference")  # fmt: skip
    assert json.loads(note)["crs"] == "EPSG:25832"
    assert_told(caplog.text, value=("3 reference points", "0.00 m"))


def test_two_points_say_that_they_do_not_show_exchanged_axes(plan, caplog):
    points = [
        {"element": "reference_point", "at": at, "world": world, "crs": "EPSG:25832"}
        for at, world in (([0, 0], [1000, 2000]), ([10, 0], [1010, 2000]))
    ]
    reference = corrected(plan, *points).georeference
    assert reference.fits_mirrored and "check point" in state_reference(reference)
    assert_told(caplog.text, value="axes", remedy="add a check_point")
    aside = {"element": "check_point", "at": [5, 5], "world": [1005, 2005], "crs": "EPSG:25832"}
    reference = corrected(plan, *points, aside).georeference
    assert not reference.fits_mirrored and "axes" not in state_reference(reference)


def test_each_control_and_check_point_has_its_residual(plan):
    """Two points 10 m apart that are 10.2 m apart outside, and one between that is 0.3 m aside."""
    known = {"crs": "EPSG:25832"}
    points = [((0, 0), (1000, 2000)), ((10, 0), (1010.2, 2000))]
    said = [
        {"element": "reference_point", "at": list(at), "world": list(world), **known}
        for at, world in points
    ]
    said.append({"element": "check_point", "at": [5, 0], "world": [1005.1, 2000.3], **known})
    reference = corrected(plan, *said).georeference
    (first, first_m), (second, second_m) = reference.control_off_m
    assert (first, second) == ("entry 1", "entry 2")
    assert (first_m, second_m) == pytest.approx((0.1, 0.1))
    ((check, check_m),) = reference.check_off_m
    assert check == "entry 3" and check_m == reference.check_rms_m == pytest.approx(0.3)
    without = corrected(plan, *said[:2]).georeference
    assert (without.east_m, without.rotation_rad) == (reference.east_m, reference.rotation_rad)


def test_points_that_are_off_are_told_by_their_names(plan, caplog):
    """One of five points is off by 0.2 m, each known to 1 cm; so is the check point."""
    known = {"crs": "EPSG:25832", "sigma_m": 0.01}
    places = [(0, 0), (7, 0), (7, 3), (0, 3), (3, 2)]
    said = [
        {"element": "reference_point", "at": [x, y], "world": [1000 + x, 2000 + y], **known}
        for x, y in places
    ]
    check = {"element": "check_point", "at": [5, 1], "world": [1005, 2001.2], **known}
    assert not corrected(plan, *said).georeference.faults
    said[1] |= {"name": "P7", "world": [1007.2, 2000]}
    reference = corrected(plan, *said, check).georeference
    point, held = reference.faults
    assert_told(point, value=("entry 2 (P7)", "0.200 m", "3.5"), remedy="measure it again")
    assert_told(held, value=("entry 6", "3.5"), remedy="measure it")
    assert_told(caplog.text, file="corrections.yaml", value="entry 2 (P7)")
    assert [name for name, _ in reference.control_off_m][:2] == ["entry 1", "P7"]
    assert point in state_reference(reference)


@pytest.mark.parametrize(
    ("line", "why"),
    [
        # the wall between the rooms, at x = 4.05, goes from y = -0.1 to 3.1
        ([[4.05, -3], [4.05, 6]], "reaches 2.9 m beyond wall 5, of 3.2 m; give a line"),
        ([[4.05, 2], [4.05, 4]], "reaches 0.9 m beyond wall 5"),
        ([[3.6, 2.5], [4.5, 2.5]], "runs across wall 5, not along it"),
    ],
)
def test_an_opening_that_fits_no_wall_is_told_and_the_rest_carried_out(plan, line, why):
    gone = {"element": "wall", "at": [1.975, 3.1], "action": "remove"}
    door = {"element": "opening", "action": "add", "line": line, "kind": "door"}
    found = corrected(plan, door, gone)
    (told,) = found.unmatched_corrections
    assert told.startswith("entry 1: the line of the opening ") and why in told
    assert found.n_corrections == 1
    assert len(found.openings["wall"]) == len(floorplan_making.openings()["wall"])


def test_a_door_that_opens_elsewhere_is_told_and_leaves_its_wall_whole(plan):
    door = {"element": "opening", "action": "add", "line": [[4.05, 2.2], [4.05, 3]]}
    found = corrected(plan, door | {"kind": "door", "swing": [9, 2]})
    assert "beside the door" in found.unmatched_corrections[0]
    assert found.solid("observed").covers(shapely.Point(4.05, 2.5))


def test_a_door_may_be_said_before_its_wall(plan):
    door = {"element": "opening", "action": "add", "line": [[1, 1.5], [1.9, 1.5]], "kind": "door"}
    wall = {"element": "wall", "action": "add", "line": [[0, 1.5], [4, 1.5]]}
    found = corrected(plan, door, wall)
    assert found.openings["wall"][-1] == found.walls["wall"][-1]


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ([[300, 0], [304, 0]], r"lies 297 m beyond the plan, at most 100 m are drawn"),
        ([[3, 1], [3, -200]], r"lies 200 m beyond the plan"),
    ],
)
def test_a_wall_off_the_plan_is_told(plan, line, said):
    with pytest.raises(StageError, match=said):
        corrected(plan, {"element": "wall", "action": "add", "line": line})


def test_an_opening_drawn_a_little_beyond_its_wall_is_added(plan):
    line = [[4.05, 2.2], [4.05, 3.4]]
    found = corrected(plan, {"element": "opening", "action": "add", "line": line, "kind": "door"})
    assert found.openings["width_m"][-1] == pytest.approx(1.2)


def test_an_opening_is_in_the_wall_that_it_fits(plan):
    """A pier of 0.3 m stands nearer to its middle than the wall that it is drawn along."""
    pier = {"element": "wall", "action": "add", "line": [[4.2, 2.3], [4.2, 2.6]]}
    door = {"element": "opening", "action": "add", "line": [[4.2, 1.7], [4.2, 2.9]], "kind": "door"}
    found = corrected(plan, pier, door)
    assert found.openings["wall"][-1] == 5 and found.openings["x0_m"][-1] == pytest.approx(4.05)


def test_a_line_beside_a_wall_leaves_it_between_the_rooms_that_are_joined(plan):
    beside = {"element": "room", "action": "split", "line": [[3.2, 0], [3.2, 3]]}
    one = {"element": "room", "action": "merge", "at": [3.6, 2.0], "with": [5, 2.0]}
    found = corrected(plan, beside, one)
    # 0.8 m x 3 m and 9 m2, and through the door of 0.9 m in the wall of 0.1 m
    assert sorted(found.rooms["area_m2"]) == pytest.approx([9.6, 11.49], abs=0.01)


PARTITION = {"element": "wall", "at": [4.0, 0.4], "action": "remove"}
MERGE = {"element": "room", "action": "merge", "at": [1, 1], "with": [5, 1]}


def test_rooms_are_open_where_the_wall_between_them_goes(plan, caplog):
    found = corrected(plan, PARTITION, {"element": "room", "at": [5, 1], "name": "Hall"})
    assert found.rooms["closed"].tolist() == [False, False]
    # 3 m long, less what the walls across reach over its ends
    assert_told(caplog.text, value=("room 0", "2.7 m"), remedy="merge")
    verdict = judge_plan(found)
    assert verdict.worth == SKETCH and found.opened_by_hand == [0, 1]
    assert_told(verdict.line, value=("corrections", "Hall"), remedy="merge")


def test_rooms_are_closed_once_they_are_one_or_parted_by_another_wall(plan):
    assert corrected(plan, PARTITION, MERGE).rooms["closed"].tolist() == [True]
    line = [[4.05, -0.1], [4.05, 3.1]]
    other = {"element": "wall", "action": "add", "line": line, "thickness_m": 0.1}
    assert corrected(plan, PARTITION, other).rooms["closed"].tolist() == [True, True]
    door = {"element": "opening", "action": "remove", "at": [4.05, 1.5]}
    assert corrected(plan, door).rooms["closed"].tolist() == [True, True]


def test_a_wall_that_stood_within_a_room_opens_none(plan):
    walls = MADE["walls"]()
    stub = {name: values[5:] for name, values in walls.items()} | {"wall": np.array([6], np.int32)}
    stub |= {"x0_m": [2.0], "y0_m": [-0.1], "x1_m": [2.0], "y1_m": [1.0], "face_left": [-1]}
    grown = {n: np.append(v, np.asarray(stub[n], v.dtype)) for n, v in walls.items()}
    tables.write_table(plan["walls"], planning.TABLES["walls"], grown)
    rooms = MADE["rooms"]()
    notched = shapely.box(0, 0, 4, 3) - shapely.box(1.95, 0, 2.05, 1.0)
    rooms["geometry"][0] = shapely.to_wkb(notched)
    tables.write_table(plan["rooms"], planning.TABLES["rooms"], rooms)
    found = corrected(plan, {"element": "wall", "at": [2.0, 0.6], "action": "remove"})
    assert len(found.walls["wall"]) == 6 and found.rooms["closed"].all()


@pytest.mark.parametrize("thickness_m", [0.04, 0.36, 0.6])
def test_a_wall_seen_from_one_side_leaves_rooms_closed_however_thick_it_is(plan, thickness_m):
    walls = MADE["walls"]()
    # no other is known, so that what is said is the usual thickness
    walls["thickness_m"][1:] = np.nan
    walls["face_right"][1:] = -1
    tables.write_table(plan["walls"], planning.TABLES["walls"], walls)
    facade = {"element": "wall", "at": [7.1, 2.0], "thickness_m": thickness_m}
    found = corrected(plan, facade)
    assert found.walls["thickness_m"][1] == thickness_m and found.rooms["closed"].all()


def test_a_room_keeps_its_ground_beside_a_pocket_that_a_wall_parts_from_it(plan):
    walls = MADE["walls"]()
    front = {name: values[5:] for name, values in walls.items()} | {"wall": np.array([6], np.int32)}
    front |= {"x0_m": [1.3], "y0_m": [-0.1], "x1_m": [1.3], "y1_m": [3.1], "thickness_m": [0.1]}
    grown = {n: np.append(v, np.asarray(front[n], v.dtype)) for n, v in walls.items()}
    tables.write_table(plan["walls"], planning.TABLES["walls"], grown)
    rooms = MADE["rooms"]()
    rooms["geometry"][0] = shapely.to_wkb(shapely.box(0.6, 0, 1.25, 3))
    tables.write_table(plan["rooms"], planning.TABLES["rooms"], rooms)
    found = corrected(plan, {"element": "wall", "at": [1.3, 1.0], "thickness_m": 0.08})
    # it follows the side of the wall
    assert found.areas[0].symmetric_difference(shapely.box(0.6, 0, 1.26, 3)).area < 0.05


@pytest.mark.parametrize("said", [{"kind": "furniture"}, {"action": "remove"}])
def test_the_ground_behind_a_front_that_is_none_is_its_rooms(plan, said):
    walls = MADE["walls"]()
    front = {name: values[1:2] for name, values in walls.items()} | {
        "wall": np.array([6], np.int32)
    }
    front |= {"x0_m": [3.4], "y0_m": [3.1], "x1_m": [3.4], "y1_m": [1.5]}
    grown = {n: np.append(v, np.asarray(front[n], v.dtype)) for n, v in walls.items()}
    tables.write_table(plan["walls"], planning.TABLES["walls"], grown)
    rooms = MADE["rooms"]()
    # its side, at y = 1.5, was not seen
    rooms["geometry"][0] = shapely.to_wkb(shapely.box(0, 0, 4, 3) - shapely.box(3.4, 1.5, 4, 3))
    tables.write_table(plan["rooms"], planning.TABLES["rooms"], rooms)
    found = corrected(plan, {"element": "wall", "at": [3.4, 2.2], **said})
    assert found.rooms["closed"].all()
    assert found.rooms["area_m2"][0] == pytest.approx(12.0, abs=0.01)
    assert found.areas[0].symmetric_difference(shapely.box(0, 0, 4, 3)).area < 0.01


def test_a_wall_drawn_along_an_open_side_closes_the_room(plan):
    walls = {n: v[[0, 1, 2, 3, 4]] for n, v in MADE["walls"]().items()}
    tables.write_table(plan["walls"], planning.TABLES["walls"], walls)
    openings = {n: v[[0, 2]] for n, v in MADE["openings"]().items()}
    tables.write_table(plan["openings"], planning.TABLES["openings"], openings)
    rooms = MADE["rooms"]() | {"closed": np.zeros(2, bool)}
    tables.write_table(plan["rooms"], planning.TABLES["rooms"], rooms)
    line = [[4.05, 0.0], [4.05, 3.0]]
    wall = {"element": "wall", "action": "add", "line": line, "thickness_m": 0.1}
    assert corrected(plan, wall).rooms["closed"].tolist() == [True, True]
    half = wall | {"line": [[4.05, 0.0], [4.05, 1.0]]}
    assert corrected(plan, half).rooms["closed"].tolist() == [False, False]
