"""Results and recordings that are not what they seem, read as the first stages and the rules do.

Tables of another dataset, notes that are no text, odd dates, names and headers.
"""

import os
import struct
import time
from functools import partial
from pathlib import Path

import numpy as np

from faults import table_flips
from faults.judging import Case
from helpers import bag_making
from scanplan.errors import StageError
from scanplan.project import dataset_files, provenance
from scanplan.project.run import run_places
from scanplan.recordings import messages
from scanplan.recordings.survey import Reading, open_survey
from scanplan.store import schemas, tables

HERE, THERE = "a" * 64, "b" * 64
_HEAD = {
    "VERSION": "0.7",
    "FIELDS": "x y z",
    "SIZE": "4 4 4",
    "TYPE": "F F F",
    "COUNT": "1 1 1",
    "WIDTH": "20",
    "HEIGHT": "1",
    "VIEWPOINT": "0 0 0 1 0 0 0",
    "POINTS": "20",
    "DATA": "binary",
}
_POINTS = bag_making.room_points(20).tobytes()


def list_foreign_cases(folder):
    """All of them."""
    return [
        *_list_tables(Path(folder, "foreign")),
        *_list_clouds(Path(folder, "stating")),
        *_list_lasers(),
        *_list_names(Path(folder, "names")),
        *_list_notes(Path(folder, "notes")),
        *_list_dates(Path(folder, "dates")),
    ]


def _list_tables(folder):
    """A table of every schema, of another dataset, of ours, and of older versions' results."""
    rng = np.random.default_rng(1)
    poses = {name: np.zeros(1) for name in schemas.POSES.columns} | {"covered": np.ones(1, bool)}
    cases = []
    for made_of in (HERE, THERE, ""):
        place = folder / (made_of[:1] or "old")
        tables.write_table(place / "poses.parquet", schemas.POSES, poses, made_of=made_of)
        for path, schema in table_flips.write_tables(place / "plan", rng):
            name = f"{schema.name} made of {made_of[:1] or 'nothing stated'}"
            target = Path("results/d/plan", path.name)
            run = partial(_read_among, folder / "a/poses.parquet", path, target, schema)
            may_pass = made_of != THERE or schema.outlives
            cases.append(Case("tables of others", name, run, may_pass=may_pass))
    return cases


def _read_among(poses, path, target, schema):
    place = path.parents[2] / target
    place.parent.mkdir(parents=True, exist_ok=True)
    place.parents[1].joinpath("poses.parquet").write_bytes(poses.read_bytes())
    place.write_bytes(path.read_bytes())
    return table_flips.read_all(place, schema)


def _list_clouds(folder):
    packed = _lzf(_POINTS)
    compressed = {"DATA": "binary_compressed"}
    of_bytes = struct.pack("<II", len(packed), len(_POINTS)) + packed
    cases = {
        "sound": ({}, _POINTS, True),
        "sound, compressed": (compressed, of_bytes, True),
        "sound, in text": ({"DATA": "ascii"}, b"1 2 3\n" * 20, True),
        "sound, with a long comment": ({"VERSION": f"0.7\n# {'ü' * 9000}"}, _POINTS, True),
        "bomb of 1.8 GB": (compressed | _points(150_000_000), _sizes(20, 1_800_000_000), False),
        "bomb of 4 GB, few points": (compressed, _sizes(20, 2**32 - 1), False),
        "packed 4 GB": (compressed, _sizes(2**32 - 1, 240), False),
        "unpacks to nothing": (compressed, _sizes(0, 0), False),
        "unpacks to less": (compressed, _sizes(len(packed), 239) + packed, False),
        "packed noise": (compressed, _sizes(200, 240) + bytes(range(200)), False),
        "no sizes": (compressed, b"\1", False),
        "10^18 points": (_points(10**18), _POINTS, False),
        "10^18 points in text": (_points(10**18) | {"DATA": "ascii"}, b"1 2 3\n" * 20, False),
        "10^8 points in text": (_points(10**8) | {"DATA": "ascii"}, b"1 2 3\n" * 20, False),
        "minus 20 points": (_points(-20), _POINTS, False),
        "points in words": (_points("many"), _POINTS, False),
        "points of a gigabyte": ({"COUNT": "1 1 300000000"}, _POINTS, False),
        "points of minus a gigabyte": ({"COUNT": "1 1 -300000000"}, _POINTS, False),
        "sizes in words": ({"SIZE": "four 4 4"}, _POINTS, False),
        "too few sizes": ({"SIZE": "4 4"}, _POINTS, False),
        "points by width and height": ({"POINTS": None}, _POINTS, True),
        "no data stated": ({"DATA": None}, _POINTS, False),
        "data of an unknown form": ({"DATA": "quantum"}, _POINTS, False),
        "no fields": ({"FIELDS": "", "SIZE": "", "TYPE": "", "COUNT": ""}, b"", False),
        "a header of a megabyte": ({"VERSION": "0" * 10**6}, _POINTS, False),
        "a version in UTF-16": ({"VERSION": "0.7".encode("utf-16").decode("latin")}, _POINTS, True),
    }
    return [
        Case(
            "clouds that state too much",
            name,
            partial(_read_cloud, folder / str(number), changes, body),
            may_pass=may_pass,
        )
        for number, (name, (changes, body, may_pass)) in enumerate(cases.items())
    ]


def _points(number):
    return {"POINTS": str(number), "WIDTH": str(number)}


def _sizes(packed, unpacked):
    return struct.pack("<II", packed, unpacked)


def _lzf(content):
    """Return bytes packed as runs of literals, up to 32 a run, which LZF allows."""
    parts = [content[i : i + 32] for i in range(0, len(content), 32)]
    return b"".join(bytes([len(part) - 1]) + part for part in parts)


def _read_cloud(folder, changes, body):
    (folder / "scans").mkdir(parents=True)
    head = {key: value for key, value in (_HEAD | changes).items() if value is not None}
    text = "".join(f"{key} {value}\n" for key, value in head.items())
    path = folder / "scans/1700000000.5.pcd"
    path.write_bytes(text.encode("latin") + body)
    (folder / "poses.tum").write_text("1700000000.0 0 0 0 0 0 0 1\n1700000001.0 0 0 0 0 0 0 1\n")
    files = [str(folder / "poses.tum"), str(path)]
    with open_survey(files, Reading(min_range_m=0.1, max_range_m=100.0)) as survey:
        return [scan.xyz_m for scan in survey.scans([0])]


def _list_lasers():
    turn = 2 * np.pi
    cases = {
        "sound": ({}, True),
        "a beam more": ({"angle_max": turn * 361 / 360}, True),
        "no last angle": ({"angle_max": 0.0}, True),
        "the last is the first": ({"angle_min": 1.0, "angle_max": 1.0}, True),
        "step of 1e-30": ({"angle_increment": 1e-30}, False),
        "step of half": ({"angle_increment": turn / 720}, False),
        "step of minus": ({"angle_increment": -turn / 360}, False),
        "last angle in degrees": ({"angle_max": 360.0}, False),
        "last angle of half a turn": ({"angle_max": np.pi}, False),
        "last angle of NaN": ({"angle_max": np.nan}, True),
        "last angle of infinity": ({"angle_max": np.inf}, True),
    }
    return [
        Case(
            "lasers that contradict themselves",
            name,
            partial(
                messages.read_laser_scan,
                bag_making.laser_scan(
                    np.full(360, 2.0), **{"angle_increment": turn / 360} | fields
                ),
            ),
            lambda found: np.isfinite(found[0]).all(),
            may_pass=may_pass,
        )
        for name, (fields, may_pass) in cases.items()
    ]


def _list_names(folder):
    refused = ("{x}", "}", "{{", "a{b", "x\udcff", "\udcc3(", "<a>", "{x:.1f}")
    read = ("a b", "ü", "'", "$x", "a;b", "a\nb", "%s", "*", "[0]", "~", "a\\b", "\u202ea", "-x")
    cases = []
    for number, name in enumerate((*refused, *read)):
        place = folder / str(number)
        place.mkdir(parents=True)
        (place / f"{name}.bag").write_bytes(b"x")
        run = partial(_find_and_show, place)
        cases.append(Case("odd names of recordings", repr(name), run, may_pass=name in read))
    return cases


def _find_and_show(place):
    try:
        return dataset_files.find_files(place)
    except StageError as error:
        # what cannot be shown is no line
        str(error).encode()
        raise


def _list_notes(folder):
    notes = {
        "bytes": (b"\xff\xfe\x00", False),
        "UTF-16": ("a/x\n".encode("utf-16"), False),
        "empty": (b"", True),
        "another dataset": (b"b/x\n", False),
        "ours beneath others": (b"b/x\na/x\n", True),
        "a megabyte": (b"b/x\n" * 250_000, False),
        "NUL": (b"a/x\0\n", False),
        "a sentence without end": (b"a/x", True),
    }
    return [
        Case(
            "notes of sources",
            name,
            partial(_check_note, folder / str(number), content),
            may_pass=may_pass,
        )
        for number, (name, (content, may_pass)) in enumerate(notes.items())
    ]


def _check_note(folder, content):
    (folder / "results/x").mkdir(parents=True)
    (folder / "results/x/poses.parquet").touch()
    (folder / "results/x/source.txt").write_bytes(content)
    return _in_folder(folder, lambda: provenance.check_sources({"x": "a/x"}))


def _list_dates(folder):
    day_s = 86_400
    dates = {
        "now": (0, True),
        "half a minute ahead": (30, True),
        "an hour ahead": (3600, False),
        "in 2099": (70 * 365 * day_s, False),
        "in the year 10,000": (8000 * 365 * day_s, False),
        "in 1970": (-time.time(), True),
        "before 1970": (-time.time() - 10 * day_s, True),
    }
    return [
        Case(
            "dates of files",
            f"{file} {name}",
            partial(_check_date, folder / f"{number}{len(file)}", file, ahead_s),
            may_pass=may_pass,
        )
        for number, (name, (ahead_s, may_pass)) in enumerate(dates.items())
        for file in ("results/d/scans.parquet", "d/run.bag")
    ]


def _check_date(folder, file, ahead_s):
    path = folder / file
    path.parent.mkdir(parents=True)
    path.touch()
    dated_s = time.time() + ahead_s
    os.utime(path, (dated_s, dated_s))
    return _in_folder(folder, lambda: run_places.check_dates(["d"], ["d/run.bag"]))


def _in_folder(folder, call):
    before = Path.cwd()
    os.chdir(folder)
    try:
        return call()
    finally:
        os.chdir(before)
