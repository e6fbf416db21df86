import dataclasses

import numpy as np
import pytest

from helpers import toy_rooms
from scanplan.selection import methods, wall_cells
from scanplan.selection.objectives import CellCoverage

KNOWN = {**toy_rooms.LIMITS, "wall_height_m": 1.0}
LIMITS = {name: KNOWN[name] for name in methods.WALL_LIMITS if name in KNOWN}
SETTINGS = wall_cells.WallCellSettings(cell_m=0.25, reach_deg=3.5, max_tilt_deg=15.0, **LIMITS)
# what the toy sensor sees of its room's walls, and 1.5 m of the wall behind the doorway
SEEN_M = 6 + 6 + 4 + 1.5 + 1.6 + 1.5
MAKE = {False: toy_rooms.vlp16, True: toy_rooms.laser}


def observe(xyz_m, sensor_xyz_m=toy_rooms.SENSOR, *, planar=False, settings=SETTINGS):
    return wall_cells.observe_wall_cells(
        *(3, xyz_m),
        sensor_xyz_m=np.asarray(sensor_xyz_m, float),
        planar=planar,
        settings=settings,
        axes_deg=0,
    )


def turned(xyz_m, angle_rad):
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return xyz_m @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


def shown_m(*observed):
    """What several scans show together."""
    columns = wall_cells.observation_columns(np.arange(len(observed)), observed)
    cells = CellCoverage(
        columns["scan_id"], wall_cells.number_cells(columns), columns["length_m"], len(observed)
    )
    return cells.greedy().covered[-1]


@pytest.mark.parametrize("planar", [False, True])
def test_a_room_has_the_length_of_its_walls(planar):
    seen = observe(MAKE[planar](), planar=planar)
    assert seen["length_m"].sum() == pytest.approx(SEEN_M, rel=0.06)
    assert (seen["length_m"] > 0).all() and (seen["length_m"] <= SETTINGS.cell_m + 1e-9).all()


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("angle_deg", [10, 30, 45, 80])
def test_walls_of_any_direction_count_their_length(angle_deg, planar):
    angle = np.deg2rad(angle_deg)
    seen = observe(turned(MAKE[planar](), angle), turned(toy_rooms.SENSOR, angle), planar=planar)
    assert seen["length_m"].sum() == pytest.approx(SEEN_M, rel=0.12)


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("angle_deg", [-45, -20, 1, 33, 44])
def test_along_the_walls_a_turned_room_has_the_same_cells(angle_deg, planar):
    scan = MAKE[planar]()
    angle = np.deg2rad(angle_deg)
    there = turned(scan, angle), turned(toy_rooms.SENSOR, angle)
    found_deg = wall_cells.find_main_direction([there], planar=planar, settings=SETTINGS)
    assert abs((found_deg - angle_deg + 45) % 90 - 45) <= 1
    here = observe(scan, planar=planar)
    # a sensor's cells of equal angle are turned with the map's axes: no others are compared
    if planar:
        seen = wall_cells.observe_wall_cells(
            *(3, there[0]),
            sensor_xyz_m=there[1],
            planar=True,
            settings=SETTINGS,
            axes_deg=angle_deg,
        )
        for name in (*wall_cells.KEYS, "length_m"):
            np.testing.assert_allclose(seen[name], here[name], atol=1e-3)
        assert (seen["axes_deg"] == angle_deg).all()


def observe_by(facings_deg):
    """Points of a scan in the plane on one wall 4 m long and 2 m away for each way it faces."""
    along_m = np.linspace(-2, 2, 200)
    wall = np.column_stack([np.full(200, -2.0), along_m, np.zeros(200)])
    return np.concatenate([turned(wall, np.deg2rad(degrees)) for degrees in facings_deg])


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("angle_deg", [0, 30])
def test_without_noise_the_direction_is_that_of_the_walls(angle_deg, planar):
    scan = toy_rooms.laser(noise_m=0.0) if planar else toy_rooms.vlp16(noise_m=0.0)
    angle = np.deg2rad(angle_deg)
    there = turned(scan, angle), turned(toy_rooms.SENSOR, angle)
    found_deg = wall_cells.find_main_direction([there], planar=planar, settings=SETTINGS)
    assert found_deg == angle_deg


def test_a_wall_somewhat_askew_does_not_turn_the_direction_of_the_others():
    most = [(observe_by([angle]), np.zeros(3)) for angle in (0, 90, 180, 0, 90, 3)]
    assert wall_cells.find_main_direction(most, planar=True, settings=SETTINGS) == 0


def test_most_walls_decide_and_none_are_along_the_map():
    askew = turned(toy_rooms.laser(), np.deg2rad(30)), turned(toy_rooms.SENSOR, np.deg2rad(30))
    straight = toy_rooms.laser(), toy_rooms.SENSOR
    assert (
        wall_cells.find_main_direction([straight, askew, askew], planar=True, settings=SETTINGS)
        == 30
    )
    empty = np.zeros((0, 3)), toy_rooms.SENSOR
    assert wall_cells.find_main_direction([empty], planar=True, settings=SETTINGS) is None


def test_what_is_given_along_the_cells_is_turned_to_the_map():
    np.testing.assert_allclose(
        wall_cells.turn_to_map(np.array([[2.0, 1.0]]), 90), [[-1, 2]], atol=1e-12
    )


def test_a_quarter_turn_and_whole_cells_change_nothing_but_the_cells():
    scan, whole = toy_rooms.vlp16(), np.array([40 * SETTINGS.cell_m, -8 * SETTINGS.cell_m, 0])
    here, there = observe(scan), observe(scan + whole, toy_rooms.SENSOR + whole)
    np.testing.assert_allclose(there["length_m"], here["length_m"], atol=1e-9)
    along_x = here["facing"] >= 2
    np.testing.assert_array_equal(there["along"] - here["along"], np.where(along_x, 40, -8))
    quarter = turned(scan, np.pi / 2), turned(toy_rooms.SENSOR, np.pi / 2)
    assert observe(*quarter)["length_m"].sum() == pytest.approx(here["length_m"].sum(), rel=0.01)


def test_both_faces_of_a_thin_wall_count():
    sheet = np.array([(0, 0, 8, 0.0)])
    above, below = np.array([4, 2.0, 0.9]), np.array([4, -2.0, 0.9])
    scans = [observe(toy_rooms.vlp16(at, sheet), at) for at in (above, below)]
    assert shown_m(*scans) == pytest.approx(shown_m(scans[0]) + shown_m(scans[1]))
    assert {f for s in scans for f in s["facing"][s["length_m"] > 0.1].tolist()} == {2, 3}


def test_the_same_wall_a_little_off_counts_little_more_than_once():
    scan = toy_rooms.vlp16()
    alone = shown_m(observe(scan))
    for off_m in (0.01, 0.03, 0.06):
        moved = np.array([off_m, off_m, 0])
        both = shown_m(observe(scan), observe(scan + moved, toy_rooms.SENSOR + moved))
        assert alone <= both <= alone * (1 + 1.5 * off_m / SETTINGS.cell_m)


def test_fewer_returns_show_less_and_none_nothing():
    scan, rng = toy_rooms.vlp16(), np.random.default_rng(0)
    lengths = [
        observe(scan[rng.random(len(scan)) < share])["length_m"].sum()
        for share in (1, 0.3, 0.1, 0.02)
    ]
    assert (np.diff(lengths) < 0).all()
    for empty in (np.empty((0, 3)), scan[:3]):
        assert [len(column) for column in observe(empty).values()] == [0, 0, 0, 0, 0]


def test_low_things_are_no_walls():
    scan = toy_rooms.vlp16()
    low = np.concatenate([scan[:, :2], 0.1 * scan[:, 2:]], axis=1)
    sensor = toy_rooms.SENSOR * (1, 1, 0.1)
    assert observe(low, sensor)["length_m"].sum() < 0.05 * SEEN_M
    anything = dataclasses.replace(SETTINGS, min_height_m=0.0)
    assert (
        observe(low, sensor, settings=anything)["length_m"].sum()
        > 5 * observe(low, sensor)["length_m"].sum()
    )


def test_the_order_of_points_and_the_map_s_origin_do_not_matter():
    scan = toy_rooms.vlp16()
    shuffled = observe(scan[np.random.default_rng(2).permutation(len(scan))])
    for name, column in observe(scan).items():
        np.testing.assert_allclose(shuffled[name], column, rtol=1e-9)
    far = np.array([5e5, 4e6, 0])
    moved = observe(scan + far, toy_rooms.SENSOR + far)
    np.testing.assert_allclose(moved["length_m"].sum(), observe(scan)["length_m"].sum(), rtol=1e-6)


def test_cells_have_one_number_each():
    columns = wall_cells.observation_columns(
        [4, 9], [observe(toy_rooms.vlp16(seed=s)) for s in (1, 2)]
    )
    numbers = wall_cells.number_cells(columns)
    named = list(zip(columns["facing"], columns["along"], columns["across"], strict=True))
    assert (
        len(set(zip(numbers.tolist(), named, strict=True)))
        == len(set(named))
        == len(set(numbers.tolist()))
    )
    assert numbers.min() >= 0


def test_points_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="finite"):
        observe(np.full((50, 3), np.nan))


def test_what_is_seen_neither_to_a_wall_s_height_nor_to_its_end_counts_half():
    # 0.4 m above the floor and 1 m away the beams reach 0.67 m
    sensor, sheet = np.array([0.5, 1.0, 0.4]), np.array([(0, 0, 1, 0.0), (0, 6, 1, 6.0)])
    scan = toy_rooms.vlp16(sensor, sheet)
    near = {
        height_m: observe(
            scan, sensor, settings=dataclasses.replace(SETTINGS, wall_height_m=height_m)
        )
        for height_m in (0.6, 1.0)
    }
    shown = {
        height_m: seen["length_m"][seen["facing"] == 3].sum() for height_m, seen in near.items()
    }
    assert shown[0.6] == pytest.approx(1.0, rel=0.1)
    assert shown[1.0] == pytest.approx(shown[0.6] / 2)
