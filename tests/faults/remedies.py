"""What a verdict advises, carried out on the drive that it was given of: a plan comes of it.

Each takes the drives through a floor by name and what was found of the lie, and returns drives to
make a plan of each alone, and keywords of `making.make_plan`, the same for all or for each its own.
"""

from dataclasses import replace

import numpy as np

from faults import judging, lies, making
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.stage.witnesses import rank_findings

_TURN = {
    "sensor turned by 90 degrees": (0.0, 0.0, -90.0),
    "sensor turned by 180 degrees": (0.0, 0.0, 180.0),
    "sensor rolled by 180 degrees": (180.0, 0.0, 0.0),
    "sensor nods by 8 degrees": (0.0, -8.0, 0.0),
}
"""Roll, pitch and yaw that nobody had stated, as `input.base_from_sensor` takes them."""


def follow_odometry(drive, _):
    """Return the drive, of which the odometry's poses are read."""
    return [drive], {"pose_topic": "/odom"}


def invert_poses(drive, _):
    return [replace(drive, map_from_base=se3.invert_pose(drive.map_from_base))], {}


def put_w_last(drive, _):
    xyz_m, quat = se3.split_pose(drive.map_from_base)
    poses = se3.pose_matrix(xyz_m, np.roll(quat, -1, axis=1))
    return [replace(drive, map_from_base=poses)], {}


def state_mount(name):
    """Return a remedy that states how the sensor is turned on its mount."""

    def state(drive, _):
        at_m = drive.base_from_sensor[:3, 3].tolist()
        return [drive], {"base_frame": "base_link", "base_from_sensor": [*at_m, *_TURN[name]]}

    return state


def ask_for_parts(drive, finding):
    """Return the drive for each of its two parts, of which one is named."""
    named = int(finding.remedy.partition("advanced.registration.part: ")[2].partition(" ")[0])
    assert named in (1, 2), finding.remedy
    return [drive, drive], [{"part": part} for part in (1, 2)]


def drive_apart(parts, _):
    """Return recordings of which each is a dataset of its own."""
    return parts, {}


def set_units(unit, *keys):
    """Return a remedy that states a unit by keys of `input`, which have to be what was advised."""

    def state(drive, found):
        advised = str(found) if isinstance(found, StageError) else found.remedy
        assert all(f"advanced.input.{key}" in advised for key in keys), advised
        return [drive], dict.fromkeys(keys, unit)

    return state


_NOTHING = None
REMEDIES = {
    "origin drifts by 1 cm a scan": follow_odometry,
    "two storeys on one another": ask_for_parts,
    "two storeys on one another, no odometry": ask_for_parts,
    "poses inverted": invert_poses,
    "quaternion w first": put_w_last,
    **{name: state_mount(name) for name in _TURN},
    "second bag beside the first": drive_apart,
    "all in feet": set_units("ft", "cloud_unit", "pose_unit"),
    "ranges in feet": set_units("ft", "cloud_unit"),
    "poses in feet": set_units("ft", "pose_unit"),
    "all in centimetres": set_units("cm", "cloud_unit", "pose_unit"),
    "ranges in centimetres": set_units("cm", "cloud_unit"),
    "all in millimetres": set_units("mm", "cloud_unit", "pose_unit"),
    "ranges in millimetres": set_units("mm", "cloud_unit"),
}
"""By the lies that raise them."""


def try_remedies(place, driven, *, planar, tally, names=tuple(REMEDIES)):
    """Carry out what is advised of some lies; what is left to tell of the drive is wrong.

    Parameters
    ----------
    place : pathlib.Path
    driven : dict of str to drives.Drive
        As `lies.list_lies` takes them.
    planar : bool
    tally : judging.Tally
    names : sequence of str
        Of `REMEDIES`.
    """
    known = lies.list_lies(planar=planar)
    for number, name in enumerate(name for name in names if name in known):
        made = known[name](driven)
        first = _find_first(place / f"{number}", made)
        parts, settings = REMEDIES[name](made, first)
        of_each = settings if isinstance(settings, list) else [settings] * len(parts)
        left = [
            making.make_plan(*_write(place / f"{number}_{i}", [part]), **given).contradictions
            for i, (part, given) in enumerate(zip(parts, of_each, strict=True))
        ]
        said = "; ".join(sentence for sentences in left for sentence in sentences)
        outcome = judging.SILENT if first == _NOTHING or said else judging.SOUND
        tally.add("remedies of lies", name, outcome, said)
        print(f"{name:<52}{outcome:<12}{said}"[:300], flush=True)


def _find_first(place, made):
    """Return the likeliest cause that is found of drives; an error where they are refused."""
    try:
        found = making.make_plan(*_write(place, made if isinstance(made, list) else [made]))
    except StageError as error:
        return error
    return rank_findings(found.findings)[0] if found.findings else _NOTHING


def _write(place, parts):
    place.mkdir(parents=True)
    return place, [str(part.write(place / f"run{i}")) for i, part in enumerate(parts)]
