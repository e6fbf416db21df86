"""The plan as DXF, for CAD programs."""

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import ezdxf
import numpy as np
import shapely
from ezdxf import zoom
from ezdxf.document import Drawing
from ezdxf.enums import InsertUnits, TextEntityAlignment
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace
from shapely.geometry.base import BaseGeometry

from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, FloatArray

# layers, and their likes in the AIA CAD layer guidelines (US National CAD Standard)
WALLS = "WALLS"  # A-WALL
INFERRED = "WALLS_INFERRED"  # A-WALL, too: apart, so that it can be switched off
OPENINGS = "OPENINGS"  # A-DOOR and A-GLAZ: which of them an opening is, rays do not always show
ROOMS = "ROOMS"  # A-AREA
TEXT = "TEXT"  # A-ANNO-TEXT
_VERSION = "R2010"  # AC1024, which all current CAD programs read
_LINE_TYPE = "DASHED"  # ISO 128-2's dashed line, by the name that AutoCAD has for it
_DASH_PATTERN_M = (0.15, 0.1, -0.05)  # length, dash, gap of half a dash: short beside any wall
# line weights in hundredths of a millimetre, of the series of ISO 128-2: cut walls wide, the rest
# in steps down to narrow
_CUT_WEIGHT = 35
_INFERRED_WEIGHT = 25
_OPENING_WEIGHT = 18
_NARROW_WEIGHT = 13
# colours of the AutoCAD colour index
_INK = 7  # black on paper, white on a black screen
_GREY = 8
_BLUE = 5
_GREEN = 3
_LAYERS = {
    WALLS: {"lineweight": _CUT_WEIGHT, "color": _INK},
    INFERRED: {"lineweight": _INFERRED_WEIGHT, "color": _GREY, "linetype": _LINE_TYPE},
    OPENINGS: {"lineweight": _OPENING_WEIGHT, "color": _BLUE},
    ROOMS: {"lineweight": _NARROW_WEIGHT, "color": _GREEN},
    TEXT: {"lineweight": _NARROW_WEIGHT, "color": _INK},
}
_TEXT_M = 0.2  # 2 mm at 1:100, between the 1.8 and 2.5 mm of ISO 3098
_SMALL_TEXT_M = 0.12  # fits beside a door
_LINE_SPACING = 1.5  # of a text's height, and of its middle from a line: about ISO 3098's
_UPRIGHT = 1e-6  # of a direction's x: less is rounding


def format_dxf(plan: FloorPlan) -> str:
    """Return a plan as the text of a DXF R2010 file, in metres.

    Walls of known thickness are closed outlines (double lines) with their openings cut out,
    surfaces with nothing known behind them single lines; what is inferred lies on a layer of its
    own. Every opening is a line as long as it is wide, with two more along the surfaces for a
    window in a wall of known thickness; every room is a closed outline.

    Parameters
    ----------
    plan : floorplan.FloorPlan

    Returns
    -------
    str
        The same for the same plan: no time, no random identifier.

    Raises
    ------
    ValueError
        If the drawing does not pass the audit of ezdxf.
    """
    with _fixed_metadata():
        document = _new_document()
        modelspace = document.modelspace()
        _add_walls(modelspace, plan)
        _add_openings(modelspace, plan)
        _add_rooms(modelspace, plan)
        zoom.extents(modelspace)
        _check_document(document)
        # ezdxf would register these in the order of a set, which differs from run to run
        for name in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(name)
        text = io.StringIO()
        document.write(text)
    return text.getvalue()


def _new_document() -> Drawing:
    document = new(_VERSION, units=InsertUnits.Meters)
    document.linetypes.add(_LINE_TYPE, pattern=list(_DASH_PATTERN_M), description="Dashed __ __ __")
    for name, properties in _LAYERS.items():
        document.layers.add(name, **properties)
    return document


def _add_walls(modelspace: Modelspace, plan: FloorPlan) -> None:
    for state, layer in zip(floorplan.STATES, (WALLS, INFERRED), strict=True):
        _add_outlines(modelspace, shapely.get_parts(plan.solid(state)), layer)
        for line in plan.single(state):
            _add_line(modelspace, shapely.get_coordinates(line), layer)


def _add_outlines(
    modelspace: Modelspace, polygons: Array | Sequence[BaseGeometry], layer: str
) -> None:
    if len(polygons) == 0:
        return
    for ring in shapely.get_rings(np.asarray(polygons, object)):
        corners_m = shapely.get_coordinates(ring)[:-1].tolist()
        modelspace.add_lwpolyline(corners_m, close=True, dxfattribs={"layer": layer})


def _add_line(modelspace: Modelspace, ends_m: FloatArray, layer: str) -> None:
    start_m, end_m = ends_m.tolist()
    modelspace.add_line(start_m, end_m, dxfattribs={"layer": layer})


def _add_openings(modelspace: Modelspace, plan: FloorPlan) -> None:
    columns = plan.openings
    for row, line in enumerate(floorplan.centrelines_m(columns)):
        modelspace.add_lwpolyline(line.tolist(), dxfattribs={"layer": OPENINGS})
        along = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
        left = np.array([-along[1], along[0]])
        half_m = columns["thickness_m"][row] / 2
        if columns["type"][row] == "window" and np.isfinite(half_m):
            for side_m in (-half_m, half_m):
                _add_line(modelspace, line + side_m * left, OPENINGS)
        _add_width(modelspace, line.mean(axis=0), along, columns["width_m"][row])


def _add_width(
    modelspace: Modelspace, place_m: FloatArray, along: FloatArray, width_m: float
) -> None:
    """Write an opening's width beside it, along it, to be read from below or from the right."""
    is_leftward = along[0] < -_UPRIGHT
    is_downward = along[0] <= _UPRIGHT and along[1] < 0
    if is_leftward or is_downward:
        along = -along
    beside_m = place_m + _LINE_SPACING * _SMALL_TEXT_M * np.array([-along[1], along[0]])
    turn_deg = np.degrees(np.arctan2(along[1], along[0]))
    _add_text(modelspace, f"{width_m:.2f}", beside_m.tolist(), _SMALL_TEXT_M, turn_deg)


def _add_rooms(modelspace: Modelspace, plan: FloorPlan) -> None:
    _add_outlines(modelspace, plan.areas, ROOMS)
    names = ("room", "area_m2", "x_m", "y_m")
    columns = [plan.rooms[name].tolist() for name in names]
    for room, area_m2, x_m, y_m in zip(*columns, strict=True):
        _add_text(modelspace, f"Room {room}", (x_m, y_m), _TEXT_M)
        below_m = y_m - _LINE_SPACING * _TEXT_M
        _add_text(modelspace, f"{area_m2:.1f} m2", (x_m, below_m), _TEXT_M)


def _add_text(
    modelspace: Modelspace,
    words: str,
    middle_m: Sequence[float],
    height_m: float,
    turn_deg: float | None = None,
) -> None:
    text = modelspace.add_text(words, height=height_m, dxfattribs={"layer": TEXT})
    if turn_deg is not None:
        text.dxf.rotation = turn_deg
    text.set_placement(middle_m, align=TextEntityAlignment.MIDDLE_CENTER)


def _check_document(document: Drawing) -> None:
    faults = document.audit().errors
    if faults:
        raise ValueError(f"the drawing has {len(faults)} faults, the first: {faults[0].message}")


@contextmanager
def _fixed_metadata() -> Iterator[None]:
    # ezdxf documents its options under this name, but does not declare it
    options = ezdxf.options  # pyright: ignore[reportPrivateImportUsage]
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
