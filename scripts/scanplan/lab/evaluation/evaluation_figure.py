"""The figure of the evaluation: what the first scans of every ordering find of the true walls."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from scanplan.report import top_view
from scanplan.selection.methods import METHODS

_SIZE_IN = (7.0, 8.6)
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


def draw_evaluation_figure(measured, aligned, *, method, extractor):
    """Draw completeness by every method and extractor, bitmap metrics (thesis, figure 5.4) and reasons of misses.

    Parameters
    ----------
    measured, aligned : dict of str to (n,) array
        The columns of `schemas.EVALUATION`, as registered and after the best rigid motion.
    method, extractor : str
        Whose misses, and whose bitmap metrics are drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=_SIZE_IN, layout="constrained")
    names = sorted(set(measured["extractor"].tolist()), key=lambda name: name != extractor)
    layout = "".join(
        f"{2 * row}{2 * row}{2 * row}{2 * row + 1}{2 * row + 1}{2 * row + 1};"
        for row in range(len(names))
    )
    axes = figure.subplot_mosaic(f"{layout}aabbcc;mmmooo")
    for row, name in enumerate(names):
        for column, (table, frame) in enumerate(
            ((measured, "as registered"), (aligned, "after a rigid motion"))
        ):
            _completeness(
                axes[str(2 * row + column)], _of(table, extractor=name), f"{name}, {frame}"
            )
    for key, (share, title) in zip("abc", _BITMAP.items(), strict=True):
        _curves(axes[key], _of(measured, extractor=extractor), share)
        axes[key].set_title(f"{title}, {extractor}", fontsize=7)
        axes[key].set_ylabel("share of all cells", fontsize=7)
    for key, name in (("m", method), ("o", "oracle")):
        _missed(axes[key], _of(measured, extractor=extractor, method=name))
        axes[key].set_title(f"missed, {name}, {extractor}, as registered", fontsize=7)
    handles, labels = axes["0"].get_legend_handles_labels()
    figure.legend(
        handles[::-1], labels[::-1], loc="outside upper center", ncols=3, fontsize=7, frameon=False
    )
    handles, labels = axes["m"].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=7, frameon=False)
    return figure


def sort_methods(methods):
    """Return the methods in the order to draw them in: the known ones last, the oracle on top."""
    known = list(_STYLES)
    return sorted(
        set(np.asarray(methods).tolist()), key=lambda m: (-known.index(m) if m in known else -99, m)
    )


def method_style(method):
    """Return how a method is called in a legend, and its colour."""
    return _STYLES.get(
        method, (method.replace("_", " "), _OTHER[sum(map(ord, method)) % len(_OTHER)])
    )


def _completeness(axes, table, title):
    _curves(axes, table, _FOUND)
    axes.set_ylim(0, 1.02)
    axes.set_title(title, fontsize=7)
    axes.set_ylabel("visible walls found", fontsize=7)


def _curves(axes, table, column):
    for method in sort_methods(table["method"]):
        label, colour = method_style(method)
        of_it = _of(table, method=method)
        is_baseline = method in METHODS and METHODS[method].is_baseline
        dashes, width = ("--", 0.8) if is_baseline else ("-", 1.2)
        axes.plot(
            of_it["k"], of_it[column], dashes, color=colour, lw=width, marker="o", ms=1.6,
            label=label, gid=f"{column}-{method}",
        )  # fmt: skip
    _scan_axis(axes, table["k"])


def _missed(axes, table):
    colours = [colour for _, colour in _REASONS.values()]
    axes.stackplot(
        table["k"], *(table[reason] for reason in _REASONS), colors=colours, lw=0,
        labels=[label for label, _ in _REASONS.values()],
    )  # fmt: skip
    axes.set_ylim(0, 1.02)
    axes.set_ylabel("share of all true walls", fontsize=7)
    _scan_axis(axes, table["k"])


def _scan_axis(axes, sizes):
    axes.set_xscale("log")
    axes.set_xlim(1, max(2, sizes.max()) * 1.05)
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("number of scans", fontsize=7)
    top_view.strip_frame(axes)
    axes.tick_params(labelsize=6)


def _of(table, **wanted):
    chosen = np.all([table[name] == value for name, value in wanted.items()], axis=0)
    return {name: values[chosen] for name, values in table.items()}
