"""The regular plan: that of a survey as a draughtsman draws it, and what he changed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from scanplan.exports.drafting import moved_openings, moved_rooms, moved_walls
from scanplan.exports.drafting.adjustment import adjust_walls
from scanplan.exports.drafting.facades import find_facades, limit_backs
from scanplan.exports.drafting.joined_walls import join_walls
from scanplan.exports.drafting.loose_openings import settle_loose
from scanplan.exports.drafting.moved_walls import MovedWalls
from scanplan.exports.drafting.priors import DIRECTION, THICKNESS, THROUGH, want_regular
from scanplan.exports.drafting.scraps import leave_scraps
from scanplan.exports.drafting.square_columns import square_columns
from scanplan.exports.drafting.stubs import cut_stubs
from scanplan.exports.drafting.wall_lines import gather_lines
from scanplan.exports.sheet.openings import state_swings
from scanplan.geometry.lines import left_normals
from scanplan.plan.floorplan import FloorPlan, centrelines_m, find_stated, line_columns
from scanplan.types import Columns, FloatArray
from scanplan.validation import doubts

_DOUBTS = ("p_true", "verify", "about", "doubt", "needs_person")
MEASURED, ASSUMED, REVEALS = "measured", "assumed", "reveals"
"""Where a wall's thickness is from: its sides, nothing, or reveals behind its only side."""


@dataclass(frozen=True)
class DraftSettings:
    """How a regular plan is drawn.

    Attributes
    ----------
    tolerance_m : float
        Nothing is moved farther, nor made wider by more.
    walls_m, doors_m, windows_m : sequence of float
        Thicknesses and widths of the catalogue.
    facade_m : float
        ASSUME of an outer wall that was seen from inside only.
    """

    tolerance_m: float
    walls_m: Sequence[float]
    doors_m: Sequence[float]
    windows_m: Sequence[float]
    facade_m: float


def make_draft_settings(max_change_m: float, catalogue: Mapping[str, Any]) -> DraftSettings:
    """Return settings with the sizes of a catalogue, see `catalogue_file.read_catalogue`."""
    return DraftSettings(
        max_change_m,
        list(catalogue["walls"].values()),
        list(catalogue["doors"].values()),
        list(catalogue["windows"].values()),
        catalogue["facade_m"],
    )


@dataclass(frozen=True)
class Drafted:
    """What drafting has changed of a plan.

    Attributes
    ----------
    n_walls, n_square, n_through, n_nominal : int
        Walls, of these in a main direction, in one line with another piece, of a nominal thickness.
    moved_m, turned_deg, thickness_m, width_m : float
        The greatest of each change: of a wall's side, its direction, its thickness; of an opening.
    n_assumed, n_revealed, n_left_out : int
        Walls whose thickness is assumed, or by the depth of their reveals; short pieces of wall,
        slits, ends of walls beyond facades and panes at no room that are not drawn.
    """

    n_walls: int
    n_square: int
    n_through: int
    n_nominal: int
    moved_m: float
    turned_deg: float
    thickness_m: float
    width_m: float
    n_assumed: int
    n_revealed: int
    n_left_out: int


def draft_plan(surveyed: FloorPlan, settings: DraftSettings) -> tuple[FloorPlan, Drafted]:
    """Return a plan with regular walls, its faces, rooms and openings with them, and what changed.

    Walls have the columns `moved_m`, `turned_deg`, `thickness_changed_m`, `thickness_from` and
    `joined`, numbers of further pieces of each, openings `width_changed_m` and those of
    `state_swings`; `perhaps` says which walls may be something else, facades apart: a building has
    an outline in any case. All straight walls have a thickness; lines of those seen from one side
    are in their middle. Curved walls stay as they are: those seen from one side have no thickness,
    and their line is their face. Other doubts are left out: they stand on the sheet of what was
    measured.

    Doors open as in the surveyed plan, whose leaves would say another thing of moved walls.
    """
    whole = leave_scraps(state_swings(surveyed))
    is_facade = find_facades(whole)
    plan, n_cut = cut_stubs(whole, is_facade)
    if plan is not whole:
        is_facade = find_facades(plan)
    walls = gather_lines(plan, settings.tolerance_m)
    wanted = want_regular(walls, tuple(settings.walls_m))
    nominal_m = np.where(find_stated(plan.walls), np.nan, wanted.nominal_m)
    wanted = replace(wanted, nominal_m=nominal_m)
    adjusted = adjust_walls(walls, wanted)
    moved = moved_walls.move_walls(walls, wanted, adjusted)
    grown_m = np.where(walls.is_thick, adjusted.grown_m, 0.0)
    # facades without a reveal are as thick as the others are
    revealed_m = walls.thickness_m[walls.is_revealed]
    facade_m = float(np.median(revealed_m)) if len(revealed_m) else settings.facade_m
    facade_m = max(facade_m, plan.assumed_thickness_m)
    behind_m = np.where(is_facade, facade_m, plan.assumed_thickness_m)
    thickness_from = np.where(walls.is_thick, MEASURED, ASSUMED).astype(object)
    thickness_from[walls.is_revealed] = REVEALS
    behind_m = limit_backs(walls, behind_m)
    # of curved walls what is behind the face is drawn as on the measured sheet
    behind_m = np.where(walls.is_bent, np.nan, behind_m)
    thickness_m = np.where(walls.is_thick, walls.thickness_m + grown_m, behind_m)
    # in the middle of what is behind the face
    side = np.where(walls.is_seen_from_left, -1.0, 1.0) * ~walls.is_thick
    off_m = np.nan_to_num(side * behind_m / 2)
    middles_m = moved.lines_m + (off_m[:, None] * left_normals(moved.lines_m))[:, None]
    drawn_m = moved_walls.join_ends(walls, middles_m, thickness_m)
    turned_deg = np.degrees(_turn_between(walls.lines_m, moved.lines_m))
    changed = {
        **line_columns(drawn_m),
        "thickness_m": thickness_m,
        "moved_m": adjusted.moved_m,
        "turned_deg": turned_deg,
        "thickness_changed_m": grown_m,
        "thickness_from": thickness_from,
        "perhaps": doubts.find_of_kind(plan.walls) & ~is_facade,
    }
    in_pieces = replace(
        plan,
        walls=_leave_doubts({**plan.walls, **changed}),
        faces=_leave_doubts(_move_faces(plan, moved)),
        rooms=_leave_doubts(_move_rooms(plan, moved)),
    )
    joined, row_of = join_walls(in_pieces)
    regular = settle_loose(
        replace(
            joined,
            openings=_move_openings(joined, settings),
            furniture=square_columns(
                plan.furniture, centrelines_m(joined.walls), settings.tolerance_m
            ),
        )
    )
    kinds = [
        {row_of[wall] for prior in adjusted.held if prior.kind == kind for wall in prior.walls}
        for kind in (DIRECTION, THROUGH, THICKNESS)
    ]
    thickness_from = regular.walls["thickness_from"]
    drafted = Drafted(
        len(thickness_from),
        *map(len, kinds),
        moved_m=float(adjusted.moved_m.max(initial=0)),
        turned_deg=float(np.abs(turned_deg).max(initial=0)),
        thickness_m=float(np.abs(grown_m).max(initial=0)),
        width_m=float(np.abs(regular.openings["width_changed_m"]).max(initial=0)),
        n_assumed=int((thickness_from == ASSUMED).sum()),
        n_revealed=int((thickness_from == REVEALS).sum()),
        n_left_out=n_cut
        + (len(surveyed.walls["wall"]) - len(plan.walls["wall"]))
        + (len(surveyed.openings["opening"]) - len(regular.openings["opening"])),
    )
    return regular, drafted


def _move_openings(plan: FloorPlan, settings: DraftSettings) -> Columns:
    """Return a plan's openings in its walls' lines: those of curved walls stay."""
    openings = moved_openings.move_openings(
        plan.openings,
        np.where(np.append(plan.wall_shapes.is_bent, False)[plan.hosts], -1, plan.hosts),
        centrelines_m(plan.walls),
        {"door": settings.doors_m, "window": settings.windows_m},
        settings.tolerance_m,
    )
    thickness_m = np.append(plan.walls["thickness_m"], np.nan)[plan.hosts]
    return {**_leave_doubts(openings), "thickness_m": thickness_m}


def _move_faces(plan: FloorPlan, moved: MovedWalls) -> Columns:
    lines_m = centrelines_m(plan.faces)
    for face, wall in enumerate(plan.face_hosts.tolist()):
        if wall >= 0:
            # a reveal leads from one side to the other
            parts_m = np.split(lines_m[face], 2 if plan.reveals[face] else 1)
            lines_m[face] = np.concatenate([moved.move_points(m, wall) for m in parts_m])
    return {**plan.faces, **line_columns(lines_m)}


def _move_rooms(plan: FloorPlan, moved: MovedWalls) -> Columns:
    outlines = np.array([moved_rooms.move_outline(area, moved) for area in plan.areas], object)
    return {
        **plan.rooms,
        "area_m2": shapely.area(outlines),
        "perimeter_m": shapely.length(outlines),
        "geometry": np.asarray(shapely.to_wkb(outlines), object),
    }


def _leave_doubts(columns: Columns) -> Columns:
    return {name: values for name, values in columns.items() if name not in _DOUBTS}


def _turn_between(before_m: FloatArray, after_m: FloatArray) -> FloatArray:
    one, other = (lines_m[:, 1] - lines_m[:, 0] for lines_m in (before_m, after_m))
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    return np.arctan2(cross, np.einsum("ij,ij->i", one, other))
