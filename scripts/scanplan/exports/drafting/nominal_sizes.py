"""Sizes of a catalogue for what is measured: the same one for all that may well be alike."""

from collections.abc import Sequence

import numpy as np

from scanplan.types import FloatArray

_ROUNDS = 20  # shares settle in fewer
_FEWEST_ALIKE = 3  # as many of one size that no catalogue has are a type: two may be so by chance
_APART = 1.5  # times what one may be off by: between sizes of its own and of the catalogue
_STEP_M = 0.01  # of such a size: as fine as openings are measured
_BUILT_SIGMA_M = 0.005  # plaster and boards make walls of one type differ by as much


def choose_sizes(
    measured_m: FloatArray,
    sigma_m: FloatArray,
    allowed_m: FloatArray,
    sizes_m: Sequence[float],
    weights: FloatArray,
) -> FloatArray:
    """Return the nominal size of each measured one (n,), NaN where none is near enough.

    A building has few types: between two sizes that fit nearly alike, that one is taken which more
    of the others have (the shares of a mixture are fitted by expectation and maximisation).

    Parameters
    ----------
    measured_m, sigma_m : (n,) float
        NaN where nothing was measured.
    allowed_m : (n,) float
        A size farther off is not taken.
    sizes_m : sequence of float
        Of the catalogue.
    weights : (n,) float
        What each counts for.

    Examples
    --------
    >>> near = np.full(3, 0.02)
    >>> choose_sizes(np.array([0.1, 0.101, 0.3]), near / 4, near, (0.1, 0.115), np.ones(3)).tolist()
    [0.1, 0.1, nan]
    """
    sizes = np.array(sorted(sizes_m), float)
    off_m = np.asarray(measured_m, float)[:, None] - sizes
    # rounded, so that what is at the very limit falls to the same side after a motion
    is_near = np.round(np.abs(off_m), 9) <= allowed_m[:, None]
    rows = np.flatnonzero(is_near.any(axis=1))
    chosen_m = np.full(len(off_m), np.nan)
    if len(rows) == 0:
        return chosen_m
    spread_m = np.hypot(sigma_m, _BUILT_SIGMA_M)[rows, None]
    likely = np.where(is_near[rows], np.exp(-((off_m[rows] / spread_m) ** 2) / 2), 0.0)
    likely[likely.sum(axis=1) == 0] = is_near[rows][likely.sum(axis=1) == 0]
    shares = np.full(len(sizes), 1 / len(sizes))
    for _ in range(_ROUNDS):
        belongs = likely * shares
        belongs /= belongs.sum(axis=1, keepdims=True)
        shares = weights[rows] @ belongs
        # none dies out: what fits one wall alone stays possible for it
        shares = np.maximum(shares / shares.sum(), 1e-3)
    chosen_m[rows] = sizes[np.argmax(np.round(likely * shares, 12), axis=1)]
    return chosen_m


def find_own_sizes(
    measured_m: FloatArray, sizes_m: Sequence[float], allowed_m: float
) -> list[float]:
    """Return sizes of a catalogue, and those that several measured ones share and it has not.

    Their median, to a centimetre, of those within `allowed_m` of it, the most frequent first;
    none is nearer to another than half as much again, as what may be either is no size of its own.

    Examples
    --------
    >>> find_own_sizes(np.array([0.9, 0.741, 0.75, 0.752, 1.3]), (0.9,), 0.03)
    [0.9, 0.75]
    >>> find_own_sizes(np.array([0.864, 0.865, 0.87, 0.88, 0.89]), (0.9,), 0.03)
    [0.9]
    """
    sizes = [float(size) for size in sizes_m]
    left_m = np.asarray(measured_m, float)
    left_m = np.sort(left_m[np.isfinite(left_m)])
    while True:
        off_m = np.abs(left_m[:, None] - np.array(sizes))
        left_m = left_m[(off_m > allowed_m).all(axis=1)]
        n_alike = (np.abs(left_m[:, None] - left_m) <= allowed_m).sum(axis=1)
        if len(left_m) == 0 or n_alike.max() < _FEWEST_ALIKE:
            return sizes
        alike_m = left_m[np.abs(left_m - left_m[np.argmax(n_alike)]) <= allowed_m]
        size_m = _STEP_M * round(float(np.median(alike_m)) / _STEP_M)
        left_m = left_m[~np.isin(left_m, alike_m)]
        if np.abs(np.array(sizes) - size_m).min(initial=np.inf) >= _APART * allowed_m:
            sizes.append(round(size_m, 2))
