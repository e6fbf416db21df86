"""A picture of a floor's returns and its drawing, to read corners off and to check lines.

Usage: show.py FLOOR RESULTS OUT.png X0 Y0 X1 Y1 [PIXELS_PER_M]

Grey: floor that rays went over. Black: returns. Dots: the way. A line each metre. In colours the
drawing FLOOR.geojson beside this, where there is one.
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from benchmarks.truth.fitting import Returns, read_returns

FOLDER = Path(__file__).parent
_MOST_RAYS = 60_000  # more take long to draw and look the same
_COLOURS = {
    "room": "red",
    "surface": "blue",
    "unseen": "magenta",
    "opening": "green",
    "recess": "teal",
    "leaf": "orange",
    "rail": "purple",
    "furniture": "brown",
    "column": "brown",
    "ignore": "grey",
}


def draw_returns(axes: Axes, returns: Returns) -> None:
    """Draw rays, returns and the way."""
    chosen = np.random.default_rng(0).permutation(len(returns.xy_m))[:_MOST_RAYS]
    rays = np.stack([returns.from_m[chosen], returns.xy_m[chosen]], axis=1)
    axes.add_collection(LineCollection(list(rays), colors="0.9", linewidths=0.5))
    axes.plot(*returns.xy_m.T, ",k")
    axes.plot(*returns.way_m.T, ".", color="orange", markersize=3)


def draw_features(axes: Axes, path: Path) -> None:
    """Draw the features of a drawing in the colours of their kinds."""
    for feature in json.loads(path.read_text(encoding="utf-8"))["features"]:
        shape = shapely.geometry.shape(feature["geometry"])
        outline = getattr(shape, "exterior", shape)
        axes.plot(*outline.xy, color=_COLOURS[feature["properties"]["kind"]], linewidth=1.2)


def main() -> None:
    """Write the picture of a window of a floor."""
    name, results, out = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
    x0, y0, x1, y1 = map(float, sys.argv[4:8])
    pixels_per_m = float(sys.argv[8]) if len(sys.argv) > 8 else 80.0
    figure = plt.figure(figsize=((x1 - x0) * pixels_per_m / 100, (y1 - y0) * pixels_per_m / 100))
    axes = figure.add_axes((0, 0, 1, 1))
    draw_returns(axes, read_returns(results))
    if (drawn := FOLDER / f"{name}.geojson").exists():
        draw_features(axes, drawn)
    axes.set(xlim=(x0, x1), ylim=(y0, y1))
    for x_m in range(int(np.ceil(x0)), int(x1) + 1):
        axes.axvline(x_m, color="0.8", linewidth=0.3)
        axes.annotate(str(x_m), (x_m, y1), va="top", fontsize=7)
    for y_m in range(int(np.ceil(y0)), int(y1) + 1):
        axes.axhline(y_m, color="0.8", linewidth=0.3)
        axes.annotate(str(y_m), (x0, y_m), fontsize=7)
    figure.savefig(out, dpi=100)


if __name__ == "__main__":
    main()
