"""Orders of scans that look at nothing but when and where they were taken."""

import numpy as np

from scanplan.selection.survey_scans import SurveyScans
from scanplan.store import registered_scans
from scanplan.types import FloatArray, IntArray


def order_randomly(scans: SurveyScans) -> IntArray:
    """Return a permutation (n,) of scans drawn with their seed.

    Raises
    ------
    ValueError
        If there is no seed.
    """
    if scans.seed is None:
        raise ValueError("a random order needs a seed")
    return np.random.default_rng(scans.seed).permutation(len(scans))


def order_sequentially(scans: SurveyScans) -> IntArray:
    """Return scans (n,) as recorded."""
    return np.arange(len(scans))


def order_every_nth(scans: SurveyScans) -> IntArray:
    """Return scans (n,) so that any first k of them are spread evenly over the recording.

    The first, the middle, the quarters, the eighths: the places that the base-2 van der Corput
    sequence, indices with their bits read backwards, names in the recording (van der Corput 1935,
    "Verteilungsfunktionen").
    """
    n = len(scans)
    bits = max(1, int(n - 1).bit_length()) if n else 1
    index = np.arange(2**bits) if n else np.arange(0)
    reversed_bits = np.zeros_like(index)
    for bit in range(bits):
        reversed_bits += ((index >> bit) & 1) << (bits - 1 - bit)
    place = reversed_bits * n >> bits
    _, first = np.unique(place, return_index=True)
    return place[np.sort(first)]


def order_by_distance(scans: SurveyScans) -> IntArray:
    """Return scans (n,) so that every next one was taken farthest from all before it.

    Raises
    ------
    StageError
        If the table of registration has no position of a scan.
    """
    return order_farthest_first(_positions(scans))


def order_farthest_first(xy_m: FloatArray) -> IntArray:
    """Return an order (n,) of places in which every next one is the farthest from all before it.

    The first comes first, of equals the lowest index (Gonzalez 1985, "Clustering to minimize the
    maximum intercluster distance": any first k leave none farther from them than twice what the
    best k could).

    Parameters
    ----------
    xy_m : (n, 2) float, finite
    """
    xy_m = np.asarray(xy_m, float)
    order = []
    nearest_m = np.full(len(xy_m), np.inf)
    for _ in range(len(xy_m)):
        order.append(int(np.argmax(nearest_m)))
        nearest_m = np.minimum(nearest_m, np.hypot(*(xy_m - xy_m[order[-1]]).T))
        nearest_m[order[-1]] = -1.0
    return np.array(order, int)


def _positions(scans: SurveyScans) -> FloatArray:
    """Return where (n, 2) the sensor was at scans."""
    registered = registered_scans.select_kept_scans(scans.tables["registration"], "registration")
    positions_m = registered_scans.sensor_positions(
        scans.scan_ids, registered, "hulls", "registration"
    )
    return positions_m[:, :2]
