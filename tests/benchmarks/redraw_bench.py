"""What an architect would redraw of sheets: one fixed list, counted on both styles."""

from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.drafting.presentation import compose_presentation
from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings
from scanplan.exports.sheet.composition import Sheet, compose_sheet, paper_words, plan_words
from scanplan.exports.sheet.lettering import word_box
from scanplan.exports.sheet.marks import flatten
from scanplan.exports.sheet.symbols import symbol_paths
from scanplan.geometry import overlays
from scanplan.plan import floorplan, floorplan_files
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.tolerances import CORNER_M
from scanplan.project import catalogue_file
from scanplan.types import Array, FloatArray, Settings

LIST = {
    "double": "walls side by side, less than 0.3 m apart along half of the shorter one",
    "nearly met": "ends of walls less than 0.25 m before another wall, in their direction",
    "askew": "walls off the main directions, or 45 degrees to them, by 0.1 to 2 degrees",
    "scrap": "walls shorter than 0.4 m with a free end",
    "openings": "openings side by side on one another, by more than a centimetre",
    "swing": "doors that swing through a wall, by more than 0.1 m",
    "label": "words on walls, or on one another",
    "unnamed": "rooms whose name or area does not stand in them",
}
"""What is counted, and when."""
_DOUBLE_M, _NEARLY_M, _SCRAP_M = 0.3, 0.25, 0.4
_TOUCHING_M = 0.002  # what is drawn to touch does so to rounding
_ALONG_DEG = 5.0  # between walls that run side by side
_ASKEW_DEG = (0.1, 2.0)  # what is seen on paper: 2 mm on a metre; and what is meant to be oblique
_ON_M = 0.01
_SWING_M = 0.1  # a leaf is hinged in its wall's side, and frames stand in its way
_WALLS = {"wall", "poche", "post", "perhaps", "inferred", "low", "assumed", "column"}
_TABLES = ("faces", "walls", "openings", "rooms", "free", "furniture", "confidence")


def bench(results: Path, names: Sequence[str], settings: Settings) -> None:
    """Print the counts of each survey's sheets, as measured and regular, and their sums.

    Parameters
    ----------
    results : Path
        Folder of results, with plans.
    names : sequence of str
        Surveys; all that have a plan where none is named.
    settings : dict
        Default settings.
    """
    export = settings["plan"]["export"]
    sizes = catalogue_file.read_catalogue(export["catalogue"])
    drafting = make_draft_settings(export["max_change_m"], sizes)
    sums = np.zeros((2, len(LIST)), int)
    for name in names or sorted(p.parts[-3] for p in results.glob("*/plan/free.parquet")):
        files = {table: results / name / f"plan/{table}.parquet" for table in _TABLES}
        plan = floorplan_files.read_floorplan(files, name)
        regular, drafted = draft_plan(plan, drafting)
        both = (
            count_redrawn(plan, compose_sheet(plan)),
            count_redrawn(regular, compose_presentation(plan, regular, drafted)),
        )
        sums += [[*counts.values()] for counts in both]
        print(f"{name}: {_format(both)}", flush=True)
    print(f"sum: {_format([dict(zip(LIST, row, strict=True)) for row in sums.tolist()])}")


def _format(pair: Sequence[Mapping[str, int]]) -> str:
    measured, regular = pair
    counts = [f"{kind} {measured[kind]} -> {regular[kind]}" for kind in LIST]
    return f"{', '.join(counts)}; all {sum(measured.values())} -> {sum(regular.values())}"


def count_redrawn(plan: FloorPlan, sheet: Sheet) -> dict[str, int]:
    """Return how much there is of each kind of `LIST` on the sheet of a plan."""
    lines_m = floorplan.centrelines_m(plan.walls)[~plan.wall_shapes.is_bent]
    bodies = plan.bodies[~plan.wall_shapes.is_bent]
    lengths_m = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T)
    gaps_m = _measure_gaps(lines_m, bodies, plan.bodies)
    counts = {
        "double": _count_doubles(lines_m, bodies),
        "nearly met": int(((gaps_m > _TOUCHING_M) & (gaps_m < _NEARLY_M)).sum()),
        "askew": _count_askew(lines_m, plan.main_direction_deg),
        "scrap": int(((lengths_m < _SCRAP_M) & (gaps_m > _TOUCHING_M).any(axis=1)).sum()),
        "openings": _count_covered(sheet),
        "swing": _count_blocked(sheet),
        "label": _count_unreadable(sheet),
        "unnamed": sum(len(stamp.words) < 2 for stamp in sheet.stamps),
    }
    return {kind: counts[kind] for kind in LIST}


def _count_doubles(lines_m: FloatArray, bodies: Array) -> int:
    found = 0
    ways_m = lines_m[:, 1] - lines_m[:, 0]
    lengths_m = np.hypot(*ways_m.T)
    ways = ways_m / lengths_m[:, None]
    near = shapely.STRtree(bodies).query(bodies, "dwithin", _DOUBLE_M).T
    for one, other in near[near[:, 0] < near[:, 1]].tolist():
        if abs(ways[one] @ ways[other]) < np.cos(np.radians(_ALONG_DEG)):
            continue
        short, long = sorted((one, other), key=lambda wall: lengths_m[wall])
        along_m = np.sort((lines_m[short] - lines_m[long, 0]) @ ways[long])
        common_m = min(along_m[1], lengths_m[long]) - max(along_m[0], 0.0)
        found += bool(common_m > lengths_m[short] / 2)
    return found


def _measure_gaps(lines_m: FloatArray, bodies: Array, all_bodies: Array) -> FloatArray:
    """Return how far ahead of both ends of walls (n, 2) another wall is drawn, metres.

    Infinity where none is near, 0 where they touch.
    """
    gaps_m = np.full((len(lines_m), 2), np.inf)
    tree = shapely.STRtree(all_bodies)
    for wall, (line_m, body) in enumerate(zip(lines_m, bodies, strict=True)):
        way_m = (line_m[1] - line_m[0]) / np.hypot(*(line_m[1] - line_m[0]))
        half_m = body.area / shapely.LineString(line_m).length / 2
        near = all_bodies[tree.query(body, "dwithin", _NEARLY_M)]
        others = overlays.unite_areas(near[~shapely.equals(near, body)])
        for end, sign in ((0, -1), (1, 1)):
            # from what is drawn of it at its end, mitred where it meets others
            from_m = line_m[end] - sign * way_m * CORNER_M
            ahead = shapely.LineString([from_m, line_m[end] + sign * way_m * 2 * _NEARLY_M])
            strip = ahead.buffer(half_m, cap_style="flat")
            met = others.intersection(strip)
            if not met.is_empty:
                gaps_m[wall, end] = body.intersection(strip).distance(met)
    return gaps_m


def _count_askew(lines_m: FloatArray, main_deg: float) -> int:
    way_m = lines_m[:, 1] - lines_m[:, 0]
    angles_deg = np.degrees(np.arctan2(way_m[:, 1], way_m[:, 0])) - main_deg
    off_deg = np.abs((angles_deg + 22.5) % 45 - 22.5)
    return int(((off_deg > _ASKEW_DEG[0]) & (off_deg < _ASKEW_DEG[1])).sum())


def _count_covered(sheet: Sheet) -> int:
    """Return how many pairs of openings of one way cover one another; corners are none."""
    symbols = [symbol for symbol in sheet.symbols if symbol.kind not in ("swing", "recess")]
    grounds = [
        shapely.LineString(symbol.ends_m).buffer(symbol.thickness_m / 2, cap_style="flat")
        for symbol in symbols
    ]
    ways = [(symbol.ends_m[1] - symbol.ends_m[0]) / symbol.width_m for symbol in symbols]
    found = 0
    for one, other in combinations(range(len(symbols)), 2):
        deep_m = min(symbols[one].thickness_m, symbols[other].thickness_m)
        is_along = abs(ways[one] @ ways[other]) > np.cos(np.radians(_ALONG_DEG))
        found += is_along and grounds[one].intersection(grounds[other]).area > _ON_M * deep_m
    return int(found)


def _find_walls(sheet: Sheet) -> BaseGeometry:
    """Return the ground of walls as it is drawn, map frame."""
    return overlays.unite_areas([
        shapely.Polygon(mark.paths[0][:, :2], [path[:, :2] for path in mark.paths[1:]])
        for mark in sheet.marks
        if mark.kind in _WALLS
    ])  # fmt: skip


def _count_blocked(sheet: Sheet) -> int:
    walls = _find_walls(sheet)
    ways = [
        shapely.MultiLineString([flatten(path) for path in symbol_paths(symbol)])
        for symbol in sheet.symbols
        if symbol.kind == "swing"
    ]
    return sum(way.intersection(walls).length > _SWING_M for way in ways)


def _count_unreadable(sheet: Sheet) -> int:
    """Return how many words in the plan lie on a wall, and pairs of words on one another."""
    walls = sheet.page.place_shape(_find_walls(sheet))
    n_in_plan = len([*plan_words(sheet)])
    boxes = [word_box(word) for word in paper_words(sheet)]
    on_walls = sum(bool(box.intersects(walls)) for box in boxes[:n_in_plan])
    pairs = shapely.STRtree(boxes).query(boxes, "overlaps").T
    return on_walls + int((pairs[:, 0] < pairs[:, 1]).sum())
