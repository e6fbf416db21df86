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
from scipy import constants
from shapely.geometry.base import BaseGeometry

from scanplan.exports.drawing_style import LAYERS, STROKES, read_along
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, FloatArray

WALLS, INFERRED, OPENINGS, ROOMS, TEXT = LAYERS
_VERSION = "R2010"  # AC1024, which all current CAD programs read
_LINE_TYPE = "DASHED"  # ISO 128-2's dashed line, by the name that AutoCAD has for it
_SCALE = 100  # on paper at this scale dashes are as in the drawing
_TEXT_M = 0.2  # and letters
_LINE_SPACING = 1.5  # of a text's height, and of its middle from a line: about ISO 3098's


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
    inferred = STROKES["inferred"]
    width_m = LAYERS[inferred.layer].width_mm * constants.milli * _SCALE
    dash_m, gap_m = (width_m * part for part in inferred.dashes)
    pattern = [dash_m + gap_m, dash_m, -gap_m]
    document.linetypes.add(_LINE_TYPE, pattern=pattern, description="Dashed __ __ __")
    for name, layer in LAYERS.items():
        # line weights are hundredths of a millimetre
        made = document.layers.add(name, lineweight=round(layer.width_mm * 100), color=layer.colour)
        if name == inferred.layer:
            made.dxf.linetype = _LINE_TYPE
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
        along = read_along(line)
        left = np.array([-along[1], along[0]])
        half_m = columns["thickness_m"][row] / 2
        if columns["type"][row] == "window" and np.isfinite(half_m):
            for side_m in (-half_m, half_m):
                _add_line(modelspace, line + side_m * left, OPENINGS)
        beside_m = line.mean(axis=0) + _LINE_SPACING * _TEXT_M * left
        turn_deg = np.degrees(np.arctan2(along[1], along[0]))
        _add_text(modelspace, f"{columns['width_m'][row]:.2f}", beside_m.tolist(), turn_deg)


def _add_rooms(modelspace: Modelspace, plan: FloorPlan) -> None:
    _add_outlines(modelspace, plan.areas, ROOMS)
    names = ("room", "area_m2", "x_m", "y_m")
    columns = [plan.rooms[name].tolist() for name in names]
    for room, area_m2, x_m, y_m in zip(*columns, strict=True):
        _add_text(modelspace, f"Room {room}", (x_m, y_m))
        below_m = y_m - _LINE_SPACING * _TEXT_M
        _add_text(modelspace, f"{area_m2:.1f} m2", (x_m, below_m))


def _add_text(
    modelspace: Modelspace,
    words: str,
    middle_m: Sequence[float],
    turn_deg: float | None = None,
) -> None:
    text = modelspace.add_text(words, height=_TEXT_M, dxfattribs={"layer": TEXT})
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
