"""Files of every kind but bags, cut, changed at random places, and hostile: each ends in a line.

A room of 4 m by 3 m is written as each kind by the library or program that writes such files.
"""

import struct
from functools import cache, partial
from pathlib import Path

import numpy as np
from PIL import Image

from faults import damaged_bags
from faults.judging import Case
from faults.recording_cases import is_survey
from helpers import cloud_files, e57_making, las_making, ptx_making
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey

GROUP, HOSTILE = "damaged files", "hostile files"
_STEP_M = 0.04
_SEEN_M = np.array([(1.0, 1.0, 1.2), (3.0, 2.0, 1.2)])
_YAML = (
    "image: a.pgm\nmode: trinary\nresolution: 0.05\norigin: [-0.5, -0.5, 0]\n"
    "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
)
_N_READ = 20  # scans
_LONG = 40_000_000  # bytes of one line: ten times that as words


def list_file_cases(folder, n_each):
    """Return a case for each kind, file and seed."""
    cases = []
    for kind, write in KINDS.items():
        place = Path(folder, f"files_{len(cases)}")
        place.mkdir(parents=True)
        write(place)
        for victim in sorted(file for file in place.rglob("*") if file.is_file()):
            sound = victim.read_bytes()
            for seed in range(n_each):
                change = partial(_damage, (seed, len(cases)))
                run = partial(_change_and_read, place, victim, sound, change)
                cases.append(Case(GROUP, f"{kind} {victim.name} seed {seed}", run, is_survey))
    return cases


def list_hostile_cases(folder):
    """Return a case for each hostile file: refused, but where its name says `harmless`."""
    cases = []
    for number, (kind, file, name, change) in enumerate(_HOSTILE):
        place = Path(folder, f"hostile_{number}")
        place.mkdir(parents=True)
        KINDS[kind](place)
        victim = place / file
        run = partial(_change_and_read, place, victim, victim.read_bytes(), change)
        may_pass = name.startswith("harmless")
        cases.append(Case(HOSTILE, f"{kind}: {name}", run, is_survey, may_pass=may_pass))
    return cases


def _damage(seed, sound):
    return damaged_bags.damage(sound, np.random.default_rng(seed))[1]


def _change_and_read(place, victim, sound, change):
    victim.write_bytes(change(sound))
    try:
        return _read(place)
    finally:
        victim.write_bytes(sound)


def _read(place):
    """Read all that the first two stages read."""
    files = dataset_files.find_files(place)
    with open_survey(files, Reading(min_range_m=0.1, max_range_m=100.0)) as survey:
        edges, stamps = survey.pose_edges(), survey.stamps()
        survey.motion_chains()
        frame_edges.chain_poses(edges, stamps, max_gap_s=2.0)
        return edges, stamps[:_N_READ], list(survey.scans(range(min(len(stamps), _N_READ))))


@cache
def _room():
    """Return points (n, 3) of floor, ceiling and walls."""
    axes = [np.arange(0, size + _STEP_M / 2, _STEP_M) for size in (4, 3, 2.4)]
    sides = []
    for level in range(3):
        for side in (axes[level][0], axes[level][-1]):
            spans = [np.array([side]) if i == level else axis for i, axis in enumerate(axes)]
            grid = np.stack(np.meshgrid(*spans, indexing="ij"), axis=-1)
            sides.append(grid.reshape(-1, 3))
    return np.concatenate(sides)


def _write_las_drive(suffix, place):
    points = _room()[::5]
    time_s = np.linspace(0, 2, len(points))
    las_making.write_las(place / f"a{suffix}", points, time_s)
    at_s = np.linspace(-0.1, 2.1, 23)
    way = np.linspace(_SEEN_M[0], _SEEN_M[1], 23)
    name = "trajectory.txt" if suffix == ".las" else "trajectory.csv"
    head = "" if suffix == ".las" else "time,x,y,z"
    las_making.write_trajectory(place / name, at_s, way, head=head, comma=suffix == ".laz")


def _write_stations(write, name, place):
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[:, :3, 3] = _SEEN_M
    clouds = [se3.transform_points(se3.invert_pose(pose), _room()) for pose in poses]
    write(place / name, poses, [cloud[::7] for cloud in clouds])


def _write_grid_map(suffix, place):
    cells = np.full((80, 100), 205, np.uint8)
    cells[9:71, 9:91] = 0
    cells[10:70, 10:90] = 254
    Image.fromarray(cells).save(place / f"a{suffix}")
    (place / "a.yaml").write_text(_YAML.replace("a.pgm", f"a{suffix}"))


KINDS = {
    "las and trajectory": partial(_write_las_drive, ".las"),
    "laz and trajectory": partial(_write_las_drive, ".laz"),
    "e57 stations": partial(_write_stations, e57_making.write_e57, "a.e57"),
    "ptx stations": partial(_write_stations, ptx_making.write_ptx, "a.ptx"),
    "grid map": partial(_write_grid_map, ".pgm"),
    "grid map as png": partial(_write_grid_map, ".png"),
    "merged las": lambda place: las_making.write_las(
        place / "a.las", _room(), np.zeros(len(_room()))
    ),
    "merged laz": lambda place: las_making.write_las(
        place / "a.laz", _room(), np.zeros(len(_room()))
    ),
    "merged ply": lambda place: cloud_files.write_binary_ply(place / "a.ply", _room()),
    "merged ply of text": lambda place: cloud_files.write_ply(place / "a.ply", _room()),
    "merged pcd": lambda place: cloud_files.write_pcd(place / "a.pcd", _room()),
    "merged e57": lambda place: e57_making.write_e57(place / "a.e57", [np.eye(4)], [_room()]),
}
"""How each kind is written to a folder."""


def _put(offset, form, *values):
    """Return what writes values at a place of a file."""

    def change(sound):
        packed = struct.pack(form, *values)
        return sound[:offset] + packed + sound[offset + len(packed) :]

    return change


def _swap(old, new):
    def change(sound):
        assert old in sound
        return sound.replace(old, new, 1)

    return change


def _swap_line(number, new):
    """Return what puts another line in the place of one."""

    def change(sound):
        lines = sound.split(b"\n")
        lines[number] = new
        return b"\n".join(lines)

    return change


def _say(text):
    return lambda sound: text


def _describe(old, new):
    """Return what changes the description of an E57."""

    def change(sound):
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.e57")
            path.write_bytes(sound)
            e57_making.change_xml(path, lambda text: _replaced(text, old, new))
            return path.read_bytes()

    return change


def _replaced(text, old, new):
    assert old in text
    return text.replace(old, new, 1)


def _png_of(width, height):
    """Return what makes an image so large of a few bytes: one shade."""

    def change(_):
        import io

        file = io.BytesIO()
        Image.new("L", (width, height), 254).save(file, "PNG")
        return file.getvalue()

    return change


_LAUGHS = (
    '<!DOCTYPE e57Root [<!ENTITY a "ha">'
    + "".join(
        f'<!ENTITY {new} "{f"&{old};" * 20}">'
        for old, new in zip("abcdefgh", "bcdefghi", strict=True)
    )
    + "]>"
)
_NAN, _INF = np.nan, np.inf
_NO_LAS_PLACE = 155  # bytes before three offsets; scales stand before them
_HOSTILE = [
    (
        "las and trajectory",
        "a.las",
        "offsets of no number",
        _put(_NO_LAS_PLACE, "<3d", *[_NAN] * 3),
    ),
    ("las and trajectory", "a.las", "scales of no number", _put(131, "<3d", *[_NAN] * 3)),
    ("las and trajectory", "a.las", "infinite scales", _put(131, "<3d", *[_INF] * 3)),
    ("las and trajectory", "a.las", "scales of 1e300", _put(131, "<3d", *[1e300] * 3)),
    ("las and trajectory", "a.las", "four milliard extended records", _put(243, "<I", 2**32 - 1)),
    ("laz and trajectory", "a.laz", "four milliard extended records", _put(243, "<I", 2**32 - 1)),
    ("las and trajectory", "a.las", "18 trillion points", _put(247, "<Q", 2**64 - 1)),
    ("laz and trajectory", "a.laz", "18 trillion points", _put(247, "<Q", 2**64 - 1)),
    ("las and trajectory", "a.las", "points of 65,535 bytes", _put(105, "<H", 65535)),
    ("las and trajectory", "a.las", "points of no bytes", _put(105, "<H", 0)),
    ("las and trajectory", "trajectory.txt", "of no number", _say(b"nan nan nan nan\n" * 9)),
    ("las and trajectory", "trajectory.txt", "times of 1e300", _say(b"1e300 0 0 0\n2e300 0 0 0\n")),
    ("las and trajectory", "trajectory.txt", "1e300 m away", _say(b"0 1e300 0 0\n2 1e300 0 0\n")),
    ("las and trajectory", "trajectory.txt", "one line of 40 MB", _say(b"1 " * (_LONG // 2))),
    ("las and trajectory", "trajectory.txt", "one word of 40 MB", _say(b"1" * _LONG)),
    ("las and trajectory", "trajectory.txt", "of one time in 2 MB", _say(b"1 1 1 1\n" * 250_000)),
    ("las and trajectory", "trajectory.txt", "zeros", _say(bytes(10**6))),
    ("laz and trajectory", "trajectory.csv", "of two names", _say(b"time,x\n0,1\n1,1\n")),
    (
        "e57 stations",
        "a.e57",
        "a wrong checksum",
        lambda sound: sound[:1500] + b"\x55" + sound[1501:],
    ),
    ("e57 stations", "a.e57", "entities that grow", _describe("<e57Root", _LAUGHS + "<e57Root")),
    (
        "e57 stations",
        "a.e57",
        "a milliard points",
        _describe('recordCount="', 'recordCount="1000000'),
    ),
    (
        "e57 stations",
        "a.e57",
        "a pose of no number",
        _describe("<translation", "<translation><x>NaN</x></translation><translation"),
    ),
    (
        "e57 stations",
        "a.e57",
        "nested 50,000 deep",
        _describe("<data3D", "<a>" * 50_000 + "</a>" * 50_000 + "<data3D"),
    ),
    ("e57 stations", "a.e57", "a description of 2^63 bytes", _put(32, "<Q", 2**63)),
    ("e57 stations", "a.e57", "a description at 2^63", _put(24, "<Q", 2**63)),
    ("ptx stations", "a.ptx", "a milliard columns", _swap_line(0, b"1000000000")),
    ("ptx stations", "a.ptx", "1e300 columns", _swap_line(0, b"1e300")),
    ("ptx stations", "a.ptx", "columns of no number", _swap_line(0, b"nan")),
    ("ptx stations", "a.ptx", "less than no columns", _swap_line(0, b"-5")),
    ("ptx stations", "a.ptx", "a pose of no number", _swap_line(9, b"nan nan nan 1")),
    ("ptx stations", "a.ptx", "infinitely far away", _swap_line(9, b"inf 0 0 1")),
    ("ptx stations", "a.ptx", "one line of 40 MB", _swap_line(12, b"1 " * (_LONG // 2))),
    ("ptx stations", "a.ptx", "no end of a line in 40 MB", _say(b"1" * _LONG)),
    ("grid map", "a.yaml", "an origin of no number", _swap(b"[-0.5, -0.5, 0]", b"[.nan, 0, 0]")),
    ("grid map", "a.yaml", "an origin infinitely far", _swap(b"[-0.5, -0.5, 0]", b"[.inf, 0, 0]")),
    ("grid map", "a.yaml", "an origin at 1e300", _swap(b"[-0.5, -0.5, 0]", b"[1.0e+300, 0, 0]")),
    ("grid map", "a.yaml", "negated infinitely", _swap(b"negate: 0", b"negate: .inf")),
    ("grid map", "a.yaml", "a resolution of 400 digits", _swap(b"0.05", b"9" * 400)),
    (
        "grid map",
        "a.yaml",
        "a resolution of no number",
        _swap(b"resolution: 0.05", b"resolution: .nan"),
    ),
    (
        "grid map",
        "a.yaml",
        "free below no number",
        _swap(b"free_thresh: 0.25", b"free_thresh: .nan"),
    ),
    ("grid map", "a.yaml", "no image but the folder", _swap(b"a.pgm", b".")),
    (
        "grid map",
        "a.yaml",
        "aliases that grow",
        _say(
            b"a: &a [1,1]\n"
            + b"".join(
                b"%c: &%c [%s]\n" % (new, new, b",".join([b"*%c" % old] * 20))
                for old, new in zip(b"abcdefgh", b"bcdefghi", strict=True)
            )
            + _YAML.encode()
        ),
    ),
    ("grid map", "a.pgm", "a milliard cells", _swap(b"100 80", b"40000 40000")),
    ("grid map", "a.pgm", "no cells", _swap(b"100 80", b"0 0")),
    ("grid map as png", "a.png", "harmless: 16 million free cells", _png_of(4000, 4000)),
    ("grid map as png", "a.png", "196 million cells of few bytes", _png_of(14_000, 14_000)),
    ("merged las", "a.las", "scales of no number", _put(131, "<3d", *[_NAN] * 3)),
    ("merged laz", "a.laz", "18 trillion points", _put(247, "<Q", 2**64 - 1)),
    (
        "merged ply",
        "a.ply",
        "18 trillion points",
        _swap(b"element vertex ", b"element vertex 999999999999"),
    ),
    ("merged ply", "a.ply", "a header without end", _swap(b"end_header\n", b"comment" * 10**6)),
    ("merged ply of text", "a.ply", "one line of 40 MB", _swap_line(9, b"1 " * (_LONG // 2))),
    ("merged pcd", "a.pcd", "18 trillion points", _swap(b"\nPOINTS ", b"\nPOINTS 999999999999")),
    (
        "merged pcd",
        "a.pcd",
        "fields of a milliard numbers",
        _swap(b"COUNT 1 1 1", b"COUNT 1 1 1000000000"),
    ),
    ("merged pcd", "a.pcd", "fields of less than none", _swap(b"COUNT 1 1 1", b"COUNT 1 1 -1")),
    (
        "merged e57",
        "a.e57",
        "a milliard points",
        _describe('recordCount="', 'recordCount="1000000'),
    ),
]
"""Kind, file, what is done to it, and the change of its bytes."""
