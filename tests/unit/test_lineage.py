"""Tables of a dataset state what recordings they were made of, and others are refused."""

import shutil

import numpy as np
import pytest

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.store import lineage, schemas, tables

HERE, THERE = "a" * 64, "b" * 64
POSES = {name: np.zeros(1) for name in schemas.POSES.columns} | {"covered": np.ones(1, bool)}


def write_dataset(folder, made_of):
    """Poses, which state what they were made of, and two tables that take it from there."""
    tables.write_table(folder / "poses.parquet", schemas.POSES, POSES, made_of=made_of)
    for place in ("edges.parquet", "plan/corrected/edges.parquet"):
        write_edges(folder / place)
    with tables.open_scan_writer(folder / "scans.parquet", planar=True) as write:
        write(0, np.ones((2, 3)))
    return folder


def write_edges(path):
    columns = {name: [] for name in schemas.EDGES.columns}
    tables.write_table(path, schemas.EDGES, columns, allow_empty=True)


@pytest.mark.parametrize(
    "place", ["edges.parquet", "plan/corrected/edges.parquet", "scans.parquet"]
)
def test_a_table_of_another_dataset_is_refused(tmp_path, place):
    here, there = (write_dataset(tmp_path / made_of[0], made_of) for made_of in (HERE, THERE))
    read(here / place)
    shutil.copy(there / place, here / place)
    with pytest.raises(StageError, match=f"{place}: was made of other .*poses.parquet .digest bbb"):
        read(here / place)


def read(path):
    if path.name == "scans.parquet":
        return tables.ScanStore(path)
    return tables.read_table(path, schemas.EDGES, allow_empty=True)


def test_tables_that_state_nothing_are_read(tmp_path):
    folder = write_dataset(tmp_path, "")
    assert lineage.read_made_of(folder / "edges.parquet") == ""
    other = write_dataset(tmp_path / "other", THERE)
    for one, another in ((folder, other), (other, folder)):
        shutil.copy(one / "edges.parquet", another / "plan/edges.parquet")
        read(another / "plan/edges.parquet")


def test_what_outlives_a_recording_states_none(tmp_path):
    folder = write_dataset(tmp_path, HERE)
    known = {name: np.array([], object) for name in schemas.KNOWN_ELEMENTS.columns}
    path = folder / "known_elements.parquet"
    tables.write_table(path, schemas.KNOWN_ELEMENTS, known, allow_empty=True)
    assert lineage.read_made_of(path) == ""
    write_dataset(folder, THERE)
    tables.read_table(path, schemas.KNOWN_ELEMENTS, allow_empty=True)


def test_recordings_that_have_changed_since_the_poses_were_made_are_refused(tmp_path):
    poses = write_dataset(tmp_path, HERE) / "poses.parquet"
    lineage.check_recordings(poses, HERE)
    lineage.check_recordings(poses, "")
    with refused(file="poses.parquet", remedy="delete"):
        lineage.check_recordings(poses, THERE)


def test_a_damaged_table_of_poses_keeps_none_from_being_read(tmp_path):
    folder = write_dataset(tmp_path, HERE)
    (folder / "poses.parquet").write_bytes(b"PAR1 no more")
    read(folder / "edges.parquet")
