"""The report's chart: what the first k scans cover and find, for every k."""

import numpy as np

_WIDTH, _HEIGHT = 640, 300
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 12, 12, 38
_LOGARITHMIC_FROM = 60
_TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000)


def chart_svg(curves, n_scans, n_chosen):
    """Return curves of shares against the number of scans as the text of an SVG element.

    Parameters
    ----------
    curves : dict of str to (name, k (m,) int, share (m,) float)
        CSS class to a curve's name, numbers of scans and values from 0 to 1.
    n_scans : int, >= 1
    n_chosen : int
        How many scans make the plan.

    Returns
    -------
    str
        With a line `#chart-k` for the script to move; `data-` attributes of the element say how to place it.
    """
    logarithmic = n_scans >= _LOGARITHMIC_FROM
    parts = [
        f'<svg id="chart" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" aria-label="Shares against the number of scans"'
        f' data-left="{_LEFT}" data-width="{_WIDTH - _LEFT - _RIGHT}" data-scans="{n_scans}"'
        f' data-logarithmic="{int(logarithmic)}">'
    ]
    for share in np.linspace(0, 1, 6):
        y = _y(share)
        parts.append(f'<path class="grid" d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}"/>')
        parts.append(
            f'<text class="tick" x="{_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{share:.0%}</text>'
        )
    for tick in _ticks(n_scans, logarithmic):
        x = _x(tick, n_scans, logarithmic)
        parts.append(
            f'<text class="tick" x="{x:.1f}" y="{_HEIGHT - 20}" text-anchor="middle">{tick:,}</text>'
        )
    scale = " (logarithmic)" if logarithmic else ""
    middle = (_LEFT + _WIDTH - _RIGHT) / 2
    parts.append(
        f'<text class="tick" x="{middle}" y="{_HEIGHT - 4}" text-anchor="middle">number of scans{scale}</text>'
    )
    for css, (name, k, share) in curves.items():
        x = [_x(value, n_scans, logarithmic) for value in k]
        points = " ".join(f"{a:.1f},{_y(b):.1f}" for a, b in zip(x, share, strict=True))
        parts.append(
            f'<polyline class="curve {css}" points="{points}"><title>{name}</title></polyline>'
        )
    x = _x(n_chosen, n_scans, logarithmic)
    parts.append(
        f'<path class="chosen" d="M{x:.1f} {_TOP}V{_HEIGHT - _BOTTOM}"><title>scans of the plan</title></path>'
    )
    parts.append(f'<path id="chart-k" d="M0 {_TOP}V{_HEIGHT - _BOTTOM}"/></svg>')
    return "\n".join(parts)


def _ticks(n_scans, logarithmic):
    if logarithmic:
        return [tick for tick in _TICKS if tick <= n_scans]
    step = next(tick for tick in _TICKS if n_scans / tick <= 8)
    return sorted({1, *range(step, n_scans + 1, step)})


def _x(k, n_scans, logarithmic):
    share = np.log(k) / np.log(n_scans) if logarithmic else (k - 1) / max(n_scans - 1, 1)
    return _LEFT + share * (_WIDTH - _LEFT - _RIGHT)


def _y(share):
    return _TOP + (1 - share) * (_HEIGHT - _TOP - _BOTTOM)
