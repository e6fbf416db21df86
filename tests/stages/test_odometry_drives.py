"""Odometry that lies: reset, a robot that was carried, corridors that look the same."""

import json

import numpy as np
import pytest

from helpers.odometry_drives import ODOMETRY, errors_m, record_drives, register_drive

NO_ERROR = {"scale_share": 0.0, "drift_deg_per_m": 0.0}
# two corridors with the same niches, 6 m apart, on a lobby that goes on farther to the right
TWINS = [
    *([0, 0], [0, 2], [1, 2], [1, 7], [0.4, 7], [0.4, 8.2], [1, 8.2], [1, 14], [3, 14], [3, 11]),
    *([3.8, 11], [3.8, 9.5], [3, 9.5], [3, 2], [7, 2], [7, 7], [6.4, 7], [6.4, 8.2], [7, 8.2]),
    *([7, 14], [9, 14], [9, 11], [9.8, 11], [9.8, 9.5], [9, 9.5], [9, 2], [12, 2], [12, 0], [0, 0]),
]
LEFT = [[2, 1], [2, 13], [2, 1]]
RIGHT = [[8, 1], [8, 13], [8, 1]]


@pytest.fixture(scope="module")
def twins(tmp_path_factory):
    wall = {
        "type": "Feature",
        "properties": {"kind": "wall", "thickness_m": 0.2},
        "geometry": {"type": "LineString", "coordinates": TWINS},
    }
    path = tmp_path_factory.mktemp("twins") / "twins.geojson"
    drawing = {"type": "FeatureCollection", "height_m": 2.5, "features": [wall]}
    path.write_text(json.dumps(drawing))
    return path


@pytest.fixture(scope="module")
def office(project_root):
    return project_root / "config/buildings/demo_office.geojson"


def placed(building, folder, ways_m, sensor, odometry):
    """A drive as registered, and how far its poses are off, in the median and at most."""
    drive = register_drive(
        record_drives(building, folder, ways_m, sensor=sensor, odometry=odometry), folder
    )
    off_m = errors_m(
        drive.t_ns[drive.kept], drive.world_from_sensor[drive.kept], folder / "truth_poses.tum"
    )
    return " ".join(drive.told), np.median(off_m), off_m.max()


def test_odometry_that_is_reset_goes_on_and_is_told(office, tmp_path):
    first = [[1.9, 3.5], [1.9, 5.95], [3.5, 5.95]]
    second = [[3.5, 5.95], [7.0, 5.95], [1.9, 5.95], [1.9, 3.5]]
    told, median_m, most_m = placed(office, tmp_path, [first, second], "3d", ODOMETRY)
    assert "jumps or is reset (in all: 1)" in told and "carried" not in told
    assert median_m < 0.03 and most_m < 0.1


def test_a_robot_that_was_carried_to_another_room_is_told(office, tmp_path):
    """Odometry says that it stood; it comes to ground that it had been on from elsewhere."""
    here = [[1.9, 5.95], [1.9, 3.5], [1.9, 5.95], [5.0, 5.95], [1.9, 5.95]]
    there = [[16.5, 3.5], [16.5, 5.95], [10.3, 5.95], [10.3, 8.2], [10.3, 5.95], [16.5, 5.95]]
    told, _, most_m = placed(office, tmp_path, [here, there], "3d", NO_ERROR)
    assert most_m > 1.0
    assert "carried" in told and "folded" in told


def test_twin_corridors_are_not_laid_on_one_another(twins, tmp_path):
    way_m = [*LEFT, *RIGHT, *LEFT]
    told, median_m, most_m = placed(twins, tmp_path, [way_m], "2d", ODOMETRY)
    assert told == ""
    assert median_m < 0.02 and most_m < 0.05


def test_a_robot_that_was_carried_to_a_twin_corridor_is_told_once_it_leaves_it(twins, tmp_path):
    """In it nothing differs; the lobby that it then comes to is another one than odometry says."""
    first = [[2, 13], [2, 1], [5, 1], [2, 1], [2, 13]]
    second = [[8, 13], [8, 1], [5, 1], [8, 1], [11, 1]]
    told, _, most_m = placed(twins, tmp_path, [first, second], "2d", NO_ERROR)
    assert most_m > 1.0
    assert "do not look the same" in told and "folded" in told
