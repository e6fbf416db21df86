"""The report's chart: what the first k scans cover and find, for every k."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from scanplan.types import FloatArray, IntArray

_WIDTH, _HEIGHT = 640, 300  # SVG units: fills the page's text column at about one a pixel
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 12, 12, 38  # margins: room for "100%" and for two lines of text
_LOGARITHMIC_FROM = 60  # scans: from here on the first few would crowd on a linear axis
_MOST_TICKS = 8  # as many numbers as fit side by side on a linear axis
# round numbers, up to more scans than a drive of some hours has
_TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000)


@dataclass(frozen=True)
class Curve:
    """A curve of the chart.

    Attributes
    ----------
    name : str
    n_scans : (m,) int, >= 1
    shares : (m,) float, 0 to 1
    """

    name: str
    n_scans: IntArray
    shares: FloatArray


def chart_svg(curves: Mapping[str, Curve], n_scans: int, n_chosen: int) -> str:
    """Return curves of shares against the number of scans as the text of an SVG element.

    Parameters
    ----------
    curves : dict of str to Curve
        By CSS class.
    n_scans : int, >= 1
    n_chosen : int
        How many scans make the plan.

    Returns
    -------
    str
        With a line `#chart-k` for the script to move; `data-` attributes of the element say how
        to place it.
    """
    axis = _ScanAxis(n_scans, n_scans >= _LOGARITHMIC_FROM)
    chosen_x = axis.x(n_chosen)
    return "\n".join([
        f'<svg id="chart" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img"'
        ' aria-label="Shares against the number of scans"'
        f' data-left="{_LEFT}" data-width="{_WIDTH - _LEFT - _RIGHT}" data-scans="{n_scans}"'
        f' data-logarithmic="{int(axis.logarithmic)}">',
        *_share_grid(),
        *_scan_ticks(axis),
        *(_polyline(css, curve, axis) for css, curve in curves.items()),
        f'<path class="chosen" d="M{chosen_x:.1f} {_TOP}V{_HEIGHT - _BOTTOM}">'
        "<title>scans of the plan</title></path>",
        f'<path id="chart-k" d="M0 {_TOP}V{_HEIGHT - _BOTTOM}"/></svg>',
    ])  # fmt: skip


@dataclass(frozen=True)
class _ScanAxis:
    """The axis of numbers of scans, from 1 to all."""

    n_scans: int
    logarithmic: bool

    def x(self, k: int) -> float:
        if self.logarithmic:
            share = np.log(k) / np.log(self.n_scans)
        else:
            share = (k - 1) / max(self.n_scans - 1, 1)
        return _LEFT + share * (_WIDTH - _LEFT - _RIGHT)

    def ticks(self) -> list[int]:
        if self.logarithmic:
            return [tick for tick in _TICKS if tick <= self.n_scans]
        step = next(tick for tick in _TICKS if self.n_scans / tick <= _MOST_TICKS)
        return sorted({1, *range(step, self.n_scans + 1, step)})


def _share_grid() -> list[str]:
    parts = []
    for share in np.linspace(0, 1, 6):
        y = _y(share)
        parts.append(f'<path class="grid" d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}"/>')
        parts.append(_text(f"{_LEFT - 6}", f"{y + 4:.1f}", "end", f"{share:.0%}"))
    return parts


def _scan_ticks(axis: _ScanAxis) -> list[str]:
    scale = " (logarithmic)" if axis.logarithmic else ""
    middle = (_LEFT + _WIDTH - _RIGHT) / 2
    return [
        *(_text(f"{axis.x(t):.1f}", f"{_HEIGHT - 20}", "middle", f"{t:,}") for t in axis.ticks()),
        _text(f"{middle}", f"{_HEIGHT - 4}", "middle", f"number of scans{scale}"),
    ]


def _text(x: str, y: str, anchor: str, text: str) -> str:
    return f'<text class="tick" x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>'


def _polyline(css: str, curve: Curve, axis: _ScanAxis) -> str:
    places = zip(curve.n_scans, curve.shares, strict=True)
    points = " ".join(f"{axis.x(k):.1f},{_y(share):.1f}" for k, share in places)
    title = f"<title>{curve.name}</title>"
    return f'<polyline class="curve {css}" points="{points}">{title}</polyline>'


def _y(share: float) -> float:
    return _TOP + (1 - share) * (_HEIGHT - _TOP - _BOTTOM)
