"""Tables are whole, checked, and refused when damaged."""

import contextlib
import operator
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from scanplan.errors import StageError
from scanplan.store import schemas, tables

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
ROWS = {
    "rank": [1, 2, 3],
    "scan_id": [7, 3, 5],
    "n_points": [900, 800, 700],
    "gain_m2": [4.0, 2.0, 0.0],
    "covered_m2": [4.0, 6.0, 6.0],
    "bound_m2": [4.0, 6.0, 6.0],
    "gain": [3.0, 1.0, 0.5],
    "covered": [3.0, 4.0, 4.5],
    "bound": [3.0, 4.0, 4.5],
}


@pytest.fixture
def selection(tmp_path):
    path = tmp_path / "deep" / "selection.parquet"
    tables.write_table(path, schemas.SELECTION, ROWS)
    return path


@pytest.fixture
def scans(tmp_path):
    path = tmp_path / "scans.parquet"
    with tables.open_scan_writer(path, planar=True) as write:
        write(3, np.arange(6.0).reshape(2, 3))
        write(9, np.ones((1, 3)))
    return path


def test_what_is_written_is_read(selection):
    rows = tables.read_table(selection, schemas.SELECTION)
    assert {name: rows[name].tolist() for name in rows} == ROWS
    assert rows["scan_id"].dtype == np.int32
    assert list(tables.read_table(selection, schemas.SELECTION, ["gain_m2"])) == ["gain_m2"]


def test_the_same_rows_give_the_same_bytes(selection, tmp_path):
    tables.write_table(tmp_path / "again.parquet", schemas.SELECTION, ROWS)
    assert (tmp_path / "again.parquet").read_bytes() == selection.read_bytes()


def test_scans_are_read_one_by_one(scans):
    store = tables.ScanStore(scans)
    assert store.scan_ids.tolist() == [3, 9] and store.planar
    np.testing.assert_array_equal(store.read(9), [[1, 1, 1]])
    assert [scan_id for scan_id, _ in store.scans([9, 3])] == [9, 3]
    assert store.read(3).dtype == np.float32
    with pytest.raises(StageError, match=r"scans\.parquet: .*\b4\b"):
        store.read(4)


def write_anew(path, keep, lost=None):
    """Write a file as another program would that takes rows out: whole by itself."""
    with pq.ParquetFile(path) as file:
        groups = [file.read_row_group(i) for i in range(file.num_row_groups)]
    kept = {k: v for k, v in groups[0].schema.metadata.items() if k != lost}
    groups = [group.replace_schema_metadata(kept) for group in groups]
    form = groups[0].schema
    with pq.ParquetWriter(path, form, write_page_checksum=True) as writer:
        for group in keep(groups):
            writer.write_table(group)


@pytest.mark.parametrize(
    ("keep", "n_left"),
    [(lambda g: g[1:], 1), (lambda g: [g[0].slice(1), g[1]], 2), (lambda g: [*g, g[0]], 5)],
)
def test_rows_that_another_program_took_out_or_added_are_missed(scans, keep, n_left):
    write_anew(scans, keep)
    with pytest.raises(StageError, match=rf"scans\.parquet: .*\b3 rows.*\b{n_left}\b"):
        tables.ScanStore(scans)


def test_a_program_that_loses_their_number_is_noticed_too(scans):
    write_anew(scans, lambda groups: groups, b"scanplan_rows")
    with pytest.raises(StageError, match=r"scans\.parquet: .*\b3\b"):
        tables.ScanStore(scans)


def test_a_store_without_scans_does_not_appear(tmp_path):
    with (
        pytest.raises(StageError, match=r"s\.parquet: .*kept"),
        tables.open_scan_writer(tmp_path / "s.parquet", planar=False),
    ):
        pass
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_write_leaves_nothing(tmp_path):
    with (
        pytest.raises(KeyboardInterrupt),
        tables.open_scan_writer(tmp_path / "s.parquet", planar=False) as write,
    ):
        write(0, np.zeros((1, 3)))
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("spoil", ["drop", "add", "unsort"])
def test_columns_and_order_are_checked_on_write(tmp_path, spoil):
    rows = dict(ROWS)
    if spoil == "drop":
        del rows["bound_m2"]
    elif spoil == "add":
        rows["extra"] = [1, 2, 3]
    else:
        rows["rank"] = [2, 1, 3]
    with pytest.raises(ValueError, match="selection"):
        tables.write_table(tmp_path / "s.parquet", schemas.SELECTION, rows)
    assert list(tmp_path.iterdir()) == []


def test_no_rows_only_where_allowed(tmp_path):
    empty = {name: [] for name in ROWS}
    with pytest.raises(StageError, match="no rows"):
        tables.write_table(tmp_path / "s.parquet", schemas.SELECTION, empty)
    tables.write_table(tmp_path / "s.parquet", schemas.SELECTION, empty, allow_empty=True)
    assert (
        tables.read_table(tmp_path / "s.parquet", schemas.SELECTION, allow_empty=True)["rank"].size
        == 0
    )


def test_a_flipped_bit_is_noticed(tmp_path):
    path = tmp_path / "scans.parquet"
    with tables.open_scan_writer(path, planar=False) as write:
        write(0, np.random.default_rng(0).normal(size=(5000, 3)))
    whole = path.read_bytes()
    for position in range(2000, 50000, 9601):
        path.write_bytes(whole[:position] + bytes([whole[position] ^ 1]) + whole[position + 1 :])
        with pytest.raises(StageError, match="damaged"):
            list(tables.ScanStore(path).scans())


def test_a_table_that_memory_does_not_hold_is_not_called_damaged(tmp_path):
    path = tmp_path / "scans.parquet"
    with tables.open_scan_writer(path, planar=False) as write:
        write(0, np.random.default_rng(0).normal(size=(2_000_000, 3)))
    # a process of its own that may take 20 MB more than it has: the points take 24
    code = (
        "import resource, sys\n"
        "from scanplan.errors import StageError\n"
        "from scanplan.store import tables\n"
        "store = tables.ScanStore(sys.argv[1])\n"
        "held = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (held + 20_000_000,) * 2)\n"
        "try:\n    list(store.scans())\n"
        "except StageError as error:\n    print(error)\n"
    )
    said = subprocess.run(
        [sys.executable, "-c", code, path],
        env={"PYTHONPATH": str(SCRIPTS)},
        capture_output=True,
        text=True,
    ).stdout
    assert said.startswith(f"{path}: ") and "memory" in said
    assert said.count("\n") == 1 and "`ulimit -v`" in said


@pytest.mark.parametrize("size", [0, 3, 200])
def test_a_truncated_file_is_refused(selection, size):
    selection.write_bytes(selection.read_bytes()[:size])
    with pytest.raises(StageError, match="damaged"):
        tables.read_table(selection, schemas.SELECTION)


def test_another_table_or_no_table_is_refused(selection, tmp_path):
    with pytest.raises(StageError, match="expected poses"):
        tables.read_table(selection, schemas.POSES)
    with pytest.raises(StageError, match=r"none\.parquet: "):
        tables.read_table(tmp_path / "none.parquet", schemas.POSES)


def test_hulls_say_that_they_are_local_metres(tmp_path):
    import json

    import pyarrow.parquet as pq

    row = {"scan_id": [0], "cluster": [0], "n_points": [3], "area_m2": [0.5], "geometry": [b"\x01"]}
    tables.write_table(tmp_path / "h.parquet", schemas.HULLS, row)
    geo = json.loads(pq.read_metadata(tmp_path / "h.parquet").metadata[b"geo"])
    assert geo["columns"]["geometry"]["crs"] is None


def rows_by_parts(path):
    with pq.ParquetFile(path) as file:
        whole = file.metadata
        return whole.num_rows, [whole.row_group(i).num_rows for i in range(whole.num_row_groups)]


def misstate_rows_of_a_part(path):
    """Flip the bit of the footer that has the first part state one row less or more."""
    content = path.read_bytes()
    before = rows_by_parts(path)
    number = 2 * before[1][0]  # as Thrift writes it: the sign in the last bit
    for place in range(len(content)):
        if content[place] == number:
            spoilt = bytearray(content)
            spoilt[place] ^= 2
            path.write_bytes(bytes(spoilt))
            with contextlib.suppress(OSError, pa.ArrowException):
                after = rows_by_parts(path)
                if after[0] == before[0] and after[1] != before[1]:
                    return
    raise AssertionError("no such bit")


def test_parts_that_lie_about_their_rows_are_noticed(selection):
    misstate_rows_of_a_part(selection)
    with pytest.raises(StageError, match=r"selection\.parquet: damaged .*\b3 rows"):
        tables.read_table(selection, schemas.SELECTION)


def test_scans_that_lie_about_their_rows_are_noticed(scans):
    misstate_rows_of_a_part(scans)
    with pytest.raises(StageError, match=r"scans\.parquet: damaged .*\b3 rows"):
        tables.ScanStore(scans)


def places_of_columns(path):
    with pq.ParquetFile(path) as file:
        groups = [file.metadata.row_group(i) for i in range(file.metadata.num_row_groups)]
        return [g.column(j).data_page_offset for g in groups for j in range(g.num_columns)]


def test_a_column_that_is_sought_at_another_place_is_noticed(scans):
    """The pages there fit their checksums."""
    content, before = scans.read_bytes(), places_of_columns(scans)
    n_moved = 0
    footer = len(content) - 8 - int.from_bytes(content[-8:-4], "little")
    for bit in range(8 * footer, 8 * (len(content) - 8)):
        spoilt = bytearray(content)
        spoilt[bit // 8] ^= 1 << bit % 8
        with contextlib.suppress(OSError, ValueError, pa.ArrowException):
            after = places_of_columns(pa.BufferReader(bytes(spoilt)))
            if len(after) == len(before) and sum(map(operator.ne, after, before)) == 1:
                n_moved += 1
                scans.write_bytes(bytes(spoilt))
                with pytest.raises(StageError, match=r"scans.parquet: damaged"):
                    tables.ScanStore(scans)
    assert n_moved > len(before)


def test_notes_that_are_no_longer_listed_are_noticed(tmp_path):
    path = tmp_path / "noted.parquet"
    tables.write_table(path, schemas.SELECTION, ROWS, notes={"floor_z_m": "0.125"})
    content = bytearray(path.read_bytes())
    first = content.index(b"\x18\x0dscanplan_rows")
    # of a list of structures in Thrift: how many, and what
    n_listed, kind = divmod(content[first - 1], 16)
    assert n_listed > 2 and kind == 12
    for fewer in range(n_listed):
        content[first - 1] = 16 * fewer + kind
        path.write_bytes(bytes(content))
        with contextlib.suppress(StageError):
            assert tables.read_note(path, schemas.SELECTION, "floor_z_m") == "0.125"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (b'{"table": "selection"', b'{"tab\xffe": "selection"'),
        (b'{"table": "selection"', b'["table": "selection"'),
        (b"scanplan", b"scanplam"),
    ],
)
def test_a_spoilt_footer_is_noticed(selection, before, after):
    content = selection.read_bytes()
    assert before in content
    selection.write_bytes(content.replace(before, after))
    with pytest.raises(StageError, match=r"selection.parquet: .*delete it"):
        tables.read_table(selection, schemas.SELECTION)


@pytest.mark.parametrize(("before", "after"), [(b"planar", b"plamar"), (b"true", b"trve")])
def test_spoilt_notes_of_scans_are_noticed(scans, before, after):
    content = scans.read_bytes()
    assert before in content
    scans.write_bytes(content.replace(before, after))
    with pytest.raises(StageError, match=r"scans.parquet: damaged .*delete it"):
        tables.ScanStore(scans)


def test_a_spoilt_note_is_noticed(tmp_path):
    path = tmp_path / "noted.parquet"
    tables.write_table(path, schemas.SELECTION, ROWS, notes={"floor_z_m": "0.125"})
    assert tables.read_note(path, schemas.SELECTION, "floor_z_m") == "0.125"
    assert tables.read_note(path, schemas.SELECTION, "ceiling_z_m") == ""
    path.write_bytes(path.read_bytes().replace(b"0.125", b"4.125"))
    with pytest.raises(StageError, match=r"noted\.parquet: .*checksum"):
        tables.read_note(path, schemas.SELECTION, "floor_z_m")


def test_points_that_are_no_numbers_are_noticed(tmp_path):
    path = tmp_path / "scans.parquet"
    with tables.open_scan_writer(path, planar=True) as write:
        write(3, np.array([[0.0, np.nan, 0.0]]))
    with pytest.raises(StageError, match=r"scans\.parquet: .*scan 3\b"):
        tables.ScanStore(path).read(3)
