"""What a run has made so far, as a picture: a process that the server of its page starts.

`python -m scanplan.report.growing_plan results/NAME ASSUMED` writes JSON to its output: `svg`, and
`said`, a line for each kind of thing that is there. ASSUMED is JSON, too: `assumed_thickness_m` and
`assumed_height_m`, as sheets are drawn; the usual ones where these are not named.
"""

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.exports.svg import format_number
from scanplan.plan import floorplan, floorplan_files
from scanplan.report import point_image, top_view
from scanplan.report.chart import MARGIN_M
from scanplan.report.plan_view import plan_svg
from scanplan.store import schemas, tables
from scanplan.types import Columns, FloatArray

_PLAN = ("faces", "walls", "openings", "rooms", "free", "furniture")
_STRAY_PERCENT = 0.5  # of points at either end: single returns from far outside
Part = tuple[str, str, FloatArray]
"""A line of what is there, its elements, and places (n, 2) that are to be in the picture."""


def draw_growing_plan(
    results: Path, assumed_m: Mapping[str, float] | None = None
) -> dict[str, object]:
    """Return the picture of what is there of results.

    Parameters
    ----------
    assumed_m : mapping of str to float, optional
        What is assumed of the plan, see `floorplan.FloorPlan`.

    Returns
    -------
    dict
        `svg`, empty where nothing is there yet; `said`, a list of str.

    Raises
    ------
    StageError
        If what is there cannot be read.
    """
    steps: list[tuple[str, Callable[[Path], Iterator[Part]]]] = [
        ("scans.parquet", _draw_points),
        ("poses.parquet", _draw_way),
        ("plan/segments.parquet", _draw_segments),
        ("plan/walls.parquet", partial(_draw_plan, assumed_m=assumed_m or {})),
    ]
    parts = [part for file, draw in steps if (results / file).exists() for part in draw(results)]
    if not parts:
        return {"svg": "", "said": []}
    places_m = np.concatenate([places_m for *_, places_m in parts])
    low_m, high_m = places_m.min(axis=0) - MARGIN_M, places_m.max(axis=0) + MARGIN_M
    box = " ".join(format_number(v) for v in (low_m[0], -high_m[1], *(high_m - low_m)))
    label = "What is there of the plan"
    drawn = "\n".join(drawn for _, drawn, _ in parts)
    svg = f'<svg id="plan" viewBox="{box}" role="img" aria-label="{label}">\n{drawn}\n</svg>'
    return {"svg": svg, "said": [said for said, *_ in parts if said]}


def _draw_points(results: Path) -> Iterator[Part]:
    scans = tables.ScanStore(results / "scans.parquet")
    shown = top_view.choose_scans(scans.scan_ids)
    xy_m = top_view.sample_points(scans.scans(shown.tolist()), len(shown))
    low_m, high_m = np.percentile(xy_m, (_STRAY_PERCENT, 100 - _STRAY_PERCENT), axis=0)
    image = point_image.draw_places([xy_m], low_m, high_m)
    n_points = int(scans.n_points.sum())
    said = f"{len(scans.scan_ids):,} registered scans, {n_points:,} points"
    yield said, plan_svg.draw_image(image), np.stack([low_m, high_m])


def _draw_way(results: Path) -> Iterator[Part]:
    poses = tables.read_table(results / "poses.parquet", schemas.POSES)
    said = f"{len(poses['scan_id']):,} scans along the sensor's way"
    if (results / "registration.parquet").exists():
        found = tables.read_table(results / "registration.parquet", schemas.REGISTRATION)
        poses = {name: values[found["kept"]] for name, values in found.items()}
    way_m = _list_places(poses)
    way_m = way_m[np.isfinite(way_m).all(axis=1)]
    yield said, plan_svg.draw_path(way_m[None], 'class="way"'), way_m


def _draw_segments(results: Path) -> Iterator[Part]:
    segments = tables.read_table(results / "plan/segments.parquet", schemas.WALLS, allow_empty=True)
    scans = tables.read_table(results / "registration.parquet", schemas.REGISTRATION)
    chosen = np.isin(scans["scan_id"], segments["scan_id"])
    dots = [
        f'<circle class="chosen" cx="{format_number(x_m)}" cy="{format_number(-y_m)}" r="0.12"/>'
        for x_m, y_m in _list_places(scans)[chosen]
    ]
    yield f"{chosen.sum():,} scans that the plan is made of", "".join(dots), np.zeros((0, 2))
    lines_m = floorplan.centrelines_m(segments)
    drawn = plan_svg.draw_path(lines_m, 'class="segments"') if len(lines_m) else ""
    is_over = (results / "plan/walls.parquet").exists()
    yield f"{len(lines_m):,} pieces of walls in them", "" if is_over else drawn, np.zeros((0, 2))


def _draw_plan(results: Path, assumed_m: Mapping[str, float]) -> Iterator[Part]:
    corrected = results / "plan/corrected"
    folder = corrected if all((corrected / f"{n}.parquet").exists() for n in _PLAN) else None
    files = {name: (folder or results / "plan") / f"{name}.parquet" for name in _PLAN}
    plan = floorplan_files.read_floorplan(files, results.name, **assumed_m)
    bounds_m = np.stack(plan.bounds_m)
    drawn = [*plan_svg.draw_rooms(plan), *plan_svg.draw_finished(plan)]
    n_walls, n_rooms = len(plan.walls["wall"]), len(plan.rooms["room"])
    yield f"{n_walls} walls and {n_rooms} rooms", "\n".join(drawn), bounds_m
    yield "", "\n".join(plan_svg.draw_labels(plan)), bounds_m


def _list_places(columns: Columns) -> FloatArray:
    return np.column_stack([columns["x_m"], columns["y_m"]]).astype(float)


if __name__ == "__main__":
    try:
        sys.stdout.write(json.dumps(draw_growing_plan(Path(sys.argv[1]), json.loads(sys.argv[2]))))
    except StageError as error:
        sys.exit(str(error))
