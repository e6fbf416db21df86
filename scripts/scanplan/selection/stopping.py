"""How many scans of an ordering the plan is made of, and why."""

import json
from typing import Any, Literal

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry.tolerances import SMALLEST_M2
from scanplan.store import scan_cache, schemas, tables
from scanplan.types import Columns, FilePath, FloatArray, IntArray

BYTES_PER_POINT = scan_cache.POINT.itemsize
"""As registered scans are stored before they are compressed."""
AUTO = "auto"
AUTO_SHARES = {False: (0.95,), True: (0.85, 0.9, 0.95)}
"""By whether scans are planar: in space the last twentieth holds windows, else it is furniture.

Of planar scans at least, usually, and at most.
"""
_FEWEST = {False: 3, True: 10}
"""By whether scans are planar: so many are taken, though fewer show enough.

Walls that a single chosen scan shows are doubtful, and planar scans may close corners of a room.
"""
_MOST_SCANS = 0.3  # of planar ones: a third finds no more than a fiftieth more of the walls
_PAYS = 1.5  # m of wall: a tenth of a large building is many such pieces, and rooms that they close


def choose_n_scans(
    columns: Columns,
    *,
    planar: bool | None = None,
    n_scans: int | None = None,
    area_share: float | Literal["auto"] | None = None,
    min_gain_m2: float | None = None,
    max_points: int | None = None,
    max_bytes: int | None = None,
) -> tuple[int, str]:
    """Return how many of the first scans to use, and why.

    Of several limits the one that needs fewest scans decides; with none all scans are used. One
    scan is always used.

    Parameters
    ----------
    columns : dict of str to (n,) numpy.ndarray, n >= 1
        `covered_m2`, or both it and `covered`, of a table of an ordering, by rank; `gain_m2` for
        `min_gain_m2`, `n_points` for a budget.
    planar : bool, optional
        Whether the sensor measures in one plane only; what is automatic needs to know.
    n_scans : int, >= 1, optional
        Use so many scans, or all if there are fewer.
    area_share : float in (0, 1] or "auto", optional
        Use the fewest scans that cover this share of what all cover (within a square millimetre),
        `covered`, the objective of the method itself, where it is given; automatically
        `AUTO_SHARES`, and at least three scans, or ten planar ones. Of planar scans for more than
        the usual share as long as each adds 1.5 m of wall (or of another method's unit), and no
        more than three of ten but for the least share.
    min_gain_m2 : float, > 0, optional
        Use no scan after the last that adds this much area.
    max_points, max_bytes : int, >= 1, optional
        Use no more scans than have so many points, or bytes of points, together.

    Returns
    -------
    k : int, 1 <= k <= n
    reason : str

    Raises
    ------
    ValueError
        If there are no scans or a limit is out of its range.
    StageError
        If the first scan alone is beyond a budget.
    """
    n = len(columns["covered_m2"])
    if n == 0:
        raise ValueError("an ordering of no scans")
    limits = [(n, f"all {n} scans")]
    if n_scans is not None:
        limits.append(_by_number(n, n_scans))
    if area_share == AUTO:
        if planar is None:
            raise ValueError("area_share is auto, but not whether scans are planar")
        limits.append(_by_scanner(columns, planar))
    elif area_share is not None:
        limits.append(_by_share(columns, area_share))
    if min_gain_m2 is not None:
        limits.append(_by_gain(columns["gain_m2"], min_gain_m2))
    for limit, unit, size in ((max_points, "points", 1), (max_bytes, "bytes", BYTES_PER_POINT)):
        if limit is not None:
            limits.append(_by_budget(columns["n_points"], limit, unit, size))
    # of equals the last: the limit that was asked for
    return min(reversed(limits), key=lambda limit: limit[0])


def read_chosen_scans(selection: FilePath, **stop: Any) -> tuple[IntArray, str]:
    """Return which scans the plan is made of, and why so many.

    Parameters
    ----------
    selection : path-like
        selection/<method>.parquet.
    **stop
        See `choose_n_scans`.

    Returns
    -------
    scan_ids : (k,) int
        By rank.
    reason : str
    """
    ordering, count, reason = read_choice(selection, **stop)
    return ordering["scan_id"][:count], reason


def read_choice(selection: FilePath, **stop: Any) -> tuple[Columns, int, str]:
    """Return the columns of an ordering, how many of its first scans to use, and why.

    Parameters as of `read_chosen_scans`.
    """
    ordering = tables.read_table(selection, schemas.SELECTION)
    planar = json.loads(tables.read_note(selection, schemas.SELECTION, "planar") or "false")
    return ordering, *choose_n_scans(ordering, planar=planar, **stop)


def points_budget(*, max_points: int | None = None, max_bytes: int | None = None) -> int | None:
    """Return how many points two limits leave together; None where neither is given."""
    limits = [max_points, None if max_bytes is None else max_bytes // BYTES_PER_POINT]
    return min((limit for limit in limits if limit is not None), default=None)


def _by_number(n: int, wanted: int) -> tuple[int, str]:
    if wanted < 1:
        raise ValueError(f"n_scans is {wanted}: a plan needs at least one scan")
    if wanted > n:
        return n, f"all {n} scans: {wanted} were asked for, there are no more"
    return int(wanted), f"{wanted} of {n} scans, as asked for"


def _by_share(columns: Columns, share: float) -> tuple[int, str]:
    if not 0 < share <= 1:
        raise ValueError(f"area_share is {share}, must be above 0 and at most 1")
    covered = columns.get("covered", columns["covered_m2"])
    k = int((covered >= share * covered[-1] - SMALLEST_M2).argmax()) + 1
    return k, _say_share(k, f"{100 * share:.4g} %", columns)


def _by_scanner(columns: Columns, planar: bool) -> tuple[int, str]:
    n = len(columns["covered_m2"])
    fewest = min(_FEWEST[planar], n)
    k, said = _by_shares(columns, AUTO_SHARES[planar])
    if k < fewest:
        return fewest, f"{fewest} of {n} scans, the fewest that are taken"
    return k, said


def _by_shares(columns: Columns, shares: tuple[float, ...]) -> tuple[int, str]:
    *fewer, enough = (_by_share(columns, share) for share in shares)
    if not fewer:
        return enough
    least, usual = fewer
    covered = columns.get("covered", columns["covered_m2"])
    later = np.diff(covered)[usual[0] - 1 :]
    paying = usual[0] + int(np.argmax(np.append(later, 0.0) < _PAYS - SMALLEST_M2))
    most = max(int(_MOST_SCANS * len(covered)), least[0], _FEWEST[True])
    k = min(paying, most, enough[0])
    if k == enough[0]:
        return enough
    said = _say_share(k, f"{100 * covered[k - 1] / covered[-1]:.1f} %", columns)
    if k < paying:
        limits = f"{100 * _MOST_SCANS:.0f} %, {_FEWEST[True]}, or as many as show"
        return k, f"{said}; 2-D limit: {limits} {100 * shares[0]:.4g} %"
    if k == usual[0]:
        return usual
    return k, f"{said}; the next adds less than {_PAYS:.4g} m or m2"


def _say_share(k: int, share: str, columns: Columns) -> str:
    covered_m2 = columns["covered_m2"]
    chosen = f"{k} of {len(covered_m2)} scans"
    if np.array_equal(columns.get("covered", covered_m2), covered_m2):
        return f"{chosen} cover {share} of the {covered_m2[-1]:.1f} m2 that all cover"
    return f"{chosen} show {share} of what all show"


def _by_gain(gain_m2: FloatArray, least_m2: float) -> tuple[int, str]:
    if not least_m2 > 0:
        raise ValueError(f"min_gain_m2 is {least_m2}, must be above 0")
    adding = np.flatnonzero(gain_m2 >= least_m2 - SMALLEST_M2)
    k = int(adding[-1]) + 1 if len(adding) else 1
    return k, f"{k} of {len(gain_m2)} scans: no later one adds {least_m2:.4g} m2"


def _by_budget(n_points: IntArray, limit: int, unit: str, size: int) -> tuple[int, str]:
    if limit < 1:
        raise ValueError(f"max_{unit} is {limit}, must be at least 1")
    used = size * np.cumsum(n_points, dtype=np.int64)
    k = int(np.searchsorted(used, limit, side="right"))
    if k == 0:
        raise StageError(
            f"selection.stop.max_{unit}: the first scan has {used[0]:,} {unit},"
            f" the budget is {limit:,}; raise it"
        )
    return k, f"{k} of {len(used)} scans: {used[k - 1]:,} of at most {limit:,} {unit}"
