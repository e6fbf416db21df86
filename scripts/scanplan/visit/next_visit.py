"""Questions, standpoints and order of a second visit."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely

from scanplan.geometry import overlays, roadmap, tour
from scanplan.geometry.roadmap import RoadmapGrid
from scanplan.geometry.stop_ways import StopWays
from scanplan.plan.floorplan import FloorPlan
from scanplan.rays.tolerances import STRAY_SHARE
from scanplan.types import Array, Columns, FloatArray, IntArray
from scanplan.visit import questions, sight, standpoints
from scanplan.visit.questions import Pieces, Question
from scanplan.visit.sensor_reach import SensorReach
from scanplan.visit.sight import Views


@dataclass(frozen=True)
class VisitSettings:
    """Where a sensor may stand.

    Attributes
    ----------
    clearance_m : float, > 0
        What it keeps from walls, furniture and floor that was not seen.
    spacing_m : float, > 0
        How far apart the places are that are tried.
    """

    clearance_m: float
    spacing_m: float


@dataclass(frozen=True, eq=False)
class NextVisit:
    """Questions of a second visit, and its standpoints.

    Attributes
    ----------
    questions, standpoints : dict of str to (n,) array
        The columns of `schemas.QUESTIONS` and `STANDPOINTS`; there may be none of either.
    """

    questions: Columns
    standpoints: Columns


@dataclass(frozen=True, eq=False)
class _Stops:
    """The chosen places in visiting order, and the ways to them.

    Attributes
    ----------
    view : (k,) int64
        Index of each among the views.
    ways_m : list of k (n, 2) float64
        Corners of the way to each from the one before, to the first from the start; none where
        they are one place.
    """

    view: IntArray
    ways_m: list[FloatArray]


def plan_visit(
    plan: FloorPlan, track_m: FloatArray, reach: SensorReach, settings: VisitSettings
) -> NextVisit:
    """Plan a second visit that settles what a plan leaves open.

    The fewest standpoints are a set cover, chosen greedily: as many questions as possible with
    each. Their order is a short tour over free floor, from where the survey began.

    Parameters
    ----------
    plan : FloorPlan
        Read with its confidence.
    track_m : (n, 2) float64, n >= 1
        Where scans were taken, in the order of time, map frame.
    """
    asked = questions.list_questions(plan, track_m)
    pieces = questions.cut_questions(asked)
    grid = standpoints.find_ground(plan, track_m, settings.clearance_m)
    cells = standpoints.spread_cells(grid, settings.spacing_m)
    views = sight.turn_views(grid.xy_m[cells], reach)
    blocked = sight.block_sight(plan, reach.height_m)
    of_view = sight.find_seen(views, pieces, blocked, reach)
    chosen = standpoints.choose_views(of_view, pieces)
    stops = _order_stops(grid, views, chosen, track_m[0])
    shown = [of_view[view] for view in stops.view.tolist()]
    seeable, known = (_shares_shown(of_views, pieces, len(asked)) for of_views in (of_view, shown))
    best = _find_best(shown, pieces, len(asked))
    standpoint = np.where(known > STRAY_SHARE, best, -1)
    return NextVisit(
        _question_columns(asked, pieces, seeable, known, standpoint),
        _standpoint_columns(views, stops, standpoint),
    )


def summarise_visit(visit: NextVisit) -> str:
    """Return what a second visit is for, in words."""
    standpoint = visit.questions["standpoint"]
    if len(standpoint) == 0:
        return "nothing of the plan is unseen or doubtful"
    n_stops, n_seen = len(visit.standpoints["standpoint"]), int((standpoint > 0).sum())
    places = f"{n_stops} standpoint{'s' if n_stops != 1 else ''}"
    unseen = len(standpoint) - n_seen
    rest = f"; {unseen} cannot be seen from any reachable place" if unseen else ""
    n_left = int((visit.questions["needs_person"] & (standpoint > 0)).sum())
    if n_left:
        rest += f"; a person has to look at {n_left}, which scans do not settle"
    way_m = visit.standpoints["way_m"].sum()
    verb = "shows" if n_stops == 1 else "show"
    return (
        f"{places} along {way_m:.0f} m {verb} {n_seen} of {len(standpoint)} unseen or doubtful"
        f" elements{rest}"
    )


def _order_stops(grid: RoadmapGrid, views: Views, chosen: list[int], start_m: FloatArray) -> _Stops:
    """Return the chosen views in the order of a short tour from a place."""
    if not chosen:
        return _Stops(np.empty(0, np.int64), [])
    places_m = [start_m.tolist(), *views.place_m[chosen].tolist()]
    paths = StopWays(grid, np.array([roadmap.nearest_cell(grid, place) for place in places_m]))
    order = tour.shortest_tour(paths, closed=False, first=0)
    ways_m = []
    for before, after in pairwise(order):
        cells = paths.trace(before, after)
        # to look another way from where it stands a sensor goes none
        corners_m = grid.xy_m[cells if len(cells) > 1 else cells[:0]]
        straight = overlays.simplify_shapes(shapely.linestrings(corners_m), 0)
        ways_m.append(shapely.get_coordinates(straight))
    return _Stops(np.array([chosen[i - 1] for i in order[1:]], np.int64), ways_m)


def _shares_shown(
    pieces_of_view: Sequence[IntArray], pieces: Pieces, n_questions: int
) -> FloatArray:
    """Return the share of each question (q,) whose pieces any view sees."""
    piece = np.unique(np.concatenate([np.empty(0, np.int64), *pieces_of_view]))
    shares = np.bincount(pieces.question[piece], pieces.share[piece], n_questions)
    return shares.astype(float)


def _find_best(pieces_of_view: Sequence[IntArray], pieces: Pieces, n_questions: int) -> IntArray:
    """Return which view, from 1, shows most of each question (q,); 0 where there is none."""
    best, most = np.zeros(n_questions, np.int64), np.full(n_questions, -1.0)
    for number, of_view in enumerate(pieces_of_view, 1):
        share = _shares_shown([of_view], pieces, n_questions)
        best[share > most] = number
        most = np.maximum(most, share)
    return best


def _question_columns(
    asked: list[Question],
    pieces: Pieces,
    seeable: FloatArray,
    known: FloatArray,
    standpoint: IntArray,
) -> Columns:
    shapes: Array = np.array([shapely.multilinestrings(a.lines_m) for a in asked], object)
    x_m, y_m = shapely.get_coordinates(shapely.centroid(shapes)).reshape(-1, 2).T
    columns = {
        "kind": np.array([a.kind for a in asked], object),
        "number": np.array([a.number for a in asked], np.int32),
        "doubt": np.array([a.doubt for a in asked], object),
        "needs_person": np.array([a.needs_person for a in asked], bool),
        "x_m": x_m,
        "y_m": y_m,
        "seeable": seeable,
        "seen": known,
        "standpoint": standpoint.astype(np.int32),
        "geometry": shapely.to_wkb(shapes),
    }
    order = np.lexsort((columns["number"], columns["kind"].astype(str)))
    return {name: values[order] for name, values in columns.items()}


def _standpoint_columns(views: Views, stops: _Stops, standpoint: IntArray) -> Columns:
    place_m = views.place_m[stops.view]
    shapes: Array = np.array([shapely.linestrings(way_m) for way_m in stops.ways_m], object)
    number = np.arange(1, len(place_m) + 1)
    return {
        "standpoint": number.astype(np.int32),
        "x_m": place_m[:, 0],
        "y_m": place_m[:, 1],
        "heading_deg": np.degrees(views.heading_rad[stops.view]),
        "way_m": shapely.length(shapes).astype(float),
        "n_questions": (standpoint[:, None] == number).sum(axis=0).astype(np.int32),
        "geometry": shapely.to_wkb(shapes),
    }
