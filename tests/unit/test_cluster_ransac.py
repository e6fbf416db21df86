from functools import partial

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from helpers import extracting, toy_rooms, upright
from reference import cluster_ransac as literal
from scanplan.extraction import cluster_ransac

# start and end of every face the sensor of the toy room sees, the sensor to the left of the way
FACES = np.array(
    [
        (0, 0, 6, 0),
        (6, 0, 6, 1.5),
        (6, 2.4, 6, 4),
        (6, 4, 0, 4),
        (0, 4, 0, 0),
        (9, 1.5, 9, 3.0),  # through the doorway: from y = 1.6 - 7 (0.1 / 4) to 1.6 + 7 (0.8 / 4)
    ]
)
QUICK = settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow])


extract = partial(extracting.extract, "cluster_ransac")


def check_toy_room(found, *, turn_rad=0.005):
    ends = np.column_stack([found.start_m, found.end_m])
    assert len(found) == len(FACES)
    for face in FACES:
        nearest = np.argmin(np.abs(ends - face).max(axis=1))
        along = (face[2:] - face[:2]) / np.linalg.norm(face[2:] - face[:2])
        normal = np.array([-along[1], along[0]])
        middle_m = (found.start_m[nearest] + found.end_m[nearest]) / 2
        assert abs((middle_m - face[:2]) @ normal) < 0.005
        assert found.normal[nearest] == pytest.approx(normal, abs=turn_rad)
        assert (found.end_m - found.start_m)[nearest] @ along > 0
        assert (
            np.abs(ends[nearest] - face).max() < 0.17
        )  # where the next beam is beyond the corner (6, 0)


@pytest.mark.parametrize("seed", range(4))
def test_every_wall_of_the_room_in_space(seed):
    found = extract(toy_rooms.vlp16(seed=seed))
    check_toy_room(found)
    assert (np.diff(found.n_points) <= 0).all()
    assert found.rmse_m == pytest.approx(0.009, abs=0.0035)
    assert (found.z_range_m[:, 0] > -0.05).all()
    assert (found.z_range_m[:, 1] < toy_rooms.HEIGHT_M + 0.05).all()


@pytest.mark.parametrize("depth_m", [0.15, 0.2, 0.3])
def test_a_recess_no_deeper_than_the_bandwidth_is_a_wall_of_its_own(depth_m):
    """In the wall at y = 4, from x = 1.5 to x = 2.7; mean shift puts both into one cluster."""
    y_m = 4 + depth_m
    recess = [(1.5, 4, 1.5, y_m), (1.5, y_m, 2.7, y_m), (2.7, y_m, 2.7, 4)]
    around = [(0, 4, 1.5, 4), (2.7, 4, 6, 4)]
    others = [wall for wall in toy_rooms.ROOM.tolist() if not wall[1] == wall[3] == 4]
    room = np.array([*others, *around, *recess], float)
    found = extract(toy_rooms.laser(segments=room), planar=True)
    ends_m = np.stack([found.start_m, found.end_m], axis=1)
    (row,) = np.flatnonzero((np.abs(ends_m[:, :, 1] - y_m) < 0.02).all(axis=1))
    np.testing.assert_allclose(np.sort(ends_m[row, :, 0]), [1.5, 2.7], atol=0.1)
    assert (np.abs(ends_m[:, :, 1] - 4) < 0.02).all(axis=1).sum() == 2


@pytest.mark.parametrize("seed", range(4))
def test_every_wall_of_the_room_in_the_plane(seed):
    check_toy_room(extract(toy_rooms.laser(seed=seed), planar=True), turn_rad=0.015)


def test_coarse_planar_scans_too():
    found = extract(toy_rooms.laser(beams=360), planar=True)
    assert len(found) >= 5
    offsets = (found.start_m * found.normal).sum(axis=1)
    for expected in (0, -4, 0, -6):
        assert np.abs(offsets - expected).min() < 0.01


@given(st.floats(-3.1, 3.1), st.floats(-30, 30), st.floats(-30, 30))
@QUICK
def test_walls_move_with_room_and_sensor(angle_rad, x, y):
    turn = np.array(
        [
            [np.cos(angle_rad), -np.sin(angle_rad), 0],
            [np.sin(angle_rad), np.cos(angle_rad), 0],
            [0, 0, 1],
        ]
    )
    shift = np.array([x, y, 1.0])
    moved = extract(toy_rooms.vlp16() @ turn.T + shift, turn @ toy_rooms.SENSOR + shift)
    back = (
        (turn.T[:2, :2] @ (moved.start_m - shift[:2]).T).T,
        (turn.T[:2, :2] @ (moved.end_m - shift[:2]).T).T,
    )
    check_toy_room(
        type(moved)(
            *back,
            (turn.T[:2, :2] @ moved.normal.T).T,
            moved.n_points,
            moved.rmse_m,
            moved.z_range_m - 1,
        )
    )


def test_a_wall_close_to_the_sensor_and_one_in_its_direction():
    segments = np.array([(-5, 0.25, 5, 0.25), (-5, -0.25, 5, -0.25), (4, -0.25, 4, 0.25)], float)
    sensor = np.array([0, 0, 0.9])
    found = extract(toy_rooms.laser(sensor, segments, beams=1440), sensor, planar=True)
    assert found.normal[:2] == pytest.approx(
        np.array([(0, 1), (0, -1)]) * np.sign(found.normal[0, 1]), abs=0.01
    )
    assert np.abs(found.start_m[:2, 1]) == pytest.approx([0.25, 0.25], abs=0.01)


def test_a_wall_that_bends_a_little_is_two_and_the_first_takes_nothing_of_the_second():
    segments = np.array([(-3, 2, 0, 2), (0, 2, 3, 1.4)], float)
    sensor = np.array([0.0, 0, 0])
    found = extract(toy_rooms.laser(sensor, segments, beams=1440), sensor, planar=True)
    assert len(found) == 2
    assert np.linalg.norm(found.end_m - found.start_m, axis=1) == pytest.approx([3, 3], abs=0.45)


def test_noise_leaves_no_second_wall_beside_the_first():
    check_toy_room(extract(toy_rooms.vlp16(noise_m=0.02)), turn_rad=0.01)


def test_a_wall_goes_on_between_a_counter_and_the_cabinets_above_it():
    """One beam passes over the counter and under the cabinets: what it meets has no normal.

    All three are upright surfaces; which of them are walls is not asked of one scan.
    """
    wall, counter, cabinets = (
        (4, -3, 4, 3, 0, 2.6),
        (3.4, -0.6, 3.4, 0.9, 0, 0.9),
        (3.7, -0.6, 3.7, 0.9, 1.1, 2.2),
    )

    def find_wall_y(*faces):
        found = extract(upright.returns(faces, columns=1800), (0, 0, 0))
        of_wall = np.abs(found.start_m[:, 0] - 4) < 0.1
        return sorted(zip(found.start_m[of_wall, 1], found.end_m[of_wall, 1], strict=True))

    assert find_wall_y(wall, counter, cabinets) == [pytest.approx((-3, 3), abs=0.1)]
    # without that beam it is two: nothing is known of what is between
    assert len(find_wall_y(wall, (*counter[:5], 1.1), cabinets)) == 2


def test_a_shelf_on_the_line_of_a_wall_joins_its_pieces_and_the_floor_does_not():
    """The sensor is 1.5 m above the floor.

    Between y = -0.6 and 0.6 it sees a shelf of 1 m height, or the floor.
    """
    fine = np.arange(0, 1, 0.025)
    along, up = np.meshgrid(np.r_[-3 + 2.4 * fine, 0.6 + 2.4 * fine], -1.5 + 2.4 * fine)
    pieces = np.column_stack([np.full(along.size, 4.0), along.ravel(), up.ravel()])
    deep, wide = np.meshgrid(3.4 + 0.62 * fine, -0.6 + 1.2 * fine)
    shelf = np.column_stack([deep.ravel(), wide.ravel(), np.full(deep.size, -0.5)])
    floor = np.column_stack([deep.ravel(), wide.ravel(), np.full(deep.size, -1.5)])
    assert len(extract(np.vstack([pieces, shelf, floor]), (0, 0, 0))) == 1
    assert len(extract(np.vstack([pieces, floor]), (0, 0, 0))) == 2


def test_a_round_wall_becomes_chords():
    angle = np.linspace(-1.2, 1.2, 200)
    corners = 5 * np.column_stack([np.cos(angle), np.sin(angle)])
    segments = np.column_stack([corners[:-1], corners[1:]])
    found = extract(
        toy_rooms.laser(np.array([1.0, 0, 0]), segments), np.array([1.0, 0, 0]), planar=True
    )
    lengths = np.linalg.norm(found.end_m - found.start_m, axis=1)
    assert len(found) >= 4
    assert lengths.sum() > 0.75 * 12
    for ends in (found.start_m, found.end_m):
        assert np.linalg.norm(ends, axis=1) == pytest.approx(np.full(len(found), 5), abs=0.08)


def test_a_few_returns_from_far_away_are_no_wall():
    far = np.random.default_rng(1).normal(0, 0.02, (12, 3)) + np.column_stack(
        [np.full(12, 40.0), np.tile([0, 0.15, 0.3, 0.45], 3), np.repeat([0, 1.4, 2.8], 4)]
    )
    found = extract(np.vstack([toy_rooms.vlp16(), far]))
    check_toy_room(found)


def test_one_wall_in_99_percent_of_outliers():
    draw = np.random.default_rng(1)
    wall = np.column_stack(
        [np.full(400, 3.0), draw.uniform(-1.5, 1.5, 400), draw.uniform(-0.8, 0.8, 400)]
    )
    dust = draw.uniform(-20, 20, (39_600, 3)) * (1, 1, 0.1)
    points = np.vstack([wall, dust])
    found = extract(points, (0, 0, 0))
    assert len(found) >= 1
    assert found.start_m[0, 0] == pytest.approx(3, abs=0.02)
    assert found.normal[0] == pytest.approx([-1, 0], abs=0.02)


def test_feet_of_a_wall_coincide_and_near_walls_stay_apart():
    along = np.linspace(-3, 3, 7)
    wall = np.column_stack([np.full(7, 2.0), along])
    assert cluster_ransac.project_along_normals(wall, np.tile([-1.0, 0], (7, 1))) == pytest.approx(
        np.tile([3.0, 0], (7, 1))
    )
    through = np.array([(1.0, 0.0), (0.0, 1.0)])
    feet = cluster_ransac.project_along_normals(through, np.array([(0.0, -1.0), (-1.0, 0.0)]))
    assert np.linalg.norm(feet[0] - feet[1]) == pytest.approx(np.sqrt(2))


def test_the_same_walls_as_the_literal_method():
    xyz_m = toy_rooms.vlp16(segments=toy_rooms.ROOM[:3], columns=90)
    xyz_m = xyz_m[
        (xyz_m[:, 0] < 6.1) & (xyz_m[:, 2] > 0.05) & (xyz_m[:, 2] < toy_rooms.HEIGHT_M - 0.05)
    ]
    found = extract(xyz_m)
    lines = literal.lines(
        xyz_m - toy_rooms.SENSOR,
        reach_deg=5.0,
        max_tilt_deg=15.0,
        bandwidth_m=0.5,
        inlier_m=0.05,
        min_points=60,
        rng=np.random.default_rng(1),
        max_trials=30,
    )
    assert len(found) >= 3
    for start_m, normal in zip(found.start_m, found.normal, strict=True):
        offset_m = normal @ (start_m - toy_rooms.SENSOR[:2])
        assert any(-n @ normal > 0.999 and abs(d + offset_m) < 0.01 for n, d in lines)
    assert len(lines) >= 3


def test_one_return_from_a_thousand_kilometres_spoils_nothing():
    found = extract(np.vstack([toy_rooms.vlp16(), [(1e6, 3e5, 2e5)]]))
    check_toy_room(found)


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_poles_and_repeated_returns_are_handled(seed, planar):
    """Cells with all returns at one x, y, as of a thin pole, end no run."""
    rng = np.random.default_rng(seed)
    places = rng.uniform(-4, 4, (rng.integers(1, 40), 3)) * ([1, 1, 0] if planar else [1, 1, 0.3])
    points = np.repeat(places, rng.integers(1, 40, len(places)), axis=0)
    if not planar:
        points[:, 2] += rng.uniform(-0.5, 0.5, len(points))
    found = extract(points, planar=planar)
    assert np.isfinite(found.start_m).all() and np.isfinite(found.end_m).all()


def test_a_round_wall_in_space_becomes_chords():
    angle = np.linspace(-1.2, 1.2, 200)
    corners = 5 * np.column_stack([np.cos(angle), np.sin(angle)])
    segments = np.column_stack([corners[:-1], corners[1:]])
    found = extract(
        toy_rooms.vlp16(np.array([1.0, 0, 0.9]), segments, columns=900), np.array([1.0, 0, 0.9])
    )
    lengths = np.linalg.norm(found.end_m - found.start_m, axis=1)
    assert len(found) >= 4
    assert lengths.sum() > 0.7 * 12
    for ends in (found.start_m, found.end_m):
        assert np.linalg.norm(ends, axis=1) == pytest.approx(np.full(len(found), 5), abs=0.08)
