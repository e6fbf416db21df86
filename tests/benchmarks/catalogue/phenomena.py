"""What a drawing has of what makes real buildings hard, counted from its features."""

from collections import Counter
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Polygon

NAMES = (
    *("leaves", "shut doors", "panes", "glass walls", "mirrors", "columns", "curves", "voids"),
    *("racks", "sloping ceilings", "rooms of different height", "oblique walls", "thick walls"),
    *("walls that are not parallel", "thin walls", "niches", "beams", "stairs", "plants", "beds"),
    *("kitchen fronts", "cupboards before a facade", "polished floors", "low walls"),
)
_FURNITURE = {"rack": "racks", "plant": "plants", "bed": "beds", "kitchen": "kitchen fronts"}
_KINDS = {
    **{"column": "columns", "void": "voids", "mirror": "mirrors", "beam": "beams"},
    **{"stairs": "stairs", "floor": "polished floors"},
}


def count_phenomena(document: dict[str, Any]) -> Counter[str]:
    """Return how often each of `NAMES` occurs in a drawing."""
    features = [(f["properties"], f["geometry"]["coordinates"]) for f in document["features"]]
    counts = Counter[str]()
    for values, _ in features:
        counts[_KINDS.get(values["kind"], "")] += 1
        counts[_FURNITURE.get(values.get("type", ""), "")] += values["kind"] == "furniture"
        counts["leaves"] += "leaf" in values
        counts["shut doors"] += values.get("open_deg", 1) == 0 or values.get("open_share", 1) == 0
        counts["panes"] += values.get("glazed", False)
    counts += _count_walls(features, document["height_m"])
    ceilings = [v for v, _ in features if v["kind"] == "ceiling"]
    counts["sloping ceilings"] += sum("rise_x" in v or "rise_y" in v for v in ceilings)
    counts["rooms of different height"] += len({v["height_m"] for v in ceilings})
    counts["cupboards before a facade"] += _count_before_windows(features)
    del counts[""]
    return counts


def _count_walls(features: list, ceiling_m: float) -> Counter[str]:
    walls = [(values, xy) for values, xy in features if values["kind"] == "wall"]
    counts = Counter[str]()
    for values, _ in walls:
        thick_m = values["thickness_m"]
        glass = values.get("material") == "glass"
        counts["glass walls"] += glass
        counts["curves"] += values.get("curved", False)
        counts["low walls"] += values.get("height_m", ceiling_m) < ceiling_m
        counts["thick walls"] += thick_m >= 0.4
        counts["thin walls"] += thick_m <= 0.06 and not glass
        counts["walls that are not parallel"] += values.get("end_thickness_m", thick_m) != thick_m
    straight = [(v, LineString(xy)) for v, xy in walls if len(xy) == 2]
    counts["oblique walls"] += _count_oblique([line for _, line in straight])
    counts["niches"] += _count_niches(straight)
    return counts


def _count_oblique(lines: list[LineString]) -> int:
    """Return how many walls stand at more than 5 degrees to the longest one and its normal."""
    longest = max(lines, key=lambda line: line.length)
    turns = [(_turn(line) - _turn(longest) + 45) % 90 - 45 for line in lines if line.length > 1]
    return sum(abs(turn) > 5 for turn in turns)


def _turn(line: LineString) -> float:
    (xa, ya), (xb, yb) = line.coords
    return float(np.degrees(np.arctan2(yb - ya, xb - xa)))


def _count_niches(walls: list) -> int:
    """Return how many walls begin and end beside thicker ones whose face is that of theirs."""
    count = 0
    for values, line in walls:
        ends = [shapely.Point(xy) for xy in line.coords]
        beside = [
            other
            for more, other in walls
            if other is not line
            and 0.15 <= more["thickness_m"] - values["thickness_m"] <= 0.3
            and 0.02 < min(other.distance(end) for end in ends) <= 0.16
            and abs((_turn(other) - _turn(line) + 90) % 180 - 90) < 1
        ]
        count += len(beside) >= 2
    return count


def _count_before_windows(features: list) -> int:
    """Return how many tall cupboards stand within 0.6 m of a window's middle."""
    tall = [
        Polygon(xy[0])
        for values, xy in features
        if values["kind"] == "furniture"
        and values["height_m"] >= 1.7
        and values.get("type") in ("cupboard", "shelf")
    ]
    panes = [
        LineString(xy)
        for values, xy in features
        if values["kind"] == "opening" and values["type"] == "window"
    ]
    return sum(any(pane.distance(box) < 0.6 for pane in panes) for box in tall)
