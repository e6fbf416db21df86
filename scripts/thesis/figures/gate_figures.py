"""Figures of algorithm 3's gates: what survives them, and what fitness rewards."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.gates import (
    BY_FRAMES,
    BY_NEAR_PAIRS,
    BY_RETAINED,
    PAIRED_METHODS,
)
from thesis.stated_claims import CLAIMS

_COLOURS = {BY_FRAMES: "#0072b2", BY_NEAR_PAIRS: "#009e73", BY_RETAINED: "#d55e00"}
_METHOD_COLOURS = dict(zip(PAIRED_METHODS, ("#d55e00", "#e6b800", "#0072b2"), strict=True))


def surviving_shares(gates: pd.DataFrame, reading: str) -> pd.DataFrame:
    """Return what passes the first gate and both, per recorded scan, by fitness distance.

    Parameters
    ----------
    gates : pandas.DataFrame
        `thesis_schemas.GATES`.

    Returns
    -------
    pandas.DataFrame
        `passed` and `kept`, shares by `distance_m`.
    """
    # candidates are every fifth scan: their numbers tell how many were recorded before the last
    n_recorded = gates["scan_id"].max() + 1
    of_reading = gates[gates["reading"] == reading]
    return of_reading.groupby("distance_m")[["passed", "kept"]].sum() / n_recorded


def draw_gates(gates: pd.DataFrame) -> Figure:
    """Draw the share that survives against the distance, and where the survivors lie.

    `gates` is as in `surviving_shares`.
    """
    figure = Figure(figsize=(9.6, 3.6), layout="constrained")
    left, *maps = figure.subplots(1, 3, width_ratios=(1.5, 1, 1))
    (claim,) = (claim for claim in CLAIMS if claim.name == "two_percent_survive")
    stated = claim.stated["share retained"]
    for reading, colour in _COLOURS.items():
        share = surviving_shares(gates, reading).mul(100)
        left.plot(share["kept"], "o-", ms=3.5, lw=1.2, color=colour, label=reading)
        left.plot(share["passed"], ":", lw=1.0, color=colour)
    left.axhline(100 * stated, color="0.4", lw=0.8, ls="--", label="thesis: about 2 %")
    left.set(xlim=(0, None), ylim=(0, None))
    top_view.name_axes(left, "fitness distance (m)", "recorded scans that survive (%)")
    figure.legend(loc="outside lower left", ncols=len(_COLOURS) + 1, fontsize=7, frameon=False)
    for axes, reading in zip(maps, (BY_FRAMES, BY_RETAINED), strict=True):
        off = (surviving_shares(gates, reading)["kept"] - stated).abs()
        _draw_places(axes, gates, reading, off.idxmin())
    return figure


def draw_alignments(alignments: pd.DataFrame) -> Figure:
    """Draw how far alignment takes pairs of scans from the truth, against the fitness it gains.

    Parameters
    ----------
    alignments : pandas.DataFrame
        `thesis_schemas.ALIGNMENTS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    by_distance = alignments.groupby("distance_m")
    figure = Figure(figsize=(9.6, 3.6), layout="constrained")
    frames = figure.subplots(1, len(by_distance), sharey=True, squeeze=False)[0]
    for axes, (distance_m, within) in zip(frames, by_distance, strict=True):
        for method, colour in _METHOD_COLOURS.items():
            pairs = within[within["method"] == method]
            if pairs.empty:
                continue
            gain = pairs["fitness"] - pairs["true_fitness"]
            step = (pairs["step_m"] / pairs["true_step_m"]).median()
            label = f"{method.replace('_', ' ')}: {step:.2f} of the true step"
            error_cm = 100 * pairs["error_m"]
            axes.plot(100 * gain, error_cm, "o", ms=3, color=colour, alpha=0.7, label=label)
        axes.axvline(0, color="0.6", lw=0.8)
        axes.set_title(f"pairs and fitness within {distance_m:g} m", fontsize=9)
        name = "off the truth after alignment (cm)" if axes is frames[0] else ""
        top_view.name_axes(axes, "fitness above that at the truth (points)", name)
        axes.set_ylim(0, None)
        axes.legend(fontsize=7, frameon=False)
    return figure


def _draw_places(axes: Axes, gates: pd.DataFrame, reading: str, distance_m: float) -> None:
    candidates = gates[(gates["reading"] == reading) & (gates["distance_m"] == distance_m)]
    kept = candidates[candidates["kept"]]
    axes.plot(candidates["x_m"], candidates["y_m"], ".", ms=1.5, color="0.75")
    axes.plot(kept["x_m"], kept["y_m"], "o", ms=3, color=_COLOURS[reading])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(f"{reading}, {distance_m:g} m: {len(kept)} scans", fontsize=9)
    top_view.name_axes(axes, "x (m)", "y (m)")
