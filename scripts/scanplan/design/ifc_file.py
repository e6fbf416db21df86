"""Reading a building model: the parts of an IFC file as triangles in metres, and its storeys."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.util.unit
import numpy as np

from scanplan.errors import StageError
from scanplan.types import BoolArray, FilePath, FloatArray

# the first that fits; what none fits is "other"
_KINDS = (
    ("wall", ("IfcWall", "IfcColumn", "IfcCurtainWall")),
    ("glass", ("IfcWindow", "IfcPlate")),
    ("door", ("IfcDoor",)),
    ("slab", ("IfcSlab", "IfcCovering", "IfcRoof", "IfcFooting")),
    ("furniture", ("IfcFurnishingElement",)),
    ("space", ("IfcSpace",)),
    ("opening", ("IfcOpeningElement",)),
)
# terrain and drawing aids are no part of what stands in a storey
_LEFT_OUT = (
    "IfcSite",
    "IfcAnnotation",
    "IfcGrid",
    "IfcVirtualElement",
    "IfcSpatialStructureElement",
    "IfcPort",
)
_MIN_TRANSPARENCY = 0.3  # lower makes tinted frames glass, higher makes tinted glass opaque


@dataclass(frozen=True)
class IfcPart:
    """One product of a building model.

    Attributes
    ----------
    kind : str
        `wall`, `glass`, `door`, `slab`, `furniture`, `space`, `opening` or `other`.
    ifc_class : str
        Such as IfcColumn.
    name : str
    fills : str
        Of an opening: `door`, `window` or `` (nothing is in it).
    filler : str
        Of an opening: the GlobalId of that.
    host : str
        Of an opening: the GlobalId of what it goes through.
    guid : str
    along : (2,) float64
        Unit vector of its own x axis seen from above: by IFC's convention the direction that a
        wall runs in.
    has_axis : bool
        Whether it states the line that it runs along.
    triangles_m : (t, 3, 3) float64
        World frame.
    transparent : (t,) bool
    """

    kind: str
    ifc_class: str
    name: str
    fills: str
    filler: str
    host: str
    guid: str
    along: FloatArray
    has_axis: bool
    triangles_m: FloatArray
    transparent: BoolArray


@dataclass(frozen=True)
class IfcBuilding:
    """A building model.

    Attributes
    ----------
    storeys : tuple of (str, float)
        From below: name, height of the floor in metres.
    parts : tuple of IfcPart
        In the file's order.
    notes : tuple of str
        What is odd and used all the same.
    """

    storeys: tuple[tuple[str, float], ...]
    parts: tuple[IfcPart, ...]
    notes: tuple[str, ...]


def parse_ifc(data: bytes, source: FilePath) -> IfcBuilding:
    """Read an IFC file.

    Parameters
    ----------
    source : path-like
        What errors name as their origin.

    Returns
    -------
    IfcBuilding

    Raises
    ------
    StageError
        If it is no whole IFC file, or has no storey or no wall.
    """
    text = data.decode("utf-8", errors="replace")
    if not text.lstrip().startswith("ISO-10303-21;") or "END-ISO-10303-21;" not in text[-200:]:
        state = "does not run from ISO-10303-21 to END-ISO-10303-21"
        if not data:
            state = "is empty (0 bytes)"
        raise StageError(
            f"{source}: {state}; it is cut off or no IFC file, export or copy it again"
        )
    try:
        model = ifcopenshell.file.from_string(text)
        storeys = _storeys(model)
        parts, failed = _parts(model)
    except (RuntimeError, ifcopenshell.Error, AttributeError, TypeError) as error:
        raise StageError(
            f"{source}: cannot be read as IFC ({str(error).strip()[:120]}); export it again"
        ) from None
    if not storeys or not any(part.kind == "wall" for part in parts):
        raise StageError(
            f"{source}: {len(storeys)} storeys and no walls with a shape; export storeys and walls"
        )
    note = f"{source}: {failed} products have a shape that could not be made; left out"
    return IfcBuilding(storeys, tuple(parts), (note,) if failed else ())


# ifcopenshell makes its classes while it runs: what it returns has no type that could be stated


def _storeys(model: Any) -> tuple[tuple[str, float], ...]:
    scale_m = ifcopenshell.util.unit.calculate_unit_scale(model)
    storeys = model.by_type("IfcBuildingStorey")
    heights = [_placement(storey)[2, 3] for storey in storeys]
    # some writers leave every storey at the same place and state only the elevation
    if len(storeys) > 1 and len(set(heights)) == 1:
        heights = [storey.Elevation or 0.0 for storey in storeys]
    named = [
        (storey.Name or storey.GlobalId, float(z) * scale_m)
        for storey, z in zip(storeys, heights, strict=True)
    ]
    return tuple(sorted(named, key=lambda storey: storey[1]))


def _parts(model: Any) -> tuple[list[IfcPart], int]:
    """Return the parts in the file's order, and how many products have no usable shape."""
    products = [p for p in model.by_type("IfcProduct") if p.Representation and _kind(p)]
    parts = {}
    for shape in _shapes(model, products):
        if len(shape.geometry.faces):
            parts[shape.id] = _part(model.by_id(shape.id), shape.geometry)
    return [parts[i] for i in sorted(parts)], len(products) - len(parts)


def _shapes(model: Any, products: list[Any]) -> Iterator[Any]:
    if not products:
        return
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    shapes = ifcopenshell.geom.iterator(settings, model, 1, include=products)
    is_more = shapes.initialize()
    while is_more:
        yield shapes.get()
        is_more = shapes.next()


def _kind(product: Any) -> str:
    """Return what kind of part a product is, empty if it is none."""
    if any(map(product.is_a, _LEFT_OUT)) and not product.is_a("IfcSpace"):
        return ""
    kinds = (kind for kind, names in _KINDS if any(map(product.is_a, names)))
    return next(kinds, "other")


def _part(product: Any, geometry: Any) -> IfcPart:
    corners_m = np.array(geometry.verts, float).reshape(-1, 3)
    faces = np.array(geometry.faces, int).reshape(-1, 3)
    is_clear = [
        bool(m.has_transparency and m.transparency >= _MIN_TRANSPARENCY) for m in geometry.materials
    ]
    # a face without material has the index -1
    material = np.array(geometry.material_ids, int)
    x_axis = _placement(product)[:2, 0]
    length = np.hypot(*x_axis)
    return IfcPart(
        kind=_kind(product),
        ifc_class=product.is_a(),
        name=_name(product),
        fills=_filling(product),
        filler=next((element.GlobalId for element in _fillers(product)), ""),
        host=_host(product),
        guid=product.GlobalId,
        along=x_axis / length if length > 0 else np.array([1.0, 0.0]),
        has_axis=any(
            shape.RepresentationIdentifier == "Axis"
            for shape in product.Representation.Representations
        ),
        triangles_m=corners_m[faces],
        transparent=np.array([*is_clear, False])[material],
    )


def _placement(product: Any) -> FloatArray:
    return ifcopenshell.util.placement.get_local_placement(product.ObjectPlacement)


def _name(product: Any) -> str:
    long_name = getattr(product, "LongName", None) if product.is_a("IfcSpace") else None
    return " ".join(name for name in (product.Name, long_name) if name)


def _filling(product: Any) -> str:
    """Return what is in an opening: `door`, `window` or nothing."""
    elements = _fillers(product)
    if any(element.is_a("IfcDoor") for element in elements):
        return "door"
    return "window" if any(element.is_a("IfcWindow") for element in elements) else ""


def _fillers(product: Any) -> list[Any]:
    fillings = [f.RelatedBuildingElement for f in getattr(product, "HasFillings", None) or ()]
    # some programs remove a door, and not its relation
    return [filling for filling in fillings if filling is not None]


def _host(product: Any) -> str:
    """Return the GlobalId of what an opening goes through, empty if it is none."""
    voided = getattr(product, "VoidsElements", None) or ()
    return voided[0].RelatingBuildingElement.GlobalId if voided else ""
