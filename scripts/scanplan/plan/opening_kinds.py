"""What a gap of a wall is: wall, door, window or glass, by how likely each makes what rays show.

Each kind is a column of heights that are wall or open, its sill and lintel unknown; whether a floor
was seen in or behind it, whether a sensor went through, and what lies on both sides weigh with it.
What no kind explains decidedly better than the others is a gap that is not known.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import shapely

from scanplan.geometry.bare_parts import draw_way
from scanplan.geometry.lines import Line
from scanplan.plan.openings import CLOSED, GAP, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M, END_M, ENOUGH_RAYS
from scanplan.plan.wall_ground import BareSpan
from scanplan.rays import expected_returns
from scanplan.rays.height_profile import EYE_ROWS, ROWS_M, HeightProfile, observe_heights
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW, NEAR_FLOOR_M
from scanplan.types import FloatArray

KINDS = ("wall", "door", "window", "glass")
"""What a gap may be; a wide door is a passage."""
_WALL, _DOOR, _WINDOW, _GLASS = range(len(KINDS))
_LIKELY = {
    "rooms on both sides": np.array((1, 7, 1, 1)) / 10,
    "outside": np.array((2, 1, 6.5, 0.5)) / 10,
    "floor": np.array((0.005, 0.95, 0.005, 0.3)),
    "hidden": np.array((0.5, 0.05, 0.5, 0.1)),
    "step": np.array((0.2, 0.02, 0.5, 0.05)),
    "driven": np.array((1e-3, 0.5, 1e-3, 1e-3)),
    "leaf": np.array((1e-3, 0.2, 0.01, 0.01)),
    "as wide as a door": np.array((0.3, 0.9, 0.3, 0.3)),
}  # in offices and houses: of ten gaps how many are of each kind; how often a floor is seen in or
# behind them where rays pass low down, things stand before them, a sill is seen, a sensor passes,
# a leaf is seen to stand open, they are as wide as doors are there (wider ones may be passages)
# of one leaf; what nothing is near behind and is narrower or wider is rather a pane
_OUTER_DOOR_M = (0.8, 1.1)
_SURE = 0.8  # else it is not known what it is: one in five would be wrong


def weigh_kinds(
    profile: HeightProfile,
    *,
    is_outside: bool,
    is_driven: bool = False,
    has_leaf: bool = False,
    sill_m: float = np.nan,
    planar: bool = False,
    is_door_wide: bool = False,
) -> FloatArray:
    """Return the probability (4,) of each of `KINDS`.

    Parameters
    ----------
    profile : height_profile.HeightProfile
        Of all sides of the wall.
    is_outside : bool
        Whether there is no room on one of its sides.
    is_driven : bool
        Whether a sensor went through.
    has_leaf : bool
        Whether a leaf stands open at one of its jambs.
    sill_m : float
        As high as something was seen below the lowest rays through; NaN where nothing was.
    planar : bool
        Whether heights mean nothing: then nobody tells a window from glass, and a door from either
        by its width alone.
    is_door_wide : bool
        Whether it is neither wider nor narrower than a door there; asked of planar scans alone.
    """
    wall, is_open = (
        np.concatenate([[0.0], np.cumsum(of_rows)]) for of_rows in profile.log_likelihoods()
    )

    def pierced(low: int, high: int) -> float:
        """Return how likely the rows are if they are open from one edge to another."""
        return wall[low] + is_open[high] - is_open[low] + wall[-1] - wall[high]

    last = len(ROWS_M) - 1
    as_door = _log_mean([pierced(0, top) for top in range(EYE_ROWS.stop, last + 1)])
    first_sill = 0 if sill_m > NEAR_FLOOR_M else 1
    as_window = _log_mean(
        [
            pierced(sill, top)
            for sill in range(first_sill, EYE_ROWS.start + 1)
            for top in range(EYE_ROWS.start + 1, last + 1)
        ]
    )
    likely = np.array([wall[-1], as_door, -np.inf if planar else as_window, as_door])
    likely += np.log(_LIKELY["outside" if is_outside else "rooms on both sides"])
    if not planar:
        likely += np.log(_LIKELY["hidden"] if profile.is_hidden else 1 - _LIKELY["hidden"])
        is_low_open = profile.n_through[0] >= ENOUGH_RAYS
        if profile.n_floor >= FEW:
            likely += np.log(_LIKELY["floor"])
        elif is_low_open:
            likely += np.log(1 - _LIKELY["floor"])
        if sill_m > NEAR_FLOOR_M:
            likely += np.log(_LIKELY["step"])
    elif is_door_wide:
        likely += np.log(_LIKELY["as wide as a door"])
    if is_driven:
        likely += np.log(_LIKELY["driven"])
    if has_leaf:
        likely += np.log(_LIKELY["leaf"])
    weight = np.exp(likely - likely.max())
    return weight / weight.sum()


def choose_kind(share: FloatArray) -> str:
    """Return the one of `KINDS` that is decidedly likelier than the others (4,), or else `GAP`."""
    best = int(share.argmax())
    return KINDS[best] if share[best] >= _SURE else GAP


def _log_mean(values: Sequence[float]) -> float:
    return float(np.logaddexp.reduce(values) - np.log(len(values)))


def observe_gap(
    wall: PlanWall,
    low_m: float,
    high_m: float,
    rays: RaySet,
    band_m: float,
    deep_m: float = expected_returns.DEEP_M,
) -> HeightProfile:
    """Return what all sides of a wall show of a gap of it, by height; its jambs are left out."""
    margin_m = min(END_M, (high_m - low_m) / 4)  # of a narrow one half is left
    ends = wall.line.at(np.array([low_m + margin_m, high_m - margin_m]))
    shown = [
        observe_heights(
            *(rays, seen.line, *np.sort(seen.line.along_m(ends)).tolist()),
            band_m=band_m,
            deep_m=deep_m,
        )
        for seen in wall.lines
    ]
    return sum(shown[1:], start=shown[0])


def decide_kinds(
    walls: Sequence[PlanWall],
    rays: RaySet,
    track_m: FloatArray,
    rooms_beside: Callable[[FloatArray, PlanWall], tuple[int, int]],
    *,
    min_width_m: float,
    max_door_m: float,
    band_m: float,
    niche_m: float,
    ways_m: Sequence[FloatArray] = (),
) -> list[PlanWall]:
    """Return walls with the kinds of their gaps; what is wall after all is closed.

    A gap that was closed because no way through it was seen may be a window yet.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    rays : ray_set.RaySet
    track_m : (n, 2) float64
        Where sensors were, in the order of time.
    rooms_beside : function
        Of a place (2,) and its wall: the rooms on both sides, -1 for none.
    min_width_m, max_door_m : float
        Of an opening, of a door.
    band_m : float, > 0
        Returns this near to a face are at it.
    niche_m : float
        A gap of planar scans in which rays get no deeper, with no room behind it, may be a pause
        between cupboards as well as a door.
    ways_m : sequence of (2, 2) float64
        Gaps that leaves were seen to stand open at, from jamb to jamb.
    """
    track = draw_way(track_m, END_M)
    middles_m = np.mean([*ways_m, np.full((2, 2), np.inf)], axis=1)
    return [
        _decide(
            *(wall, rays, track, rooms_beside, min_width_m, max_door_m, band_m, niche_m, middles_m)
        )
        for wall in walls
    ]


def _decide(
    wall: PlanWall,
    rays: RaySet,
    track: shapely.Geometry,
    rooms_beside: Callable[[FloatArray, PlanWall], tuple[int, int]],
    min_width_m: float,
    max_door_m: float,
    band_m: float,
    niche_m: float,
    middles_m: FloatArray,
) -> PlanWall:
    openings: list[Opening] = []
    closed: list[Opening] = []
    for gap in [*wall.openings, *wall.closed]:
        ends_m = wall.line.at(np.array([gap.low_m, gap.high_m]))
        profile = observe_gap(wall, gap.low_m, gap.high_m, rays, band_m)
        middle_m = ends_m.mean(axis=0)
        widths_m = _OUTER_DOOR_M if profile.is_into_nothing else (min_width_m, max_door_m)
        is_outside = min(rooms_beside(middle_m, wall)) < 0
        share = weigh_kinds(
            profile,
            has_leaf=bool((np.hypot(*(middles_m - middle_m).T) <= CORNER_M).any()),
            is_outside=is_outside,
            is_driven=bool(shapely.intersects(track, shapely.linestrings(ends_m))),
            sill_m=gap.sill_m,
            planar=rays.planar,
            is_door_wide=widths_m[0] <= gap.width_m <= widths_m[1],
        )
        kind = choose_kind(share)
        if rays.planar and is_outside and kind == KINDS[_DOOR]:
            deep = observe_gap(wall, gap.low_m, gap.high_m, rays, band_m, niche_m)
            kind = kind if deep.n_through.sum() >= FEW else GAP
        is_open = gap.width_m >= min_width_m and profile.open_share >= 1 - profile.open_share
        is_known = any(gap.low_m < other.high_m and gap.high_m > other.low_m for other in openings)
        is_wall = kind == KINDS[_WALL] or (gap.state == CLOSED and (is_known or not is_open))
        # of a window they are counted above its sill
        n_lost = round(profile.n_lost) if rays.planar else 0
        decided = replace(gap, kind=kind, p_kind=float(share.max()), n_rays=gap.n_rays + n_lost)
        (closed if is_wall else openings).append(decided)
    openings, closed = (sorted(gaps, key=lambda gap: gap.low_m) for gaps in (openings, closed))
    return replace(wall, openings=openings, closed=closed)


def decide_bare_spans(
    spans: Sequence[BareSpan],
    rays: RaySet,
    track_m: FloatArray,
    rooms: Sequence[shapely.Polygon],
    *,
    max_width_m: float,
    band_m: float,
) -> list[BareSpan]:
    """Return bare spans of rooms' outlines as what rays show them to be, if they do decidedly.

    Parameters
    ----------
    spans : sequence of wall_ground.BareSpan
    rays : ray_set.RaySet
    track_m : (n, 2) float64
        Where sensors were, in the order of time.
    rooms : sequence of shapely.Polygon
    max_width_m : float
        Of a way out that nothing drove through.
    band_m : float, > 0
        Returns this near to an outline are at it.
    """
    if rays.planar:
        return list(spans)
    track = draw_way(track_m, END_M)
    decided: list[BareSpan] = []
    for span in spans:
        line = _facing_line(span.ends_m, rooms[span.room])
        low_m, high_m = np.sort(line.along_m(span.ends_m)).tolist()
        profile = observe_heights(rays, line, low_m, high_m, band_m=band_m)
        is_driven = bool(shapely.intersects(track, shapely.linestrings(span.ends_m)))
        is_outside = span.kind != GAP
        share = weigh_kinds(profile, is_outside=is_outside, is_driven=is_driven)
        if is_outside and not is_driven and high_m - low_m > max_width_m:
            # nothing but glass is open down to the floor and as wide
            share[_GLASS] += share[_DOOR]
            share[_DOOR] = 0.0
        kind = choose_kind(share)
        is_open = profile.open_share >= 1 - profile.open_share
        if is_open and kind not in (GAP, KINDS[_WALL]):
            n_rays = round(float(profile.n_through.sum()))
            span = replace(span, kind=kind, p_kind=float(share.max()), n_rays=n_rays)
        decided.append(span)
    return decided


def _facing_line(ends_m: FloatArray, room: shapely.Polygon) -> Line:
    """Return the line through two points (2, 2) with its normal towards a room."""
    along = (ends_m[1] - ends_m[0]) / np.hypot(*(ends_m[1] - ends_m[0]))
    normal = np.array([-along[1], along[0]])
    inside = room.covers(shapely.Point(ends_m.mean(axis=0) + END_M * normal))
    return Line(ends_m[0], normal if inside else -normal)
