"""Walls of a drawing whose sides were moved, and not their lines: what two sides enclose.

Sheets draw walls as outlines that run around several of them; whoever stretches one in a CAD
program moves corners of these. Both files are read as designs are, and what of one is not in the
other is what was changed.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan.design.drawn_storey import DrawnWall
from scanplan.design.dxf_design import draw_storey
from scanplan.design.layer_words import KINDS
from scanplan.edited.differences import NEAR_M, TOUCHED_M, align
from scanplan.edited.elements import Drawing, Element
from scanplan.types import FloatArray

_COSINE = 0.996  # of 5 degrees: between a strip and its wall
_END_M = 0.3  # from the end of a wall to that of its strip: half of what it ends at
_LEAST_SHARE = 0.5  # of a wall's length that is gone, of one that was taken out


@dataclass
class _Sides:
    """What became of the sides of walls: where each is now, those gone and new, and the rest."""

    moved: dict[str, Element]
    gone: set[str]
    new: list[Element]
    n_other: int = 0


def follow_sides(
    base: Drawing, edited: Drawing, sides_m: tuple[Sequence[FloatArray], Sequence[FloatArray]]
) -> Drawing:
    """Return an edited drawing with its walls where their sides are.

    Parameters
    ----------
    base, edited : Drawing
        What walls' lines say; of walls whose lines were moved these hold.
    sides_m : (sequence of (n, 2) float, sequence of (n, 2) float)
        Outlines in both, see `dxf_reading.list_sides`.
    """
    before, after = (_find_strips(paths) for paths in sides_m)
    left = [strip for strip in before if not any(_is_same(strip, other) for other in after)]
    fresh = [strip for strip in after if not any(_is_same(strip, other) for other in before)]
    if not left and not fresh:
        return edited
    known = {wall.key: wall for wall in base.of("wall") if not wall.is_bent}
    now = {wall.key: wall for wall in edited.of("wall")}
    found = _Sides({}, set(), [])
    for strip in left:
        wall = _find_wall(strip, list(known.values()))
        pair = min(
            (other for other in fresh if _is_beside(strip, other)),
            key=lambda other: _apart_m(strip, other),
            default=None,
        )
        if pair is not None:
            fresh.remove(pair)
        if wall is None or wall.key not in now or _has_moved(wall, now[wall.key]):
            found.n_other += 1
        elif pair is not None:
            found.moved[wall.key] = _move(wall, strip, pair)
        elif _length_m(strip.line_m) >= _LEAST_SHARE * wall.length_m:
            found.gone.add(wall.key)
        else:
            found.n_other += 1
    for number, strip in enumerate(fresh):
        facts = {"thickness_m": float(strip.thickness_m)}
        found.new.append(Element("wall", f"sides {number}", strip.line_m, facts=facts))
    kept = [
        found.moved.get(element.key, element) if element.kind == "wall" else element
        for element in edited.elements
        if not (element.kind == "wall" and element.key in found.gone)
    ]
    other = dict(edited.other)
    other |= {"sides of walls": found.n_other} if found.n_other else {}
    return Drawing([*kept, *found.new], other, edited.survey)


def _find_strips(paths: Sequence[FloatArray]) -> list[DrawnWall]:
    lines = {kind: np.array([], object) for kind in KINDS}
    lines["wall"] = np.array([shapely.LineString(path) for path in paths], object)
    return list(draw_storey(lines).walls) if len(paths) else []


def _is_same(strip: DrawnWall, other: DrawnWall) -> bool:
    off_m = np.abs(align(other.line_m, strip.line_m) - strip.line_m).max()
    return bool(off_m <= TOUCHED_M and abs(other.thickness_m - strip.thickness_m) <= TOUCHED_M)


def _is_beside(strip: DrawnWall, other: DrawnWall) -> bool:
    is_parallel = abs(float(_along(strip.line_m) @ _along(other.line_m))) > _COSINE
    return is_parallel and _apart_m(strip, other) <= NEAR_M


def _apart_m(strip: DrawnWall, other: DrawnWall) -> float:
    lines = [shapely.LineString(of.line_m) for of in (strip, other)]
    middles = [line.interpolate(0.5, normalized=True) for line in lines]
    return min(lines[0].distance(middles[1]), lines[1].distance(middles[0]))


def _find_wall(strip: DrawnWall, walls: Sequence[Element]) -> Element | None:
    middle = shapely.Point(strip.line_m.mean(axis=0))
    beside = [
        (shapely.LineString(wall.line_m).distance(middle), row)
        for row, wall in enumerate(walls)
        if abs(float(wall.along @ _along(strip.line_m))) > _COSINE
    ]
    far_m, row = min(beside, default=(np.inf, -1))
    return walls[row] if far_m <= NEAR_M else None


def _has_moved(wall: Element, now: Element) -> bool:
    assert wall.line_m is not None and now.line_m is not None
    return bool(np.abs(align(now.line_m, wall.line_m) - wall.line_m).max() > TOUCHED_M)


def _move(wall: Element, strip: DrawnWall, to: DrawnWall) -> Element:
    """Return a wall moved across as its strip was, its ends along as those near to them were."""
    assert wall.line_m is not None
    along = wall.along
    normal = np.array([-along[1], along[0]])
    before_m, after_m = (align(of.line_m, wall.line_m) for of in (strip, to))
    across_m = float(((after_m - before_m) @ normal).mean())
    by_m = (after_m - before_m) @ along
    is_end = np.abs((before_m - wall.line_m) @ along) <= _END_M
    line_m = wall.line_m + across_m * normal + np.where(is_end, by_m, 0.0)[:, None] * along
    is_thicker = abs(to.thickness_m - strip.thickness_m) > TOUCHED_M
    facts = {"thickness_m": float(to.thickness_m)} if is_thicker else {}
    return replace(wall, line_m=line_m, facts=dict(wall.facts) | facts)


def _along(line_m: FloatArray) -> FloatArray:
    return (line_m[1] - line_m[0]) / _length_m(line_m)


def _length_m(line_m: FloatArray) -> float:
    return float(np.hypot(*(line_m[1] - line_m[0])))
