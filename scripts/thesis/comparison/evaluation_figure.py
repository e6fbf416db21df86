"""The figure of the evaluation: what the first scans of every ordering find of the true walls."""

from collections.abc import Iterable

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from scanplan.report import top_view
from scanplan.selection.methods import METHODS

_STYLES = {
    "oracle": ("oracle: knows the truth", "black"),
    "sight": ("oracle by sight alone", "0.55"),
    **{name: (method.label, method.colour) for name, method in METHODS.items()},
}
_OTHER = ("#e69f00", "#56b4e9", "#f0e442", "#8c510a", "#762a83", "#5ab4ac")
_FOUND = "visible_completeness_010m"
_BITMAP = {
    "false_negative": "false negative",
    "correct_match": "correct match",
    "false_positive": "false positive",
}
_REASONS = {
    "missed_not_seen": ("no chosen scan could see it", "#bdbdbd"),
    "missed_misregistered": ("found but for the registration", "#e69f00"),
    "missed_misextracted": ("not extracted", "#56b4e9"),
}


def draw_evaluation_figure(
    measures: pd.DataFrame, aligned: pd.DataFrame, *, method: str, extractor: str
) -> Figure:
    """Draw completeness by every method and extractor, bitmap metrics and reasons of misses.

    The bitmap metrics are those of the thesis's figure 5.4.

    Parameters
    ----------
    measures, aligned : pandas.DataFrame
        `schemas.EVALUATION`, as registered and after the best rigid motion.
    method, extractor : str
        Whose misses, and whose bitmap metrics are drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    # a page of A4 but for the caption
    figure = Figure(figsize=(7.0, 8.6), layout="constrained")
    names = sorted(sorted(measures["extractor"].unique()), key=lambda name: name != extractor)
    axes = figure.subplot_mosaic(_mosaic(len(names)))
    for row, name in enumerate(names):
        left, right = axes[str(2 * row)], axes[str(2 * row + 1)]
        _draw_completeness(left, measures[measures["extractor"] == name], f"{name}, as registered")
        moved = aligned[aligned["extractor"] == name]
        _draw_completeness(right, moved, f"{name}, after a rigid motion")
    of_extractor = measures[measures["extractor"] == extractor]
    for key, (share, title) in zip("abc", _BITMAP.items(), strict=True):
        _draw_curves(axes[key], of_extractor, share)
        axes[key].set_title(f"{title}, {extractor}", fontsize=7)
        axes[key].set_ylabel("share of all cells", fontsize=7)
    for key, name in (("m", method), ("o", "oracle")):
        _draw_missed(axes[key], of_extractor[of_extractor["method"] == name])
        axes[key].set_title(f"missed, {name}, {extractor}, as registered", fontsize=7)
    handles, labels = axes["0"].get_legend_handles_labels()
    figure.legend(
        handles[::-1], labels[::-1], loc="outside upper center", ncols=3, fontsize=7, frameon=False
    )
    handles, labels = axes["m"].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=7, frameon=False)
    return figure


def _mosaic(n_extractors: int) -> str:
    """Return the layout: two panels for every extractor, three bitmap metrics, two of misses."""
    rows = [f"{2 * row}" * 3 + f"{2 * row + 1}" * 3 for row in range(n_extractors)]
    return ";".join([*rows, "aabbcc", "mmmooo"])


def sort_methods(methods: Iterable[str]) -> list[str]:
    """Return the methods in the order to draw them in: the known ones last, the oracle on top."""
    layer = {method: -place for place, method in enumerate(_STYLES)}
    return sorted(methods, key=lambda method: (layer.get(method, -len(_STYLES)), method))


def method_style(method: str) -> tuple[str, str]:
    """Return how a method is called in a legend, and its colour."""
    return _STYLES.get(
        method, (method.replace("_", " "), _OTHER[sum(map(ord, method)) % len(_OTHER)])
    )


def _draw_completeness(axes: Axes, table: pd.DataFrame, title: str) -> None:
    _draw_curves(axes, table, _FOUND)
    axes.set_ylim(0, 1.02)
    axes.set_title(title, fontsize=7)
    axes.set_ylabel("visible walls found", fontsize=7)


def _draw_curves(axes: Axes, table: pd.DataFrame, column: str) -> None:
    curves = table.pivot(index="k", columns="method", values=column)
    for method in sort_methods(curves.columns):
        label, colour = method_style(method)
        is_baseline = method in METHODS and METHODS[method].is_baseline
        dashes, width = ("--", 0.8) if is_baseline else ("-", 1.2)
        axes.plot(
            curves[method].dropna(),
            dashes,
            color=colour,
            lw=width,
            marker="o",
            ms=1.6,
            label=label,
            gid=f"{column}-{method}",
        )
    _scale_scan_axis(axes, table["k"])


def _draw_missed(axes: Axes, table: pd.DataFrame) -> None:
    labels, colours = zip(*_REASONS.values(), strict=True)
    shares = [table[reason] for reason in _REASONS]
    axes.stackplot(table["k"], *shares, colors=colours, lw=0, labels=labels)
    axes.set_ylim(0, 1.02)
    axes.set_ylabel("share of all true walls", fontsize=7)
    _scale_scan_axis(axes, table["k"])


def _scale_scan_axis(axes: Axes, sizes: pd.Series) -> None:
    axes.set_xscale("log")
    axes.set_xlim(1, max(2, sizes.max()) * 1.05)
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("number of scans", fontsize=7)
    top_view.strip_frame(axes)
    axes.tick_params(labelsize=6)
