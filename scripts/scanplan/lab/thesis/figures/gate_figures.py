"""Figures of algorithm 3's gates: what survives them, and what fitness rewards."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scanplan.lab.thesis.gates import (
    BY_FRAMES,
    BY_NEAR_PAIRS,
    BY_RETAINED,
    PAIRED_METHODS,
)
from scanplan.lab.thesis.stated_claims import CLAIMS
from scanplan.report import top_view
from scanplan.types import Columns, FloatArray

_COLOURS = {BY_FRAMES: "#0072b2", BY_NEAR_PAIRS: "#009e73", BY_RETAINED: "#d55e00"}
_METHOD_COLOURS = dict(zip(PAIRED_METHODS, ("#d55e00", "#e6b800", "#0072b2"), strict=True))


def surviving_shares(gates: Columns, reading: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return fitness distances, and what passes the first gate and both, per recorded scan.

    Parameters
    ----------
    gates : dict of str to (n,) array
        The columns of `schemas.GATES`.
    reading : str
    """
    # candidates are every fifth scan: their numbers tell how many were recorded before the last
    n_recorded = gates["scan_id"].max() + 1
    of_reading = gates["reading"] == reading
    distances_m = np.unique(gates["distance_m"][of_reading])
    rows = [of_reading & (gates["distance_m"] == distance_m) for distance_m in distances_m]
    passed = np.array([gates["passed"][row].sum() for row in rows]) / n_recorded
    kept = np.array([gates["kept"][row].sum() for row in rows]) / n_recorded
    return distances_m, passed, kept


def draw_gates(gates: Columns) -> Figure:
    """Draw the share that survives against the distance, and where the survivors lie.

    `gates` is as in `surviving_shares`.
    """
    figure = Figure(figsize=(9.6, 3.6), layout="constrained")
    left, *maps = figure.subplots(1, 3, width_ratios=(1.5, 1, 1))
    (claim,) = (claim for claim in CLAIMS if claim.name == "two_percent_survive")
    stated = claim.stated["share retained"]
    for reading, colour in _COLOURS.items():
        distances_m, passed, kept = surviving_shares(gates, reading)
        left.plot(distances_m, 100 * kept, "o-", ms=3.5, lw=1.2, color=colour, label=reading)
        left.plot(distances_m, 100 * passed, ":", lw=1.0, color=colour)
    left.axhline(100 * stated, color="0.4", lw=0.8, ls="--", label="thesis: about 2 %")
    left.set(xlim=(0, None), ylim=(0, None))
    top_view.name_axes(left, "fitness distance (m)", "recorded scans that survive (%)")
    left.legend(fontsize=7, frameon=False)
    for axes, reading in zip(maps, (BY_FRAMES, BY_RETAINED), strict=True):
        distances_m, _, kept = surviving_shares(gates, reading)
        nearest = int(np.argmin(np.abs(kept - stated)))
        _draw_places(axes, gates, reading, distances_m[nearest])
    return figure


def draw_alignments(alignments: Columns) -> Figure:
    """Draw how far alignment takes pairs of scans from the truth, against the fitness it gains.

    Parameters
    ----------
    alignments : dict of str to (n,) array
        The columns of `schemas.ALIGNMENTS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    distances_m = np.unique(alignments["distance_m"])
    figure = Figure(figsize=(9.6, 3.6), layout="constrained")
    frames = figure.subplots(1, len(distances_m), sharey=True, squeeze=False)[0]
    for axes, distance_m in zip(frames, distances_m, strict=True):
        for method, colour in _METHOD_COLOURS.items():
            rows = alignments["method"] == method
            rows &= alignments["distance_m"] == distance_m
            if not rows.any():
                continue
            gain = alignments["fitness"][rows] - alignments["true_fitness"][rows]
            error_m = alignments["error_m"][rows]
            step = np.median(alignments["step_m"][rows] / alignments["true_step_m"][rows])
            label = f"{method.replace('_', ' ')}: {step:.2f} of the true step"
            axes.plot(100 * gain, 100 * error_m, "o", ms=3, color=colour, alpha=0.7, label=label)
        axes.axvline(0, color="0.6", lw=0.8)
        axes.set_title(f"pairs and fitness within {distance_m:g} m", fontsize=9)
        name = "off the truth after alignment (cm)" if axes is frames[0] else ""
        top_view.name_axes(axes, "fitness above that at the truth (points)", name)
        axes.set_ylim(0, None)
        axes.legend(fontsize=7, frameon=False)
    return figure


def _draw_places(axes: Axes, gates: Columns, reading: str, distance_m: float) -> None:
    rows = (gates["reading"] == reading) & (gates["distance_m"] == distance_m)
    kept = rows & gates["kept"]
    axes.plot(gates["x_m"][rows], gates["y_m"][rows], ".", ms=1.5, color="0.75")
    axes.plot(gates["x_m"][kept], gates["y_m"][kept], "o", ms=3, color=_COLOURS[reading])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(f"{reading}, {distance_m:g} m: {kept.sum()} scans", fontsize=9)
    top_view.name_axes(axes, "x (m)", "y (m)")
