"""Surveys with a wrong unit, mounting or clock: refused, mended, or shown as doubt.

Small floors that no level of doubt was set by, driven through by the simulator; what it recorded is
written anew with one mistake in all of it.
"""

import json

import numpy as np
import shapely

from faults import drives, judging, making
from helpers import bag_making
from helpers.default_settings import SETTINGS
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.plan.floorplan import centrelines_m, line_shapes
from scanplan.project import stage_settings
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey
from scanplan.store import schemas, tables
from simulate_survey import simulate_survey

GROUP = "wrong units and mountings"
_MOUNT = ((0.1, 0.0, 0.6), (0.0, 0.0, 0.0, 1.0))
_QUARTER_TURN = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))
_PARTS = ("walls", "doors", "windows", "way")
_POSES, _CLOUDS = "/localiser", "/points"
_NEAR_M = 0.25  # of a wall's middle: half the thickest wall and what a small drive errs by
_LEAST_NEAR = 0.9  # of the length of the faces that a right plan draws; others are of furniture

# walls (thickness, line), doors and windows (width, place), and the way
_FLOORS = {
    "corridor": {
        "walls": [
            (0.3, [(0, 0), (9.6, 0), (9.6, 6), (0, 6), (0, 0)]),
            (0.12, [(0, 1.9), (9.6, 1.9)]),
            (0.12, [(3.4, 1.9), (3.4, 6)]),
            (0.12, [(6.2, 1.9), (6.2, 6)]),
        ],
        "doors": [(0.9, (1.2, 1.9)), (0.9, (4.9, 1.9)), (0.9, (8.3, 1.9))],
        "windows": [(1.5, (1.6, 6)), (1.2, (4.8, 6)), (1.8, (8.0, 6))],
        "way": [(0.8, 1.0), (1.2, 1.0), (1.2, 4), (1.2, 1.0), (8.3, 1.0), (8.3, 4.2)],
    },
    "hall": {
        "walls": [
            (0.24, [(0, 0), (11, 0), (11, 5.2), (0, 5.2), (0, 0)]),
            (0.15, [(7, 0), (7, 5.2)]),
            (0.1, [(7, 2.8), (11, 2.8)]),
        ],
        "doors": [(1.0, (7, 1.3)), (0.9, (7, 4.1))],
        "windows": [(2.0, (2.5, 0)), (1.4, (11, 1.4)), (1.4, (9, 5.2))],
        "way": [(1.2, 2.6), (5.5, 2.6), (5.5, 1.3), (9, 1.3), (5.5, 1.3), (5.5, 4.1), (8.5, 4.1)],
    },
    "four rooms": {
        "walls": [
            (0.2, [(0, 0), (8.2, 0), (8.2, 7.4), (0, 7.4), (0, 0)]),
            (0.1, [(4.4, 0), (4.4, 7.4)]),
            (0.1, [(0, 3.3), (8.2, 3.3)]),
        ],
        "doors": [(0.9, (4.4, 1.5)), (0.9, (2.1, 3.3)), (0.9, (4.4, 5.6))],
        "windows": [(1.2, (0, 1.6)), (1.6, (8.2, 5.4)), (1.0, (6.4, 0))],
        "way": [(6.4, 1.5), (2.1, 1.5), (2.1, 5.6), (6.6, 5.6)],
    },
    "gallery": {
        "walls": [
            (0.25, [(0, 0), (14, 0), (14, 3.1), (5, 3.1), (5, 7), (0, 7), (0, 0)]),
            (0.15, [(0, 3.1), (5, 3.1)]),
        ],
        "doors": [(1.0, (2.6, 3.1))],
        "windows": [(1.8, (9, 0)), (1.8, (12, 0)), (1.2, (0, 5))],
        "way": [(13, 1.5), (2.6, 1.5), (2.6, 5.4), (3.8, 5.4)],
    },
}


def _keep(values):
    return values


def _take_for_radians(quat):
    """Return headings of so many degrees, given as if they were radians."""
    half = np.degrees(2 * np.arctan2(quat[:, 2], quat[:, 3])) / 2
    return np.column_stack([np.zeros((len(half), 2)), np.sin(half), np.cos(half)])


# what becomes of points (n, 3), of headings (n, 4), of the stamps of poses, and the mounting's turn
_MISTAKES = {
    "none": {},
    "degrees for radians": {"turn": _take_for_radians},
    "millimetres for metres": {"points": lambda xyz: 1000 * xyz},
    "poses 0.5 s ahead": {"late_s": 0.5},
    "poses 0.5 s behind": {"late_s": -0.5},
    "mounted 90 degrees off": {"mount_quat": _QUARTER_TURN},
    "upside down": {"points": lambda xyz: xyz * (1, -1, -1)},
    "left-handed": {"points": lambda xyz: xyz * (1, -1, 1)},
}


def try_mistakes(folder, tally, floors=tuple(_FLOORS)):
    """Make the plan of every floor with every mistake."""
    for floor in floors:
        survey = _drive_through(folder, floor)
        for number, (mistake, changes) in enumerate(_MISTAKES.items()):
            place = folder / f"{floor}_{number}"
            outcome, said = _judge_mistake(place, survey, floor, mistake, changes)
            tally.add(GROUP, f"{floor}, {mistake}", outcome, said)
            print(f"{floor:<12}{mistake:<26}{outcome:<12}{said}"[:300], flush=True)


def _judge_mistake(place, survey, floor, mistake, changes):
    place.mkdir()
    try:
        near, found = _make_plan(place, _write_survey(place, survey, **changes), floor)
    except StageError as error:
        return (judging.SILENT if mistake == "none" else judging.CLEAR), str(error)
    said = f"{near:.0%} of the faces are of the floor; {'; '.join(found.contradictions)}"
    if found.contradictions:
        return (judging.SILENT if mistake == "none" else judging.TOLD), said
    return (judging.SOUND if near >= _LEAST_NEAR else judging.SILENT), said


def _drive_through(folder, floor):
    """Return stamps, points in the sensor's frame and base's poses of a simulated drive."""
    building = folder / f"{floor}.geojson"
    building.write_text(json.dumps(drives.draw_floor(*(_FLOORS[floor][part] for part in _PARTS))))
    outputs = [folder / f"{floor}{name}" for name in (".bag", "_truth.geojson", "_a.tum", "_b.tum")]
    settings = stage_settings.select_simulation(SETTINGS)
    sensor = settings["sensor"] | {"n_azimuth": 360, "sweep": False, "rate_hz": 5.0}
    simulate_survey(building, *outputs, **(settings | {"sensor": sensor}))
    with open_survey(
        [str(outputs[0])], Reading(**stage_settings.select_section(SETTINGS, "input"))
    ) as read:
        t_ns = read.stamps()
        poses, _, covered = frame_edges.chain_poses(read.pose_edges(), t_ns, max_gap_s=2.0)
        rows = np.flatnonzero(covered)
        points = [scan.xyz_m for scan in read.scans(rows.tolist())]
    sensor_from_base = se3.invert_pose(se3.pose_matrix(*map(np.array, _MOUNT)))
    return t_ns[rows], points, poses[rows] @ sensor_from_base


def _write_survey(
    place, survey, *, points=_keep, turn=_keep, late_s=0.0, mount_quat=_MOUNT[1], kind="ros1"
):
    t_ns, clouds, poses = survey
    xyz_m, quat = se3.split_pose(poses)
    maker = bag_making.Maker(kind)
    mounting = (int(t_ns[0]), "base_link", "lidar", _MOUNT[0], mount_quat)
    entries = [("/tf_static", t_ns[0] - 1, maker.transforms(mounting))]
    for now, cloud, at_m, heading in zip(t_ns, clouds, xyz_m, turn(quat), strict=True):
        stamp = maker.pose_stamped(int(now + late_s * 1e9), at_m, heading)
        entries.append((_POSES, now, stamp))
        entries.append((_CLOUDS, now + 1, maker.cloud(int(now), points(cloud).astype(np.float32))))
    return maker.write(place / "run", entries)


def _make_plan(place, recording, floor):
    """Return which share of the faces' length lies on the floor's walls, and the doubts."""
    found = making.make_plan(place, [str(recording)], base_frame="base_link")
    faces = line_shapes(
        centrelines_m(tables.read_table(place / "plan_faces.parquet", schemas.FACES))
    )
    walls = shapely.union_all([shapely.linestrings(line) for _, line in _FLOORS[floor]["walls"]])
    on_walls = shapely.intersection(faces, shapely.buffer(walls, _NEAR_M))
    near = shapely.length(on_walls).sum() / shapely.length(faces).sum()
    return near, found
