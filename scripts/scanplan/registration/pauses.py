"""Parts of a drive between which nothing was recorded, and that nothing ties to one another."""

import numpy as np

from scanplan.registration.joins import LONGEST_S
from scanplan.registration.multiway import OptimisedMap
from scanplan.registration.pose_graph import INLIER_WEIGHT
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.types import IntArray

_LEAST_SCANS = 3  # of a part: a scan or two that fit nothing displace next to nothing


def measure_untied(scan_ids: IntArray, t_ns: IntArray, optimised: OptimisedMap) -> Measured:
    """Return the number of pauses without a link between the scans before and after.

    The parameters are those of `find_untied`.
    """
    found = find_untied(scan_ids, t_ns, optimised)
    pause_s = np.diff(t_ns) / 1e9
    longest = max(found, key=lambda row: pause_s[row], default=0)
    return state_witness(
        "untied pauses",
        len(found),
        pause_s=pause_s[longest] if found else 0.0,
        after_s=(t_ns[longest] - t_ns[0]) / 1e9,
    )


def find_pauses(t_ns: IntArray) -> IntArray:
    """Return the rows of the first scans after pauses, in which a sensor may have been carried."""
    return np.flatnonzero(np.diff(t_ns) > LONGEST_S * 1e9) + 1


def find_untied(scan_ids: IntArray, t_ns: IntArray, optimised: OptimisedMap) -> list[int]:
    """Return the rows of the last scans before pauses without a link over them.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    t_ns : (n,) int64
        Their stamps.
    """
    ties = [
        sorted((edge.source, edge.target))
        for edge, weight in zip(optimised.edges, optimised.weight, strict=True)
        if weight >= INLIER_WEIGHT
    ]
    earlier, later = np.searchsorted(scan_ids, np.array(ties, np.int64).reshape(-1, 2)).T
    return [
        row
        for row in (find_pauses(t_ns) - 1).tolist()
        if min(row + 1, len(scan_ids) - row - 1) >= _LEAST_SCANS
        and not np.any((earlier <= row) & (later > row))
    ]
