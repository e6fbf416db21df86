"""The plan as DXF, for CAD programs."""

import io
from contextlib import contextmanager

import ezdxf
import numpy as np
import shapely
from ezdxf import units, zoom
from ezdxf.enums import TextEntityAlignment

from scanplan.plan import floorplan

WALLS, INFERRED, OPENINGS, ROOMS, TEXT = "WALLS", "WALLS_INFERRED", "OPENINGS", "ROOMS", "TEXT"
# line weights in hundredths of a millimetre, colours of the AutoCAD index
_LAYERS = {
    WALLS: {"lineweight": 35, "color": 7},
    INFERRED: {"lineweight": 25, "color": 8, "linetype": "DASHED"},
    OPENINGS: {"lineweight": 18, "color": 5},
    ROOMS: {"lineweight": 13, "color": 3},
    TEXT: {"lineweight": 13, "color": 7},
}
_DASH_M = (0.15, 0.1, -0.05)
_TEXT_M = 0.2
_SMALL_TEXT_M = 0.12


def format_dxf(plan):
    """Return a plan as the text of a DXF R2010 file, in metres.

    Walls of known thickness are closed outlines (double lines) with their openings cut out, surfaces with nothing known
    behind them single lines; what is inferred lies on a layer of its own. Every opening is a line as long as it is
    wide, with two more along the surfaces for a window in a wall of known thickness; every room is a closed outline.

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
        document = ezdxf.new("R2010", units=units.M)
        document.linetypes.add(
            "DASHED", pattern=[_DASH_M[0], *_DASH_M[1:]], description="Dashed __ __ __"
        )
        for name, properties in _LAYERS.items():
            document.layers.add(name, **properties)
        modelspace = document.modelspace()
        for state, layer in zip(floorplan.STATES, (WALLS, INFERRED), strict=True):
            _outlines(modelspace, shapely.get_parts(plan.solid(state)), layer)
            for line in plan.single(state):
                modelspace.add_line(
                    *shapely.get_coordinates(line).tolist(), dxfattribs={"layer": layer}
                )
        _add_openings(modelspace, plan)
        _add_rooms(modelspace, plan)
        zoom.extents(modelspace)
        _audit(document)
        # ezdxf would register these in the order of a set, which differs from run to run
        for name in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(name)
        text = io.StringIO()
        document.write(text)
    return text.getvalue()


def _outlines(modelspace, polygons, layer):
    for ring in shapely.get_rings(np.asarray(polygons, object)) if len(polygons) else ():
        modelspace.add_lwpolyline(
            shapely.get_coordinates(ring)[:-1].tolist(), close=True, dxfattribs={"layer": layer}
        )


def _add_openings(modelspace, plan):
    columns = (plan.openings[c].tolist() for c in ("type", "width_m", "thickness_m"))
    for kind, width_m, thick_m, line in zip(
        *columns, floorplan.centrelines_m(plan.openings), strict=True
    ):
        modelspace.add_lwpolyline(line.tolist(), dxfattribs={"layer": OPENINGS})
        along = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
        left = np.array([-along[1], along[0]])
        if kind == "window" and np.isfinite(thick_m):
            for side_m in (-thick_m / 2, thick_m / 2):
                modelspace.add_line(
                    *(line + side_m * left).tolist(), dxfattribs={"layer": OPENINGS}
                )
        _add_width(modelspace, line.mean(axis=0), along, width_m)


def _add_width(modelspace, place_m, along, width_m):
    """Write an opening's width beside it, along it, to be read from below or from the right."""
    if along[0] < -1e-6 or (along[0] <= 1e-6 and along[1] < 0):
        along = -along
    beside_m = place_m + 1.5 * _SMALL_TEXT_M * np.array([-along[1], along[0]])
    text = modelspace.add_text(f"{width_m:.2f}", height=_SMALL_TEXT_M, dxfattribs={"layer": TEXT})
    text.dxf.rotation = np.degrees(np.arctan2(along[1], along[0]))
    text.set_placement(beside_m.tolist(), align=TextEntityAlignment.MIDDLE_CENTER)


def _add_rooms(modelspace, plan):
    _outlines(modelspace, plan.areas, ROOMS)
    for room, area_m2, x_m, y_m in zip(
        *(plan.rooms[c].tolist() for c in ("room", "area_m2", "x_m", "y_m")), strict=True
    ):
        for row, said in enumerate((f"Room {room}", f"{area_m2:.1f} m2")):
            text = modelspace.add_text(said, height=_TEXT_M, dxfattribs={"layer": TEXT})
            text.set_placement(
                (x_m, y_m - 1.5 * row * _TEXT_M), align=TextEntityAlignment.MIDDLE_CENTER
            )


def _audit(document):
    faults = document.audit().errors
    if faults:
        raise ValueError(f"the drawing has {len(faults)} faults, the first: {faults[0].message}")


@contextmanager
def _fixed_metadata():
    kept = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = kept
