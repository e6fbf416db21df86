"""All points of the scans that a plan is made of, for its report: a process that the server starts.

`python -m scanplan.report.sent_points results/NAME` writes them to its output: the length of the
head (four bytes, the lowest first), the head (JSON), and x, y, z of each point in steps of 16 bits.
"""

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from scanplan.errors import StageError
from scanplan.report import solid_view
from scanplan.store import tables
from scanplan.types import Array

_MOST_SENT = 20_000_000  # 120 MB: more than that a browser hardly draws
_STATED = r'id="{}">(.*?)</script>'


def write_points(results: Path, output: BinaryIO) -> None:
    """Write the points that the report's page shows a part of.

    Raises
    ------
    StageError
        If there is no such page, or the scans cannot be read.
    """
    page = results / "report.html"
    try:
        text = page.read_text(encoding="utf-8")
        shown, known = (_read_stated(text, name) for name in ("solid-data", "data"))
    except (OSError, ValueError, TypeError):
        raise StageError(f"{page}: states no points; run the dataset again") from None
    scans = tables.ScanStore(results / "scans.parquet").scans(known["scan_ids"])
    step_m = shown["points"]["step_m"]
    steps = list(_count_steps(scans, shown, step_m))
    n_all = sum(map(len, steps))
    every = max(1, -(-n_all // _MOST_SENT))
    sent = [each[::every] for each in steps]
    head = {"low_m": shown["low_m"], "step_m": step_m, "n": sum(map(len, sent)), "n_all": n_all}
    # what follows begins at an even byte: the page reads 16 bits at a time
    content = json.dumps(head).encode()
    content += b" " * (len(content) % 2)
    output.write(len(content).to_bytes(4, "little") + content)
    for each in sent:
        output.write(each.tobytes())


def _read_stated(page: str, name: str) -> dict[str, Any]:
    found = re.search(_STATED.format(name), page, re.DOTALL)
    return json.loads(found[1] if found else "")


def _count_steps(
    scans: Iterator[tuple[int, Array]], shown: dict[str, Any], step_m: float
) -> Iterator[Array]:
    low_m, high_m = np.array(shown["low_m"]), np.array(shown["high_m"])
    for _, xyz_m in scans:
        yield solid_view.count_steps(xyz_m, shown["floor_m"], (low_m, high_m), step_m).astype("<u2")


if __name__ == "__main__":
    try:
        write_points(Path(sys.argv[1]), sys.stdout.buffer)
    except StageError as error:
        sys.exit(str(error))
