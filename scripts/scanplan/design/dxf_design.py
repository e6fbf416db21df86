"""The storey of a design in DXF: what lies on layers that are named as walls, doors and so on are.

A wall is what two lines enclose, no thicker than walls are; where it is interrupted on one line
lies an opening, whose kind is that of the layer of what is drawn in it. Heights are not drawn.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely
from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.insert import Insert
from ezdxf.entities.polygon import DXFPolygon
from ezdxf.enums import InsertUnits
from ezdxf.filemanagement import readfile
from ezdxf.lldxf.const import DXFError
from ezdxf.path import from_hatch, make_path
from ezdxf.units import conversion_factor
from shapely.geometry.base import BaseGeometry

from scanplan.design.curved_ground import CurvedGround, find_curved_ground
from scanplan.design.drawn_storey import (
    DrawnColumn,
    DrawnOpening,
    DrawnSpace,
    DrawnStorey,
    DrawnWall,
    Solid,
)
from scanplan.design.layer_words import KINDS, kind_of_layer
from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals
from scanplan.types import Array, FilePath, FloatArray, IntArray

_HEIGHTS_M = {"door": (0.0, 2.0), "passage": (0.0, 2.0), "window": (0.9, 2.0)}
"""ASSUME sills and lintels, which a plan does not show."""
_HEIGHT_M = 2.5  # ASSUME of the storey, likewise
_THICKNESS_M = (0.03, 0.8)  # of walls: from a partition of glass to a fortress's, almost
_OPENING_M = (0.4, 6.0)  # of a gap between two walls in one line
_PASSAGE_M = 1.6  # a wider gap in which nothing is drawn parts two walls
_APART_DEG = 1.0  # two sides of one wall
_COSINE, _SINE = math.cos(math.radians(_APART_DEG)), math.sin(math.radians(_APART_DEG))
_IN_LINE_M = 0.02  # of walls on one line
_COVERED = 0.95  # of the ground between two sides that is matter
_SAGITTA_M = 0.005  # of chords for arcs
_GRID_M = 1e-4  # of corners: a tenth of a millimetre
_BESIDE_M = 0.01  # from a curved wall: what chords leave of it is no straight one
_SKIN_M = 1e-3  # what lines that meet are drawn apart
_DEEPEST = 32  # blocks within one another: a door in a flat in a house is three


@dataclass(frozen=True, eq=False)
class _Strip:
    """A straight piece of wall: its middle line (2, 2), and its thickness."""

    line_m: FloatArray
    thickness_m: float

    @property
    def along(self) -> FloatArray:
        way_m = self.line_m[1] - self.line_m[0]
        return way_m / np.hypot(*way_m)


def read_storeys(path: FilePath) -> list[DrawnStorey]:
    """Read the plan in the model space of a DXF file.

    Raises
    ------
    StageError
        If it is damaged, states no unit, or shows no wall.
    """
    try:
        document = readfile(path)
        if document.units not in [*InsertUnits][1:]:
            fault = f"states no unit ($INSUNITS is {document.units})"
            raise StageError(f"{path}: {fault}; export it in metres")
        scale_m = conversion_factor(InsertUnits(document.units), InsertUnits.Meters)
        drawn = {kind: [] for kind in KINDS}
        for entity in document.modelspace():
            kind = kind_of_layer(entity.dxf.layer)
            if kind is not None:
                drawn[kind] += _trace(entity, scale_m)
    except (OSError, DXFError, ValueError, ArithmeticError) as error:
        fault = f"cannot be read as DXF ({str(error).strip()[:120]})"
        raise StageError(f"{path}: {fault}; export it again") from None
    storey = draw_storey({kind: np.array(lines, object) for kind, lines in drawn.items()})
    if not storey.walls:
        fault = "shows no wall on a layer named after walls, drawn by both sides"
        raise StageError(f"{path}: {fault} (such as A-WALL, Wand); name its layers so")
    return [storey]


def draw_storey(lines: dict[str, Array]) -> DrawnStorey:
    """Return a storey of what is drawn of each kind, LineStrings in metres."""
    cells = shapely.get_parts(overlays.enclose_areas([overlays.unite_lines(lines["wall"])]))
    is_thin = np.array([_is_thin(cell) for cell in cells], bool)
    built = overlays.unite_areas(cells[is_thin], grid=_GRID_M)
    curved = find_curved_ground(built)
    bent = overlays.buffer_shapes(overlays.unite_areas([of.ground for of in curved]), _BESIDE_M)
    straight = overlays.subtract_areas(built, bent) if curved else built
    strips = sorted(_find_strips(straight), key=lambda of: of.line_m.ravel().tolist())
    walls, gaps = _join(strips, built, lines)
    drawn = [_wall(number, strip) for number, strip in enumerate(walls)]
    drawn += [_bent_wall(number, of) for number, of in enumerate(curved, len(drawn))]
    openings = [
        DrawnOpening("", f"{kind} {n}", wall, line_m, kind, *_HEIGHTS_M[kind])
        for n, (wall, (line_m, kind)) in enumerate(gaps)
    ]
    spaces = [
        DrawnSpace("", f"room {n}", area) for n, area in enumerate(_list_areas(lines["room"]))
    ]
    columns = [
        DrawnColumn("", f"column {n}", Solid(area, 0.0, _HEIGHT_M))
        for n, area in enumerate(_list_areas(lines["column"]))
    ]
    # corners
    rest = overlays.subtract_areas(built, overlays.unite_areas([w.solid.ground for w in drawn]))
    others = [Solid(part, 0.0, _HEIGHT_M) for part in shapely.get_parts(rest)]
    return DrawnStorey("model space", 0.0, _HEIGHT_M, drawn, openings, spaces, columns, others)


def _trace(
    entity: DXFEntity, scale_m: float, within: tuple[str, ...] = ()
) -> Iterator[BaseGeometry]:
    """Yield the lines of an entity, those of a block and a hatch with it.

    `within` are the names of the blocks that it lies in.
    """
    if isinstance(entity, Insert):
        name = entity.dxf.name
        if name in within or len(within) == _DEEPEST:
            raise ValueError(f"blocks insert themselves, or too deeply: {' > '.join(within)}")
        for part in entity.virtual_entities():
            yield from _trace(part, scale_m, (*within, name))
        return
    if entity.dxftype() not in ("LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "HATCH"):
        return
    made = from_hatch(entity) if isinstance(entity, DXFPolygon) else [make_path(entity)]
    for path in made:
        corners = [(v.x * scale_m, v.y * scale_m) for v in path.flattening(_SAGITTA_M / scale_m)]
        if len(corners) > 1:
            yield shapely.LineString(corners)


def _is_thin(cell: BaseGeometry) -> bool:
    return overlays.buffer_shapes(cell, -_THICKNESS_M[1] / 2).is_empty


def _list_areas(lines: Array) -> list[shapely.Polygon]:
    closed = [line for line in lines if line.is_ring]
    return [shapely.Polygon(ring) for ring in closed]


def _find_strips(built: BaseGeometry) -> Iterator[_Strip]:
    """Yield the ground between two sides back to back, longer than thick."""
    sides = [
        np.array(side)
        for part in shapely.get_parts(shapely.orient_polygons(built))
        for ring in shapely.get_rings(part)
        for side in pairwise(shapely.get_coordinates(overlays.simplify_shapes(ring, _GRID_M)))
    ]
    for row, other in _list_near(sides):
        strip = _between(sides[row], sides[other])
        if strip is None:
            continue
        ground = overlays.buffer_shapes(
            shapely.LineString(strip.line_m), strip.thickness_m / 2, cap_style="flat"
        )
        if overlays.intersect_areas(ground, built).area >= _COVERED * ground.area:
            yield strip


def _list_near(sides: Sequence[FloatArray]) -> IntArray:
    """Return the pairs (n, 2) of sides that may be of one wall, each once."""
    lines = np.array([shapely.LineString(side) for side in sides], object)
    # sides that are not quite parallel are farther apart at one end
    reach_m = _THICKNESS_M[1] + shapely.length(lines) * _SINE
    pairs = shapely.STRtree(lines).query(lines, "dwithin", reach_m).T
    return np.unique(np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1), axis=0)


def _between(side: FloatArray, other: FloatArray) -> _Strip | None:
    """Return the strip between two sides, matter on the left of both; None of others."""
    length_m, other_m = np.hypot(*(side[1] - side[0])), np.hypot(*(other[1] - other[0]))
    if min(length_m, other_m) < _THICKNESS_M[0]:
        return None
    along, normal = (side[1] - side[0]) / length_m, left_normals(side[None])[0]
    if float(along @ (other[1] - other[0])) / other_m > -_COSINE:
        return None
    thickness_m = float((other.mean(axis=0) - side[0]) @ normal)
    low_m = max(0.0, float((other[1] - side[0]) @ along))
    high_m = min(float(length_m), float((other[0] - side[0]) @ along))
    is_wall = _THICKNESS_M[0] <= thickness_m <= _THICKNESS_M[1]
    if not is_wall or high_m - low_m < thickness_m:
        return None
    middle_m = side[0] + thickness_m / 2 * normal
    return _Strip(middle_m + np.array([[low_m], [high_m]]) * along, thickness_m)


_Gap = tuple[FloatArray, str]
"""The line (2, 2) of an opening, and its kind."""


def _join(
    strips: Sequence[_Strip], built: BaseGeometry, lines: dict[str, Array]
) -> tuple[list[_Strip], list[tuple[int, _Gap]]]:
    """Return walls of strips in one line, and the openings between these by the rows of walls."""
    walls: list[_Strip] = []
    gaps: list[tuple[int, _Gap]] = []
    left = list(strips)
    while left:
        wall = left.pop(0)
        while (found := _find_next(wall, left, built, lines)) is not None:
            row, between = found
            gaps += [(len(walls), gap) for gap in between]
            places_m = np.concatenate([wall.line_m, left.pop(row).line_m])
            far = np.argsort((places_m - wall.line_m[0]) @ wall.along)
            wall = replace(wall, line_m=places_m[far[[0, -1]]])
        walls.append(wall)
    return walls, gaps


def _find_next(
    wall: _Strip, others: Sequence[_Strip], built: BaseGeometry, lines: dict[str, Array]
) -> tuple[int, list[_Gap]] | None:
    """Return which other strip goes on with a wall, and the openings between both."""
    if not others:
        return None
    normal = left_normals(wall.line_m[None])[0]
    lines_m = np.array([other.line_m for other in others])
    off_m = np.abs((lines_m - wall.line_m[0]) @ normal).max(axis=1)
    thicker_m = np.abs(np.array([other.thickness_m for other in others]) - wall.thickness_m)
    for row in np.flatnonzero((off_m <= _IN_LINE_M) & (thicker_m <= _IN_LINE_M)).tolist():
        places_m = np.sort((lines_m[row] - wall.line_m[0]) @ wall.along)
        length_m = float((wall.line_m[1] - wall.line_m[0]) @ wall.along)
        low_m, high_m = (length_m, places_m[0]) if places_m[0] > 0 else (places_m[1], 0.0)
        if high_m - low_m > _OPENING_M[1]:
            continue
        line_m = wall.line_m[0] + np.array([[low_m], [high_m]]) * wall.along
        between = _list_gaps(line_m, wall.thickness_m, built, lines)
        if between is not None:
            return row, between
    return None


def _list_gaps(
    line_m: FloatArray, thickness_m: float, built: BaseGeometry, lines: dict[str, Array]
) -> list[_Gap] | None:
    """Return the openings along a line between two walls; None where one is none."""
    open_parts = shapely.get_parts(overlays.subtract_lines(shapely.LineString(line_m), built))
    gaps: list[_Gap] = []
    for part in open_parts[shapely.length(open_parts) > _IN_LINE_M]:
        ends_m = shapely.get_coordinates(part)[[0, -1]]
        kind = _find_kind(ends_m, thickness_m, lines)
        if kind is None or part.length < _OPENING_M[0]:
            return None
        gaps.append((ends_m, kind))
    return gaps


def _find_kind(line_m: FloatArray, thickness_m: float, lines: dict[str, Array]) -> str | None:
    ground = overlays.buffer_shapes(shapely.LineString(line_m), thickness_m / 2, cap_style="flat")
    # what is drawn in it may end at its sides
    around = overlays.buffer_shapes(ground, _SKIN_M)
    for kind in ("door", "window"):
        if len(lines[kind]) and shapely.intersects(around, lines[kind]).any():
            return kind
    inner = overlays.buffer_shapes(ground, -_SKIN_M)
    is_crossed = len(lines["wall"]) and shapely.intersects(inner, lines["wall"]).any()
    width_m = np.hypot(*(line_m[1] - line_m[0]))
    return "passage" if not is_crossed and width_m <= _PASSAGE_M else None


def _wall(number: int, strip: _Strip) -> DrawnWall:
    ground = overlays.buffer_shapes(
        shapely.LineString(strip.line_m), strip.thickness_m / 2, cap_style="flat"
    )
    solid = Solid(ground, 0.0, _HEIGHT_M)
    return DrawnWall("", f"wall {number}", strip.line_m, strip.thickness_m, solid)


def _bent_wall(number: int, of: CurvedGround) -> DrawnWall:
    solid = Solid(of.ground, 0.0, _HEIGHT_M)
    return DrawnWall("", f"wall {number}", of.ends_m, of.thickness_m, solid, of.centre_m)
