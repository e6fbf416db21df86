"""Poses as text in TUM's form: `t tx ty tz qx qy qz qw`, seconds and metres, a pose a line."""

from decimal import Decimal
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.types import FilePath, FloatArray, IntArray

END_NS = np.iinfo(np.int64).max
"""Stamps in nanoseconds lie below it: 64 bits hold those up to the year 2262."""
_LONGEST_LINE = 10_000  # characters: eight numbers, and a comment


def read_tum(path: FilePath) -> tuple[IntArray, FloatArray]:
    """Read poses; text after `#` is a comment, commas part numbers like spaces.

    Returns
    -------
    t_ns : (n,) int64
        As written, to the nanosecond, in the order of the lines.
    rows : (n, 7) float64
        x, y, z in metres, then the quaternion x, y, z, w; not checked.

    Raises
    ------
    StageError
        If a line does not hold eight numbers, or its stamp is no time.
    """
    stamps = []
    rows = []
    # some editors put a mark that is not shown before the first line
    text = Path(path).read_text(encoding="utf-8-sig", errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        if len(line) > _LONGEST_LINE:
            raise StageError(
                f"{path}: line {number} has {len(line)} characters, no pose more than"
                f" {_LONGEST_LINE}; mend it"
            )
        values = line.split("#")[0].replace(",", " ").split()
        if not values:
            continue
        try:
            if "_" in line.split("#")[0]:
                raise ValueError("Python reads 2_0 as 20")
            stamps.append(int(Decimal(values[0]) * 10**9))
            rows.append([float(value) for value in values[1:]])
        except (ValueError, ArithmeticError):
            raise StageError(
                f"{path}: line {number} is not `t tx ty tz qx qy qz qw`; mend it"
            ) from None
        if len(values) != 8:
            raise StageError(
                f"{path}: line {number} has {len(values)} numbers instead of 8; mend it"
            )
        if abs(stamps[-1]) >= END_NS:
            raise StageError(
                f"{path}: line {number} has a stamp of {values[0]} s, after the year 2262; give"
                " seconds, not milliseconds or nanoseconds"
            )
    return np.array(stamps, np.int64), np.array(rows).reshape(-1, 7)


def format_tum(t_ns: ArrayLike, world_from_sensor: FloatArray) -> str:
    """Return poses as text in TUM's form, nine decimals, a pose a line.

    A line is the stamp in seconds, then x, y, z, qx, qy, qz, qw.
    """
    xyz_m, quat = se3.split_pose(world_from_sensor)
    rows = zip(np.asarray(t_ns).tolist(), np.column_stack([xyz_m, quat]).tolist(), strict=True)
    # whole nanoseconds do not fit a float's 53 bits, so the stamp is put together from integers
    lines = (
        f"{t // 10**9}.{t % 10**9:09d} {' '.join(f'{v:.9f}' for v in pose)}\n" for t, pose in rows
    )
    return "".join(lines)
