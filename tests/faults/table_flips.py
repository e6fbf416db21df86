"""Bits of tables flipped one by one: what is read is what was written, or it is refused."""

import os
from collections import Counter
from pathlib import Path

import numpy as np

from faults import judging
from scanplan.errors import StageError
from scanplan.store import schemas, tables

SCHEMAS = [value for value in vars(schemas).values() if isinstance(value, schemas.Schema)]
_ROWS = 40
_VALUES = {
    "float64": lambda rng: rng.normal(size=_ROWS),
    "float32": lambda rng: rng.normal(size=_ROWS).astype(np.float32),
    "bool": lambda rng: rng.random(_ROWS) < 0.5,
    "string": lambda rng: np.array([f"word{n}" for n in rng.integers(5, size=_ROWS)], object),
    "binary": lambda rng: np.array([rng.bytes(21) for _ in range(_ROWS)], object),
}


def write_tables(folder, rng):
    """Write a table of every schema with values drawn at random; return (path, schema) of each."""
    written = []
    for schema in SCHEMAS:
        path = Path(folder, f"{schema.name}_{len(written)}.parquet")
        if schema is schemas.SCANS:
            with tables.open_scan_writer(path, planar=False) as write:
                for scan_id in range(4):
                    write(scan_id, rng.normal(size=(50, 3)))
        else:
            columns = {name: _draw(kind, rng) for name, kind in schema.columns.items()}
            for name in schema.sorted_by:
                columns[name] = _increasing(schema.columns[name])
            tables.write_table(path, schema, columns, notes={"note": "as it is"})
        written.append((path, schema))
    return written


def flip_bits(path, schema, n_flips, rng, tally):
    """Flip bits of a table one by one, each in the whole file again; judge each."""
    content = path.read_bytes()
    right = read_all(path, schema)
    bits = rng.choice(8 * len(content), min(n_flips, 8 * len(content)), replace=False)
    group = "bit flips of tables"
    counts, n_done = Counter(), 0
    while n_done < len(bits):
        n_tried, found = _flip_in_child(path, schema, content, bits[n_done:], right)
        counts += found
        n_done += n_tried
        if n_done < len(bits) and n_tried < len(bits):
            # Arrow ended the process; of a stage the run says in a line that it was ended
            counts["clear line"] += 1
            n_done += 1
    path.write_bytes(content)
    for outcome, n in counts.items():
        kind = judging.UNEXPECTED if outcome.startswith(judging.UNEXPECTED) else outcome
        tally.add(group, path.name, kind, outcome, n, judging.children_peak_mb())


def _flip_in_child(path, schema, content, bits, right):
    """Judge flips in a process of their own; return how many it came to, and their outcomes."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        with os.fdopen(writing, "w", buffering=1) as told:
            for bit in bits:
                told.write(f"{_judge_flip(path, schema, content, int(bit), right)}\n")
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as told:
        outcomes = told.read().splitlines()
    os.waitpid(child, 0)
    return len(outcomes), Counter(outcomes)


def _judge_flip(path, schema, content, bit, right):
    flipped = bytearray(content)
    flipped[bit // 8] ^= 1 << bit % 8
    path.write_bytes(flipped)
    try:
        found = read_all(path, schema)
    except StageError as error:
        return judging.CLEAR if len(str(error).splitlines()) == 1 else judging.NO_LINE
    except Exception as error:
        return f"{judging.UNEXPECTED} {type(error).__name__}: {' '.join(str(error).split())}"
    return judging.SOUND if found == right else judging.SILENT


def read_all(path, schema):
    """Return all that a stage could read of a table, to compare."""
    if schema is schemas.SCANS:
        store = tables.ScanStore(path)
        return [(i, xyz_m.tobytes()) for i, xyz_m in store.scans()], store.planar
    rows = tables.read_table(path, schema)
    note = tables.read_note(path, schema, "note")
    values = [
        (name, values.tolist() if values.dtype == object else values.tobytes())
        for name, values in rows.items()
    ]
    return values, note


def _draw(kind, rng):
    if kind in _VALUES:
        return _VALUES[kind](rng)
    if kind.startswith("list"):
        return [list(rng.integers(100, size=3)) for _ in range(_ROWS)]
    return rng.integers(100, size=_ROWS)


def _increasing(kind):
    if kind == "string":
        return np.array([f"row{n:04}" for n in range(_ROWS)], object)
    return np.arange(_ROWS) if "int" in kind else np.arange(_ROWS) / 4
