"""A floor's plan over its truth as SVG, every error in the colour of its kind."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.types import Array

TrueFeature = tuple[str, BaseGeometry, Mapping[str, Any]]
"""Kind of a feature of the truth, its geometry in the truth's frame, and its properties."""
COLOURS = {
    "leaf": "#e41a1c",
    "wall": "#e41a1c",
    "furniture": "#ff7f00",
    "mirrored": "#984ea3",
    "outside": "#984ea3",
    "shut_door": "#a65628",
    "off": "#f781bf",
    "bridge": "#00a0a0",
    "other": "#d0006f",
    "wrong_type": "#008000",
    "merged": "#c49a00",
    "part": "#7a9a00",
    "missed": "#1f60ff",
    "unknown": "#b0b0b0",
    "not_entered": "#b0b0b0",
}
"""Verdict to colour; what is right is dark."""
WORDS = {
    "leaf": "open leaf",
    "wall": "drawn as wall",
    "mirrored": "outside or mirrored",
    "shut_door": "shut door",
    "bridge": "across an opening",
    "other": "nothing there",
    "wrong_type": "wrong type",
    "merged": "several in one",
    "part": "part of one",
    "not_entered": "not entered",
}
"""Verdict to what people call it, where they do not call it that."""
_RIGHT = "#303030"
_WIDTH_PX = 460  # of a picture on the page: two beside each other on a laptop
_MARGIN_M = 0.7
_TRUE = {
    "room": "fill:#f4f4f0;stroke:none",
    "wall": "stroke:#c8c8c8;fill:none",
    "furniture": "fill:#efe3cf;stroke:#d8c39a;stroke-width:0.02",
    "column": "fill:#d8d8d8;stroke:#a0a0a0;stroke-width:0.02",
    "pane": "stroke:#9fd3ff;stroke-width:0.06;fill:none",
    "mirror": "stroke:#c9a0ff;stroke-width:0.06;fill:none",
    "void": "fill:#e0e8ff;stroke:#8080c0;stroke-width:0.02",
    "leaf": "stroke:#9a9a9a;stroke-width:0.05;fill:none",
    "surface": "stroke:#c8c8c8;stroke-width:0.1;fill:none",
}
"""Kind of a feature of the truth to its style, drawn in this order."""


def colour_of(verdict: str) -> str:
    """Return the colour that a verdict is drawn in."""
    return _RIGHT if verdict == "right" else COLOURS.get(verdict, COLOURS["other"])


def list_colours() -> dict[str, str]:
    """Return what errors, and what is right, are called by the colour that they are drawn in."""
    called: dict[str, list[str]] = {_RIGHT: ["right"]}
    for verdict, colour in COLOURS.items():
        called.setdefault(colour, []).append(WORDS.get(verdict, verdict))
    return {colour: ", ".join(dict.fromkeys(words)) for colour, words in called.items()}


def draw_floor(truth: Sequence[TrueFeature], elements: Mapping[str, Array]) -> str:
    """Return the picture of a floor.

    Parameters
    ----------
    truth : sequence of TrueFeature
    elements : dict of str to (n,) array
        Columns `table`, `verdict`, `flagged` and `geometry` (WKB) of the floor's elements.

    Returns
    -------
    str
        An element `svg` of a page, one unit a metre.
    """
    shapes: list[BaseGeometry] = list(shapely.from_wkb(np.asarray(elements["geometry"], object)))
    bounds = [g for kind, g, _ in truth if kind in ("room", "wall", "surface")]
    low_x, low_y, high_x, high_y = shapely.total_bounds([*bounds, *shapes])
    box = (low_x - _MARGIN_M, -high_y - _MARGIN_M)
    size = (high_x - low_x + 2 * _MARGIN_M, high_y - low_y + 2 * _MARGIN_M)
    body = [*_draw_truth(truth), *_draw_elements(elements, shapes)]
    return (
        f'<svg width="{_WIDTH_PX}"'
        f' viewBox="{box[0]:.2f} {box[1]:.2f} {size[0]:.2f} {size[1]:.2f}">'
        + "".join(body)
        + "</svg>"
    )


def _draw_truth(truth: Sequence[TrueFeature]) -> Iterator[str]:
    for kind, style in _TRUE.items():
        for of, geometry, values in truth:
            if of == kind:
                thick = f";stroke-width:{values.get('thickness_m', 0.1)}" if kind == "wall" else ""
                yield f'<path style="{style}{thick}" d="{path_data(geometry)}"/>'


def _draw_elements(elements: Mapping[str, Array], shapes: Sequence[BaseGeometry]) -> Iterator[str]:
    """Yield what is right first, so that errors lie on top; rooms below all else."""
    tables, verdicts = (np.asarray(elements[name]).astype(str) for name in ("table", "verdict"))
    order = np.lexsort((verdicts != "right", tables != "room"))
    for i in order.tolist():
        verdict = str(verdicts[i])
        colour = colour_of(verdict)
        if tables[i] == "room":
            right = "fill:none" if verdict == "right" else f"fill:{colour};fill-opacity:0.12"
            style = f"{right};stroke:{colour};stroke-width:0.03"
        elif tables[i] in ("column", "furniture"):
            style = f"fill:none;stroke:{colour};stroke-width:0.05"
        else:
            width = 0.05 if verdict == "right" else 0.12
            style = f"fill:none;stroke:{colour};stroke-width:{width}"
            style += ";stroke-dasharray:0.2 0.12" if verdict == "missed" else ""
        kind = f'class="{tables[i]} {verdict}"'
        yield f'<path {kind} style="{style}" d="{path_data(shapes[i])}"/>'


def path_data(geometry: BaseGeometry) -> str:
    """Return a geometry's lines and rings as the data of an SVG path, y upwards turned down."""
    runs = []
    for part in shapely.get_parts(shapely.get_parts(geometry)):
        rings = shapely.get_rings(part) if part.geom_type == "Polygon" else [part]
        for ring in rings:
            xy = shapely.get_coordinates(ring)
            points = " ".join(f"{x:.2f},{-y:.2f}" for x, y in xy.tolist())
            closed = "Z" if part.geom_type == "Polygon" else ""
            runs.append(f"M{points}{closed}")
    return "".join(runs)
