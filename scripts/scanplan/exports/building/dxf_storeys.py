"""The plans of storeys as one DXF file, each on layers and with a layout of its own."""

import math
import re
from collections.abc import Mapping, Sequence

import numpy as np
from ezdxf.document import Drawing
from ezdxf.entities.viewport import Viewport
from ezdxf.math import Matrix44, Vec2

from scanplan.exports import dxf, dxf_document
from scanplan.exports.building.placed_storey import PlacedStorey
from scanplan.exports.dxf_document import Scale
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.lettering import clean_text
from scanplan.exports.sheet.styles import LAYERS

_NOT_IN_NAMES = r"""[<>/\\":;?*|,=`'^]"""


def format_building_dxf(
    storeys: Sequence[PlacedStorey],
    sheets: Sequence[Sheet],
    unit: str = "mm",
    layers: Mapping[str, str] | None = None,
) -> str:
    """Return the text of the building's file.

    Storeys lie above each other at their elevations; the layers of the lowest begin with `1-`, of
    the next with `2-`, and so on, so that one can be seen without the others. Each has a layout of
    its own, its sheet, which shows the layers of this storey alone.

    Parameters
    ----------
    storeys : sequence of PlacedStorey, at least one
        From the lowest up.
    sheets : sequence of Sheet
        Of the storeys, of one scale.
    unit : str
        mm or m: of the model space.
    layers : dict of str to str, optional
        Other names of layers, by ours.

    Raises
    ------
    ValueError
        If the drawing does not pass the audit of ezdxf.
    """
    scale = Scale(unit, sheets[0].page)
    with dxf_document.fix_metadata():
        document = dxf_document.open_document(unit, scale)
        for number, (storey, sheet) in enumerate(zip(storeys, sheets, strict=True), 1):
            _add_storey(document, storey, sheet, scale, number)
        document.layouts.delete("Layout1")
        _hide_others(document)
        for number in range(1, len(storeys) + 1):
            names = {
                f"{number}-{our}": f"{number}-{other}" for our, other in (layers or {}).items()
            }
            dxf_document.rename_layers(document, names)
        corners_m = [
            storey.to_building(dxf.sheet_corners_m(sheet))
            for storey, sheet in zip(storeys, sheets, strict=True)
        ]
        dxf.state_extent(document, np.concatenate(corners_m) * scale.per_m)
        return dxf_document.format_document(document)


def _add_storey(
    document: Drawing, storey: PlacedStorey, sheet: Sheet, scale: Scale, number: int
) -> None:
    """Add a storey's plan where it lies, and its layout, on layers that begin with its number."""
    if number > 1:
        dxf_document.add_layers(document)
    space = document.modelspace()
    n_before = len(space)
    dxf.draw_plan(document, sheet, scale)
    place = Vec2(storey.x_m, storey.y_m) * scale.per_m
    motion = Matrix44.z_rotate(storey.rotation_rad)
    motion *= Matrix44.translate(place.x, place.y, storey.elevation_m * scale.per_m)
    for entity in list(space)[n_before:]:
        entity.transform(motion)
    name = re.sub(_NOT_IN_NAMES, " ", clean_text(storey.name)).strip()
    # as much as the tabs of CAD programs show
    port = dxf.draw_layout(document, f"{number} {name}"[:60], sheet, scale)
    port.dxf.view_twist_angle = sheet.page.turn_deg - math.degrees(storey.rotation_rad)
    turned = place.rotate_deg(port.dxf.view_twist_angle)
    port.dxf.view_center_point = Vec2(port.dxf.view_center_point) + turned
    for layer in LAYERS:
        document.layers.get(layer).rename(f"{number}-{layer}")


def _hide_others(document: Drawing) -> None:
    """Freeze in the view of each layout the layers of all storeys but its own."""
    names = [layer.dxf.name for layer in document.layers if layer.dxf.name[0].isdigit()]
    names.remove("0")
    for layout in list(document.layout_names_in_taborder())[1:]:
        own = f"{layout.split()[0]}-"
        for port in document.layout(layout).query("VIEWPORT"):
            assert isinstance(port, Viewport)
            port.frozen_layers = [name for name in names if not name.startswith(own)]
