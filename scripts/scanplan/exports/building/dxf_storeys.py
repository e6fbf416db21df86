"""The drawings of storeys put into one DXF file, each on layers of its own."""

import io
from collections.abc import Sequence

from ezdxf.addons.importer import Importer
from ezdxf.document import Drawing
from ezdxf.entities import Dimension
from ezdxf.enums import InsertUnits
from ezdxf.filemanagement import new, read
from ezdxf.math import Matrix44
from ezdxf.units import conversion_factor

from scanplan.exports.building.placed_storey import PlacedStorey


def merge_dxf(storeys: Sequence[PlacedStorey]) -> str:
    """Return the text of the building's file.

    Storeys lie above each other at their elevations; the layers of the lowest begin with `1-`, of
    the next with `2-`, and so on, so that one can be seen without the others.

    Parameters
    ----------
    storeys : sequence of PlacedStorey, at least one
        Each the text of a DXF file, from the lowest up.
    """
    drawings = [read(io.StringIO(storey.text)) for storey in storeys]
    merged = new("R2010")
    merged.units = drawings[0].units
    unit = InsertUnits(drawings[0].units)
    per_m = conversion_factor(InsertUnits.Meters, unit)
    for number, (storey, drawing) in enumerate(zip(storeys, drawings, strict=True), 1):
        _prefix_layers(drawing, f"{number}-")
        importer = Importer(drawing, merged)
        importer.import_modelspace()
        importer.finalize()
        motion = Matrix44.z_rotate(storey.rotation_rad)
        place_m = (storey.x_m, storey.y_m, storey.elevation_m)
        motion *= Matrix44.translate(*(per_m * value for value in place_m))
        for entity in merged.modelspace():
            if entity.dxf.layer.startswith(f"{number}-"):
                entity.transform(motion)
                # its lines are in a block of its own, which is not imported with it
                if isinstance(entity, Dimension):
                    entity.render()
    text = io.StringIO()
    merged.write(text)
    return text.getvalue()


def _prefix_layers(drawing: Drawing, prefix: str) -> None:
    """Rename all layers but those that every drawing has, in modelspace and in blocks."""
    for layer in list(drawing.layers):
        if layer.dxf.name not in ("0", "Defpoints"):
            layer.rename(prefix + layer.dxf.name)
    for entity in drawing.modelspace():
        if not entity.dxf.layer.startswith(prefix):
            entity.dxf.layer = prefix + entity.dxf.layer
