"""Segments that were extracted before are taken from there, if all they depend on is the same."""

import numpy as np
import pytest

from helpers import toy_rooms
from scanplan.extraction import known_segments
from scanplan.extraction.extractors import EXTRACTORS, make_wall_finder
from scanplan.store import schemas, tables

SETTINGS = {
    **toy_rooms.LIMITS,
    "reach_deg": 3.5,
    "max_tilt_deg": 15.0,
    "bandwidth_m": 0.3,
    "trials": 64,
}
SENSOR = np.array([2.0, 1.6, 0.9])
ROOM = toy_rooms.laser(SENSOR, seed=1)
KEYWORDS = {
    "recipe": b"a",
    "sensor_xyz_m": SENSOR,
    "finder": make_wall_finder(EXTRACTORS["cluster_ransac"], SETTINGS, planar=True),
}


def find(scan_id=3, xyz_m=ROOM, known=(), **other):
    return known_segments.find_unknown_segments(scan_id, xyz_m, known=known, **(KEYWORDS | other))


def test_known_segments_are_not_extracted():
    digest, segments = find()
    assert len(segments) >= 4
    assert find(known=[digest]) == (digest, None)


@pytest.mark.parametrize(
    "other",
    [
        {"scan_id": 4},
        {"xyz_m": ROOM + np.float32(1e-3)},
        {"recipe": b"b"},
        {"sensor_xyz_m": SENSOR + 1e-9},
    ],
)
def test_whatever_segments_depend_on_makes_them_unknown(other):
    digest, _ = find()
    changed, segments = find(known=[digest], **other)
    assert changed != digest and segments is not None


def test_the_recipe_is_told_by_extractor_settings_and_code():
    recipe = known_segments.digest_recipe("own", {"x": 1, "y": 2}, "code")
    assert recipe == known_segments.digest_recipe("own", {"y": 2, "x": 1}, "code")
    assert recipe != known_segments.digest_recipe("own", {"x": 1, "y": 3}, "code")
    assert recipe != known_segments.digest_recipe("other", {"x": 1, "y": 2}, "code")
    assert recipe != known_segments.digest_recipe("own", {"x": 1, "y": 2}, "edited")


def test_a_table_of_new_and_known_segments_is_that_of_all_new_ones(tmp_path):
    ids = np.array([2, 5, 9])
    scans = [ROOM, np.empty((0, 3), np.float32), ROOM + np.float32(0.5)]
    nothing = known_segments.KnownSegments([tmp_path / "missing.parquet"])
    found = [find(i, xyz_m) for i, xyz_m in zip(ids.tolist(), scans, strict=True)]
    columns = nothing.complete(ids, found)
    notes = known_segments.note_digests(ids[:2], found[:2])
    earlier = {name: values[columns["scan_id"] < 9] for name, values in columns.items()}
    tables.write_table(tmp_path / "walls.parquet", schemas.WALLS, earlier, notes=notes)
    known = known_segments.KnownSegments([tmp_path / "walls.parquet"])
    assert [len(known.list_digests(i)) for i in ids.tolist()] == [1, 1, 0]
    again = [
        find(i, xyz_m, known=known.list_digests(i))
        for i, xyz_m in zip(ids.tolist(), scans, strict=True)
    ]
    assert [segments is None for _, segments in again] == [True, True, False]
    completed = known.complete(ids, again)
    assert set(completed) == set(columns)
    for name, values in columns.items():
        np.testing.assert_array_equal(completed[name], values)


def test_a_damaged_table_tells_nothing(tmp_path):
    path = tmp_path / "walls.parquet"
    path.write_bytes(b"PAR1 no more")
    assert known_segments.KnownSegments([path]).list_digests(3) == []
