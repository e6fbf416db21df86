"""The report's chart: what the first k scans cover and find, for every k."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from scanplan.types import FloatArray, IntArray

MARGIN_M = 0.5  # around what drawings must show, so that marks at the edge are whole
LOGARITHMIC_FROM = 100  # scans: from here on the first few would crowd on a linear axis


class Plot:
    """SVG units of the plot without its labels: about one a pixel."""

    WIDTH = 580
    HEIGHT = 250


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
    axis = _ScanAxis(n_scans, n_scans >= LOGARITHMIC_FROM)
    chosen_x = axis.x(n_chosen)
    return "\n".join([
        # beside the plot there is room for "100 %" and for two lines of text
        f'<svg id="chart" viewBox="-48 -12 {Plot.WIDTH + 60} {Plot.HEIGHT + 50}" role="img"'
        ' aria-label="Shares against the number of scans"'
        f' data-width="{Plot.WIDTH}" data-scans="{n_scans}"'
        f' data-logarithmic="{int(axis.logarithmic)}">',
        *_share_grid(),
        *_scan_ticks(axis),
        *(_polyline(css, curve, axis) for css, curve in curves.items()),
        f'<path class="chosen" d="M{chosen_x:.1f} 0V{Plot.HEIGHT}">'
        "<title>scans of the plan</title></path>",
        f'<path id="chart-k" d="M0 0V{Plot.HEIGHT}"/></svg>',
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
        return share * Plot.WIDTH

    def ticks(self) -> list[int]:
        """Return round numbers: 1, 2, 5 times powers of ten, or ten even steps at most."""
        round_numbers = [lead * 10**k for k in range(len(str(self.n_scans))) for lead in (1, 2, 5)]
        if self.logarithmic:
            return [number for number in round_numbers if number <= self.n_scans]
        step = next(number for number in round_numbers if self.n_scans - 1 <= 10 * number)
        return sorted({1, *range(step, self.n_scans + 1, step)})


def _share_grid() -> list[str]:
    parts = []
    for share in np.linspace(0, 1, 6):
        y = _y(share)
        parts.append(f'<path class="grid" d="M0 {y:.1f}H{Plot.WIDTH}"/>')
        parts.append(_text("-6", f"{y + 4:.1f}", "end", f"{share:.0%}"))
    return parts


def _scan_ticks(axis: _ScanAxis) -> list[str]:
    scale = " (logarithmic)" if axis.logarithmic else ""
    return [
        *(
            _text(f"{axis.x(t):.1f}", f"{Plot.HEIGHT + 18}", "middle", f"{t:,}")
            for t in axis.ticks()
        ),
        _text(f"{Plot.WIDTH / 2:g}", f"{Plot.HEIGHT + 34}", "middle", f"number of scans{scale}"),
    ]


def _text(x: str, y: str, anchor: str, text: str) -> str:
    return f'<text class="tick" x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>'


def _polyline(css: str, curve: Curve, axis: _ScanAxis) -> str:
    places = zip(curve.n_scans, curve.shares, strict=True)
    points = " ".join(f"{axis.x(k):.1f},{_y(share):.1f}" for k, share in places)
    title = f"<title>{curve.name}</title>"
    return f'<polyline class="curve {css}" points="{points}">{title}</polyline>'


def _y(share: float) -> float:
    return (1 - share) * Plot.HEIGHT
