"""Orders of scans that look at nothing but when and where they were taken."""

import numpy as np


def order_randomly(n, seed):
    """Return a permutation of n scans drawn with a seed."""
    return np.random.default_rng(seed).permutation(n)


def order_sequentially(n):
    """Return n scans as recorded."""
    return np.arange(n)


def order_every_nth(n):
    """Return n scans so that any first k of them are spread evenly over the recording.

    The first, the middle, the quarters, the eighths: the places that the base-2 van der Corput sequence, indices with
    their bits read backwards, names in the recording (van der Corput 1935, "Verteilungsfunktionen").
    """
    bits = max(1, int(n - 1).bit_length()) if n else 1
    index = np.arange(2**bits) if n else np.arange(0)
    reversed_bits = sum(((index >> bit) & 1) << (bits - 1 - bit) for bit in range(bits))
    place = reversed_bits * n >> bits
    _, first = np.unique(place, return_index=True)
    return place[np.sort(first)]


def order_by_distance(xy_m):
    """Return the order in which every next scan is the one taken farthest from all before it.

    The first comes first, of equals the lowest index (Gonzalez 1985, "Clustering to minimize the maximum intercluster
    distance": any first k leave no scan farther from them than twice what the best k could).

    Parameters
    ----------
    xy_m : (n, 2) float, finite
        Where the scans were taken.

    Returns
    -------
    (n,) int
    """
    xy_m = np.asarray(xy_m, float)
    nearest_m, order = np.full(len(xy_m), np.inf), []
    for _ in range(len(xy_m)):
        order.append(int(np.argmax(nearest_m)))
        nearest_m = np.minimum(nearest_m, np.hypot(*(xy_m - xy_m[order[-1]]).T))
        nearest_m[order[-1]] = -1.0
    return np.array(order, int)
