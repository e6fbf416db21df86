"""How many scans of an ordering the plan is made of."""

import numpy as np

from scanplan import greedy


def n_scans(columns, *, n_scans=None, area_share=None):
    """Return how many of the first scans to use, and why.

    Parameters
    ----------
    columns : dict of str to (n,) numpy.ndarray, n >= 1
        `covered_m2`, or both it and `covered`, of a table of an ordering, by rank.
    n_scans : int, >= 1, optional
        Use so many scans, or all if there are fewer.
    area_share : float in (0, 1], optional
        Use the fewest scans that cover this share of what all cover (within `greedy.TIE_M2`), measured by `covered`,
        the objective of the method itself, where it is given. Given together with `n_scans`, whichever needs fewer
        scans decides; given neither, all scans are used.

    Returns
    -------
    k : int, 1 <= k <= n
    reason : str

    Raises
    ------
    ValueError
        If there are no scans or a limit is out of its range.
    """
    covered_m2 = columns["covered_m2"]
    n = len(covered_m2)
    if n == 0:
        raise ValueError("an ordering of no scans")
    if n_scans is not None and n_scans < 1:
        raise ValueError(f"n_scans is {n_scans}: a plan needs at least one scan")
    if area_share is not None and not 0 < area_share <= 1:
        raise ValueError(f"area_share is {area_share}, must be above 0 and at most 1")
    limits = [(n, f"all {n} scans")]
    if n_scans is not None:
        limits.append(_by_number(n, n_scans))
    if area_share is not None:
        limits.append(_by_share(columns, area_share))
    # of equals the last: the limit that was asked for
    return min(reversed(limits), key=lambda limit: limit[0])


def _by_number(n, wanted):
    if wanted > n:
        return n, f"all {n} scans: {wanted} were asked for, there are no more"
    return int(wanted), f"{wanted} of {n} scans, as asked for"


def _by_share(columns, share):
    covered_m2 = columns["covered_m2"]
    covered = columns.get("covered", covered_m2)
    k = int((covered >= share * covered[-1] - greedy.TIE_M2).argmax()) + 1
    area = np.array_equal(covered, covered_m2)
    whole = f"the {covered[-1]:.1f} m2 that all cover" if area else "what all show, by the method's own measure"
    return k, f"{k} of {len(covered)} scans {'cover' if area else 'show'} {share:.4g} of {whole}"
