"""Where a sensor was, as text: `t x y z ...` a line, or a table whose first line names columns."""

from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.types import FloatArray

_NAMES = (
    ("t", "time", "timestamp", "gpstime", "gps_time", "sec", "seconds", "time_s", "time[s]"),
    ("x", "easting", "east", "e", "pos_x", "x_m", "tx"),
    ("y", "northing", "north", "n", "pos_y", "y_m", "ty"),
    ("z", "height", "altitude", "h", "u", "up", "pos_z", "z_m", "tz", "elevation"),
)
"""What programs call time and place."""
_MOST_BYTES = 2**28  # three days at 100 Hz
_LONGEST_S = 7 * 24 * 3600  # of one trajectory


def read_trajectory(path: Path) -> tuple[FloatArray, FloatArray]:
    """Return times (n,) in seconds, increasing, and places (n, 3) in metres.

    Orientation, if there is any, is not read: points that are in the map need none. Lines that
    begin with `#` or `%` are comments, the last of which may name columns.

    Raises
    ------
    StageError
        If the file is no such text, or has fewer than two times.
    """
    if path.stat().st_size > _MOST_BYTES:
        raise StageError(
            f"{path}: {path.stat().st_size} bytes, more than {_MOST_BYTES}: no trajectory; thin it"
        )
    columns = (0, 1, 2, 3)
    rows: list[list[float]] = []
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        is_comment = line.lstrip().startswith(("#", "%"))
        words = line.lstrip(" #%").replace(",", " ").replace(";", " ").split()
        if not words:
            continue
        if not rows and (is_comment or not _is_number(words[0])):
            columns = _find_columns(words, columns)
            continue
        if is_comment:
            continue
        try:
            rows.append([float(words[column]) for column in columns])
        except (ValueError, IndexError):
            raise StageError(
                f"{path}: line {number} has no time and place (`t x y z`): {line[:60]!r}; mend it"
            ) from None
    values = np.array(rows).reshape(-1, 4)
    values = values[np.isfinite(values).all(axis=1)]
    # of places with one time the first is kept
    time_s, first = np.unique(values[:, 0], return_index=True)
    if len(time_s) < 2 or time_s[-1] - time_s[0] > _LONGEST_S:
        span_s = np.ptp(time_s) if len(time_s) else 0.0
        raise StageError(
            f"{path}: {len(time_s)} times over {span_s:.0f} s: a trajectory has two or more within"
            f" {_LONGEST_S} s; give seconds, and one drive a file"
        )
    return time_s, values[first, 1:]


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _find_columns(words: list[str], columns: tuple[int, ...]) -> tuple[int, ...]:
    """Return where time and place stand by the names in a line; as before if it names none."""
    names = [word.strip("\"'").lower() for word in words]
    found = [next((names.index(n) for n in known if n in names), None) for known in _NAMES]
    return columns if None in found else tuple(column for column in found if column is not None)
