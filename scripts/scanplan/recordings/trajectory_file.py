"""Where a sensor was, as text: `t x y z ...` a line, or a table whose first line names columns."""

from array import array
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings.integrity import text_lines
from scanplan.types import FloatArray

_NAMES = (
    ("t", "time", "timestamp", "gpstime", "gps_time", "sec", "seconds", "time_s", "time[s]"),
    ("x", "easting", "east", "e", "pos_x", "x_m", "tx"),
    ("y", "northing", "north", "n", "pos_y", "y_m", "ty"),
    ("z", "height", "altitude", "h", "u", "up", "pos_z", "z_m", "tz", "elevation"),
)
"""What programs call time and place."""
_MOST_PLACES = 2**22  # eleven hours at 100 Hz, 34 MB a column
_FARTHEST_M = 1e8  # of a country's coordinates: more than the way round the Earth
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
    values = _read_rows(path)
    values = values[np.isfinite(values).all(axis=1)]
    farthest_m = np.abs(values[:, 1:]).max(initial=0.0)
    if farthest_m > _FARTHEST_M:
        raise StageError(
            f"{path}: a place lies {farthest_m:g} m from the origin, beyond {_FARTHEST_M:g} m on no"
            " Earth; give metres"
        )
    # of places with one time the first is kept
    time_s, first = np.unique(values[:, 0], return_index=True)
    if len(time_s) < 2 or time_s[-1] - time_s[0] > _LONGEST_S:
        span_s = np.ptp(time_s) if len(time_s) else 0.0
        raise StageError(
            f"{path}: {len(time_s)} times over {span_s:.0f} s: a trajectory has two or more within"
            f" {_LONGEST_S} s; give seconds, and one drive a file"
        )
    return time_s, values[first, 1:]


def _read_rows(path: Path) -> FloatArray:
    """Return time and place (n, 4) of each line."""
    columns = (0, 1, 2, 3)
    rows = array("d")
    with path.open("rb") as file:
        for number, raw in enumerate(text_lines.iterate_lines(file, str(path)), 1):
            line = raw.decode("utf-8-sig" if number == 1 else "utf-8", "replace")
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
                rows.extend([float(words[column]) for column in columns])
            except (ValueError, IndexError):
                raise StageError(
                    f"{path}: line {number} has no time and place (`t x y z`): {line[:60]!r}; mend"
                    " it"
                ) from None
            if len(rows) > 4 * _MOST_PLACES:
                raise StageError(f"{path}: more than {_MOST_PLACES} places: no trajectory; thin it")
    return np.array(rows).reshape(-1, 4)


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
