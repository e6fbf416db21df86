"""Damaged, odd and hostile recordings, read as the first stages read them."""

import bz2
import struct
from functools import partial
from pathlib import Path

import numpy as np

from faults import damaged_bags
from faults.judging import Case
from helpers import bag_making
from scanplan.recordings import bags
from scanplan.recordings.survey import Reading, open_survey

_TOPICS = ("/points", "/amcl_pose")


def list_damage_cases(folder, n_each):
    """Every kind of recording damaged at random places, and read as if it were sound."""
    cases = []
    for kind in bag_making.KINDS:
        maker = bag_making.Maker(kind)
        entries = list(bag_making.survey(maker, n_scans=30))
        path = maker.write(Path(folder, "strict", kind), entries)
        file = path if path.is_file() else next(f for f in path.iterdir() if f.suffix != ".yaml")
        sound = file.read_bytes()
        number = len(read_strictly(path))
        for seed in range(n_each):
            run = partial(_damage_and_read, path, file, sound, seed)
            name = f"{kind} seed {seed}"
            # without checksums what a message says can change; none may be lost in silence
            cases.append(Case("damaged recordings", name, run, lambda n, m=number: n == m))
    return cases


def read_strictly(path):
    with bags.open_bag(path) as bag:
        # a message is read when it is decoded
        return [bag.header(c, raw) for c, _, raw in bag.messages(_TOPICS)]


def _damage_and_read(path, file, sound, seed):
    _, content, _ = damaged_bags.damage(sound, np.random.default_rng(seed))
    file.write_bytes(content)
    try:
        return len(read_strictly(path))
    finally:
        file.write_bytes(sound)


def list_salvage_cases(folder, n_each):
    """Bags of three formats, damaged at random places: all that is whole, and nothing else."""
    cases = []
    for kind in damaged_bags.FORMATS:
        bag = damaged_bags.DamagedBag(Path(folder, "salvage"), kind)
        cases += [
            Case("salvage", f"{kind} seed {s}", partial(bag.try_salvage, s), _is_salvaged)
            for s in range(n_each)
        ]
    return cases


def _is_salvaged(outcome):
    return not (outcome.missed or outcome.invented or outcome.untold)


def list_survey_cases(folder):
    """Surveys with faults in their topics, stamps, frames, poses and clouds."""
    maker = bag_making.Maker()
    cases = []
    for name, change in {**_FIELDS, **_STAMPS, **_POSES}.items():
        entries = [change(maker, *entry) for entry in bag_making.survey(maker, n_scans=12)]
        path = maker.write(Path(folder, "surveys", f"s{len(cases)}"), entries)
        group = next(g for g, table in _GROUPS.items() if name in table)
        run = partial(read_survey, path)
        cases.append(Case(group, name, run, is_survey, may_pass=name not in _MUST_BE_REFUSED))
    return cases


def read_survey(path, **reading):
    """Read all that the first two stages read."""
    with open_survey([str(path)], Reading(min_range_m=0.1, max_range_m=100.0, **reading)) as survey:
        edges = survey.pose_edges()
        survey.motion_chains()
        stamps = survey.stamps()
        scans = list(survey.scans(range(len(stamps))))
    return edges, stamps, scans


def is_survey(found):
    _, stamps, scans = found
    return len(stamps) == len(scans) and all(np.isfinite(scan.xyz_m).all() for scan in scans)


def _cloud(**fields):
    def change(maker, topic, t_ns, message):
        if topic != "/points":
            return topic, t_ns, message
        return topic, t_ns, maker.cloud(t_ns, bag_making.room_points(), **fields)

    return change


def _points(make):
    def change(maker, topic, t_ns, message):
        if topic != "/points":
            return topic, t_ns, message
        return topic, t_ns, maker.cloud(t_ns, make(bag_making.room_points()))

    return change


def _stamp(topic_of, seconds):
    def change(maker, topic, t_ns, message):
        if topic == topic_of:
            shifted = int(t_ns + seconds * 1e9)
            message.header.stamp = maker.stamp(max(shifted, 0))
        return topic, t_ns, message

    return change


def _pose(**values):
    def change(maker, topic, t_ns, message):
        if topic == "/amcl_pose":
            pose = message.pose.pose
            for name, value in values.items():
                part = pose.orientation if name.startswith("q") else pose.position
                setattr(part, name.removeprefix("q"), value)
        return topic, t_ns, message

    return change


def _laser(**fields):
    def change(maker, topic, t_ns, message):
        if topic != "/points":
            return topic, t_ns, message
        return topic, t_ns, maker.laser(t_ns, np.full(360, 2.0), **fields)

    return change


_FIELDS = {
    "a billion wide": _cloud(width=10**9),
    "2^32-1 wide and high": _cloud(width=2**32 - 1, height=2**32 - 1),
    "step 0": _cloud(point_step=0),
    "step 1": _cloud(point_step=1),
    "no fields": _cloud(fields=[]),
    "big endian flag alone": _cloud(is_bigendian=True),
    "data cut": _cloud(data=np.zeros(5, np.uint8)),
    "no points": _points(lambda xyz_m: xyz_m[:0]),
    "one point": _points(lambda xyz_m: xyz_m[:1]),
    "all NaN": _points(lambda xyz_m: xyz_m * np.nan),
    "all infinite": _points(lambda xyz_m: xyz_m * np.inf),
    "1e30 m far": _points(lambda xyz_m: xyz_m * np.float32(1e30)),
    "at the origin": _points(lambda xyz_m: xyz_m * 0),
    "laser in degrees": _laser(angle_min=-180.0, angle_max=180.0, angle_increment=1.0),
    "laser of step NaN": _laser(angle_increment=np.nan),
    "laser of step 0": _laser(angle_increment=0.0),
    "laser of step 3": _laser(angle_increment=3.0),
    "laser of range NaN": _laser(range_min=np.nan),
    "laser back to front": _laser(range_min=30.0, range_max=0.1),
    "laser of time 1e9": _laser(time_increment=1e9),
}
_STAMPS = {
    "clouds without stamps": _stamp("/points", -1e18),
    "poses without stamps": _stamp("/amcl_pose", -1e18),
    "clouds an hour late": _stamp("/points", 3600),
    "poses an hour late": _stamp("/amcl_pose", 3600),
    "poses half a second ahead": _stamp("/amcl_pose", 0.5),
    "clouds five seconds behind": _stamp("/points", -5),
}
_POSES = {
    "poses NaN": _pose(x=np.nan),
    "poses infinite": _pose(y=np.inf),
    "poses 1e300 m away": _pose(x=1e300),
    "quaternions zero": _pose(qw=0.0),
    "quaternions of length two": _pose(qw=2.0),
    "quaternions NaN": _pose(qz=np.nan),
}
_GROUPS = {"odd clouds": _FIELDS, "odd stamps": _STAMPS, "odd poses": _POSES}
_MUST_BE_REFUSED = (
    "a billion wide",
    "2^32-1 wide and high",
    "step 0",
    "step 1",
    "no fields",
    "data cut",
    "laser in degrees",
    "laser of step NaN",
    "laser of step 0",
    "laser of step 3",
    "poses NaN",
    "poses infinite",
    "quaternions zero",
    "quaternions of length two",
    "quaternions NaN",
)


def list_bomb_cases(folder):
    """Chunks that state, or unpack to, more than any memory holds."""
    cases = []
    for kind in ("ros1_bz2", "ros1_lz4"):
        maker = bag_making.Maker(kind)
        path = maker.write(Path(folder, "bombs", kind), bag_making.survey(maker, n_scans=5))
        content = path.read_bytes()
        for size in (2**31, 2**32 - 1, 1, 0):
            place = content.index(b"size=") + 5
            bomb = path.with_name(f"{kind}_{size}.bag")
            bomb.write_bytes(content[:place] + struct.pack("<I", size) + content[place + 4 :])
            run = partial(read_strictly, bomb)
            cases.append(Case("compression bombs", f"{kind} of {size} B", run, may_pass=False))
    # two gigabytes of zeros in the place of a chunk
    packed = bz2.compress(bytes(10**8)) * 20
    maker = bag_making.Maker("ros1_bz2")
    content = maker.write(
        Path(folder, "bombs", "large"), bag_making.survey(maker, n_scans=60)
    ).read_bytes()
    begin, place = content.index(b"BZh"), content.index(b"size=") + 5
    assert len(packed) < struct.unpack_from("<I", content, begin - 4)[0]
    for size in (2 * 10**9, 5 * 10**8, 1000):
        bomb = Path(folder, "bombs", f"zeros_{size}.bag")
        stated = content[:place] + struct.pack("<I", size) + content[place + 4 : begin]
        bomb.write_bytes(stated + packed + content[begin + len(packed) :])
        run = partial(read_strictly, bomb)
        cases.append(Case("compression bombs", f"zeros as {size} B", run, may_pass=False))
    return cases


def list_scan_folder_cases(folder, n_each):
    """Folders of .pcd and .ply clouds with files that are cut or changed."""
    cases = []
    for suffix in ("pcd", "ply"):
        place = Path(folder, f"scans_{suffix}")
        _write_scan_folder(place, suffix)
        victims = (place / f"scans/002.{suffix}", place / "poses.tum")
        for victim in victims:
            sound = victim.read_bytes()
            for seed in range(n_each):
                run = partial(_damage_scan_folder, place, victim, sound, seed)
                name = f"{victim.name} seed {seed}"
                cases.append(Case("scan folders", name, run, is_survey))
    return cases


def _damage_scan_folder(place, victim, sound, seed):
    _, content, _ = damaged_bags.damage(sound, np.random.default_rng(seed))
    victim.write_bytes(content)
    try:
        files = [str(f) for f in sorted(place.rglob("*")) if f.is_file()]
        with open_survey(files, Reading(min_range_m=0.1, max_range_m=100.0)) as survey:
            stamps = survey.stamps()
            return survey.pose_edges(), stamps, list(survey.scans(range(len(stamps))))
    finally:
        victim.write_bytes(sound)


def _write_scan_folder(place, suffix):
    import open3d

    (place / "scans").mkdir(parents=True)
    lines = []
    for i in range(6):
        cloud = open3d.geometry.PointCloud()
        cloud.points = open3d.utility.Vector3dVector(bag_making.room_points(400).astype(float))
        open3d.io.write_point_cloud(str(place / f"scans/{i:03}.{suffix}"), cloud)
        lines.append(f"{1_700_000_000 + i}.5 {i / 10} 0 0 0 0 0 1\n")
    (place / "poses.tum").write_text("".join(lines))
