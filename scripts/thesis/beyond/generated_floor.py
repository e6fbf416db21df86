"""Floors with any number of rooms, drawn at random: wings of rooms along hallways."""

import json
import math
from itertools import pairwise
from typing import Any

import numpy as np

Line = list[tuple[float, float]]

# ASSUME an office's rooms: wide enough for a desk and a way, as deep as daylight reaches
WIDTH_M = (3.0, 5.5)
DEPTH_M = (4.0, 5.5)
HALLWAY_M = (1.6, 2.4)
_DOOR_M = 0.9  # ASSUME a door of an office


def draw_floor(n_rooms: int, seed: int) -> bytes:
    """Draw a floor of rooms on both sides of hallways.

    A wing is a hallway with a row of rooms on either side; wings lie behind one another and open
    into a hallway across their ends. Widths, depths and the places of doors are drawn by the seed;
    there are as many wings as make the floor about square. There are no windows and no furniture.

    Parameters
    ----------
    n_rooms : int, >= 2
        Without hallways.

    Returns
    -------
    bytes
        A drawing, as `drawing_file.parse_drawing` reads it.
    """
    rng = np.random.default_rng([seed, n_rooms])
    depth_m, width_m = sum(DEPTH_M) / 2, sum(WIDTH_M) / 2
    wing_m = 2 * depth_m + sum(HALLWAY_M) / 2
    n_wings = max(1, round(math.sqrt(n_rooms * width_m / 2 / wing_m)))
    counts = [len(part) for part in np.array_split(np.arange(n_rooms), 2 * n_wings)]
    begin_m = float(rng.uniform(*HALLWAY_M)) if n_wings > 1 else 0.0
    end_m = begin_m + max(counts) * width_m
    walls: list[Line] = []
    doors: list[tuple[float, float]] = []
    y_m = 0.0
    for south, north in zip(counts[::2], counts[1::2], strict=True):
        low_m = y_m + float(rng.uniform(*DEPTH_M))
        high_m = low_m + float(rng.uniform(*HALLWAY_M))
        top_m = high_m + float(rng.uniform(*DEPTH_M))
        for count, (outer_m, inner_m) in ((south, (y_m, low_m)), (north, (top_m, high_m))):
            borders_m = _draw_borders(rng, begin_m, end_m, count)
            walls.append([(begin_m, inner_m), (end_m, inner_m)])
            # the outer walls close the row; across the wings' ends there is a hallway
            walls += [[(x_m, outer_m), (x_m, inner_m)] for x_m in borders_m[begin_m == 0 : -1]]
            doors += [(_place_door(rng, a, b), inner_m) for a, b in pairwise(borders_m)]
        if y_m > 0:
            walls.append([(begin_m, y_m), (end_m, y_m)])
        y_m = top_m
    outline = [(0.0, 0.0), (end_m, 0.0), (end_m, y_m), (0.0, y_m), (0.0, 0.0)]
    features = [_feature("wall", outline, thickness_m=0.3)]
    features += [_feature("wall", line, thickness_m=0.12) for line in walls]
    features += [_door(place) for place in doors]
    drawing = {"type": "FeatureCollection", "height_m": 2.7, "features": features}
    return json.dumps(drawing).encode()


def _draw_borders(rng: np.random.Generator, low_m: float, high_m: float, count: int) -> list[float]:
    """Return where `count` rooms of a row begin and end, as wide as they may be beside another."""
    widths = rng.uniform(*WIDTH_M, count)
    edges = np.concatenate([[0.0], np.cumsum(widths)]) / widths.sum()
    return (low_m + edges * (high_m - low_m)).tolist()


def _place_door(rng: np.random.Generator, low_m: float, high_m: float) -> float:
    return float(rng.uniform(low_m + _DOOR_M, high_m - _DOOR_M))


def _door(place: tuple[float, float]) -> dict[str, Any]:
    opening = {"type": "door", "width_m": _DOOR_M, "sill_m": 0.0, "lintel_m": 2.1}
    point = {"type": "Point", "coordinates": place}
    return {"type": "Feature", "properties": {"kind": "opening", **opening}, "geometry": point}


def _feature(kind: str, line: Line, **values: Any) -> dict[str, Any]:
    geometry = {"type": "LineString", "coordinates": line}
    return {"type": "Feature", "properties": {"kind": kind, **values}, "geometry": geometry}
