"""A picture of a drawing, to look at: what stands where, and how doors hang."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon as Patch
from shapely import LineString

from . import buildings, drives

COLOURS = {
    "furniture": "#d9b382",
    "column": "#444444",
    "ceiling": "#cfe3ff",
    "beam": "#9bb4d8",
    "void": "#bbbbbb",
    "stairs": "#c8e6c9",
    "platform": "#e1d5f0",
    "ground": "none",
    "floor": "#f4f4f4",
}
_DEEP = ("ceiling", "floor", "void", "platform")


def draw_all(folder: Path) -> None:
    """Write a picture of every building of the catalogue as FOLDER/KIND_SEED.png."""
    folder.mkdir(parents=True, exist_ok=True)
    for kind, seed in sorted({(drive.kind, drive.seed) for drive in drives.list_drives()}):
        text = buildings.draw_building(kind, seed).text()
        draw_picture(text, folder / f"{kind}_{seed}.png")


def draw_picture(text: str, path: Path, *, way_m: np.ndarray | None = None) -> None:
    """Write a picture of a drawing in GeoJSON as PNG; `way_m` (n, 2) is a way through it."""
    figure = Figure(figsize=(12, 9))
    axes = figure.subplots()
    features = json.loads(text)["features"]
    walls = [f for f in features if f["properties"]["kind"] == "wall"]
    for feature in features:
        _draw_feature(axes, feature, walls)
    if way_m is not None:
        axes.plot(*np.asarray(way_m).T, color="#2a9d2a", lw=1, zorder=9)
    points = np.vstack([np.array(f["geometry"]["coordinates"]) for f in walls])
    axes.set_xlim(points[:, 0].min() - 1, points[:, 0].max() + 1)
    axes.set_ylim(points[:, 1].min() - 1, points[:, 1].max() + 1)
    axes.set_aspect("equal")
    figure.tight_layout()
    figure.savefig(path, dpi=80)


def _draw_feature(axes: Axes, feature: dict, walls: list[dict]) -> None:
    values, xy = feature["properties"], feature["geometry"]["coordinates"]
    kind = values["kind"]
    if kind == "wall":
        low = values.get("height_m", 99) < 2.0
        colour = "#8fd3ff" if values.get("material") == "glass" else "#999999" if low else "black"
        end_m = values.get("end_thickness_m", values["thickness_m"])
        thick_m = (values["thickness_m"] + end_m) / 2
        for run in pairwise(xy):
            shape = LineString(run).buffer(thick_m / 2, cap_style="flat")
            axes.add_patch(Patch(np.array(shape.exterior.coords), color=colour, zorder=3))
    elif kind == "opening":
        _draw_opening(axes, values, np.array(xy), walls)
    elif kind in COLOURS:
        fill = COLOURS[kind]
        tall = kind == "furniture" and values["height_m"] > 1.6
        hanging = values.get("base_m", 0) > 1.0
        patch = Patch(
            np.array(xy[0]),
            facecolor="#a86f2d" if tall and not hanging else "none" if hanging else fill,
            edgecolor="#555555",
            lw=0.5,
            zorder=1 if kind in _DEEP else 4,
            alpha=0.9,
        )
        axes.add_patch(patch)
        if kind in (*_DEEP, "stairs", "beam"):
            middle = np.mean(xy[0][:-1], axis=0)
            axes.text(middle[0], middle[1], kind, fontsize=6, color="#3355aa", ha="center")
    elif kind == "mirror":
        axes.plot(*np.array(xy).T, color="magenta", lw=3, zorder=8)
    elif kind == "facade":
        axes.plot(*np.array(xy).T, color="#777777", lw=2)
    elif kind == "room":
        axes.text(xy[0], xy[1], values["name"], fontsize=7, ha="center", zorder=10, color="navy")


def _draw_opening(axes: Axes, values: dict, xy: np.ndarray, walls: list[dict]) -> None:
    """Draw the hole, and leaves as they stand."""
    middle = LineString(xy).interpolate(0.5, normalized=True)
    wall = min(walls, key=lambda w: LineString(w["geometry"]["coordinates"]).distance(middle))
    half_m = wall["properties"]["thickness_m"] / 2
    colour = {"window": "#4fc3f7", "door": "white", "passage": "#ffe0b2"}[values["type"]]
    hole = LineString(xy).buffer(half_m + 0.01, cap_style="flat")
    axes.add_patch(Patch(np.array(hole.exterior.coords), color=colour, zorder=5))
    if values.get("leaf") in ("hinged", "double"):
        way = (xy[1] - xy[0]) / np.hypot(*(xy[1] - xy[0]))
        left = np.array([-way[1], way[0]]) * (1 if values["side"] == "left" else -1)
        long_m = np.hypot(*(xy[1] - xy[0]))
        hung = [(xy[0], way, long_m), (xy[1], -way, long_m)]
        if values["leaf"] == "double":
            hung = [(p, w, long_m / 2) for p, w, _ in hung]
        else:
            hung = hung[:1] if values["hinge"] == "start" else hung[1:]
        turn = np.radians(values["open_deg"])
        for place, along, reach_m in hung:
            hinge = place + left * half_m
            tip = hinge + reach_m * (np.cos(turn) * along + np.sin(turn) * left)
            axes.plot(*np.array([hinge, tip]).T, color="red", lw=2, zorder=7)
    elif values.get("leaf") == "sliding":
        axes.plot(*xy.T, color="orange", lw=1.5, ls=":", zorder=7)
