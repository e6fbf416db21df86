"""How many scans of an ordering the plan is made of."""

from scanplan import greedy


def n_scans(columns, *, n_scans=None, area_share=None):
    """Return how many of the first scans to use, and why.

    Parameters
    ----------
    columns : dict of str to (n,) numpy.ndarray, n >= 1
        `covered_m2` of a table of an ordering, by rank.
    n_scans : int, >= 1, optional
        Use so many scans, or all if there are fewer.
    area_share : float in (0, 1], optional
        Use the fewest scans that cover this share of what all cover (within `greedy.TIE_M2`). Given together with
        `n_scans`, whichever needs fewer scans decides; given neither, all scans are used.

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
        limits.append(_by_area(covered_m2, area_share))
    # of equals the last: the limit that was asked for
    return min(reversed(limits), key=lambda limit: limit[0])


def _by_number(n, wanted):
    if wanted > n:
        return n, f"all {n} scans: {wanted} were asked for, there are no more"
    return int(wanted), f"{wanted} of {n} scans, as asked for"


def _by_area(covered_m2, share):
    enough = covered_m2 >= share * covered_m2[-1] - greedy.TIE_M2
    k = int(enough.argmax()) + 1
    return k, f"{k} of {len(covered_m2)} scans cover {share:.4g} of the {covered_m2[-1]:.1f} m2 that all cover"
