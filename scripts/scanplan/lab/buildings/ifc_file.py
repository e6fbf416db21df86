"""Reading a building model: the parts of an IFC file as triangles in metres, and its storeys."""

from dataclasses import dataclass

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.util.unit
import numpy as np

from scanplan.errors import StageError

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
_MIN_TRANSPARENCY = 0.3


@dataclass(frozen=True)
class IfcPart:
    """One product of a building model.

    Attributes
    ----------
    kind : str
        `wall`, `glass`, `door`, `slab`, `furniture`, `space`, `opening` or `other`.
    name : str
    fills : str
        Of an opening: `door`, `window` or `` (nothing is in it).
    host : str
        Of an opening: the GlobalId of what it goes through.
    guid : str
    along : (2,) float64
        Unit vector of its own x axis seen from above: by IFC's convention the direction a wall runs in.
    triangles_m : (t, 3, 3) float64
        World frame.
    transparent : (t,) bool
    """

    kind: str
    name: str
    fills: str
    host: str
    guid: str
    along: np.ndarray
    triangles_m: np.ndarray
    transparent: np.ndarray


@dataclass(frozen=True)
class IfcBuilding:
    """A building model: its storeys from below (name, height of the floor, metres), its parts in the file's order."""

    storeys: tuple
    parts: tuple
    notes: tuple


def parse_ifc(data, source):
    """Read an IFC file.

    Parameters
    ----------
    data : bytes
    source : path-like
        What errors name as their origin.

    Returns
    -------
    Model

    Raises
    ------
    StageError
        If it is no whole IFC file, or has no storey or no wall.
    """
    text = data.decode("utf-8", errors="replace")
    if not text.lstrip().startswith("ISO-10303-21;") or "END-ISO-10303-21;" not in text[-200:]:
        state = (
            "is empty (0 bytes)"
            if not data
            else "does not run from ISO-10303-21 to END-ISO-10303-21"
        )
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
    notes = (
        (f"{source}: {failed} products have a shape that could not be made; left out",)
        if failed
        else ()
    )
    return IfcBuilding(storeys, tuple(parts), notes)


def find_storey(model, chosen, source):
    """Return the index of a storey by its name or its index from below; None stands for the only one.

    Raises
    ------
    StageError
        Listing the storeys, if none or several are meant.
    """
    names = [name for name, _ in model.storeys]
    listed = ", ".join(
        f"{i} {name!r} at {z_m:.2f} m" for i, (name, z_m) in enumerate(model.storeys)
    )
    if chosen is None and len(names) == 1:
        return 0
    if isinstance(chosen, int) and 0 <= chosen < len(names):
        return chosen
    if isinstance(chosen, str) and names.count(chosen) == 1:
        return names.index(chosen)
    wanted = (
        "no storey is chosen"
        if chosen is None
        else f"storey {chosen!r} is none or several of its storeys"
    )
    raise StageError(
        f"{source}: {wanted}; set simulate.site.storey to a name or index of: {listed}"
    )


def _storeys(model):
    scale_m = ifcopenshell.util.unit.calculate_unit_scale(model)
    found = model.by_type("IfcBuildingStorey")
    placed = [
        ifcopenshell.util.placement.get_local_placement(s.ObjectPlacement)[2, 3] for s in found
    ]
    # some writers leave every storey at the same place and state only the elevation
    heights = (
        placed if len(set(placed)) > 1 or len(found) < 2 else [s.Elevation or 0.0 for s in found]
    )
    named = [
        (s.Name or s.GlobalId, float(z) * scale_m) for s, z in zip(found, heights, strict=True)
    ]
    return tuple(sorted(named, key=lambda storey: storey[1]))


def _parts(model):
    products = [p for p in model.by_type("IfcProduct") if p.Representation and _kind(p)]
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    shapes = ifcopenshell.geom.iterator(settings, model, 1, include=products) if products else None
    parts = {}
    more = shapes is not None and shapes.initialize()
    while more:
        shape = shapes.get()
        if len(shape.geometry.faces):
            parts[shape.id] = _part(model.by_id(shape.id), shape.geometry)
        more = shapes.next()
    return [parts[i] for i in sorted(parts)], len(products) - len(parts)


def _kind(product):
    if any(product.is_a(name) for name in _LEFT_OUT) and not product.is_a("IfcSpace"):
        return ""
    return next(
        (kind for kind, names in _KINDS if any(product.is_a(name) for name in names)), "other"
    )


def _part(product, geometry):
    corners = np.array(geometry.verts, float).reshape(-1, 3)
    triangles = corners[np.array(geometry.faces, int).reshape(-1, 3)]
    clear = [
        bool(m.has_transparency and m.transparency >= _MIN_TRANSPARENCY) for m in geometry.materials
    ]
    material = np.array(geometry.material_ids, int)
    along = ifcopenshell.util.placement.get_local_placement(product.ObjectPlacement)[:2, 0]
    return IfcPart(
        kind=_kind(product),
        name=_name(product),
        fills=_filling(product),
        host=_host(product),
        guid=product.GlobalId,
        along=along / np.hypot(*along) if np.hypot(*along) > 0 else np.array([1.0, 0.0]),
        triangles_m=triangles,
        transparent=np.array([*clear, False])[material],
    )


def _name(product):
    names = [product.Name, getattr(product, "LongName", None) if product.is_a("IfcSpace") else None]
    return " ".join(name for name in names if name)


def _filling(product):
    fillings = [f.RelatedBuildingElement for f in getattr(product, "HasFillings", None) or ()]
    kinds = {
        "door" if f.is_a("IfcDoor") else "window"
        for f in fillings
        if f.is_a("IfcDoor") or f.is_a("IfcWindow")
    }
    return min(kinds, default="")


def _host(product):
    voided = getattr(product, "VoidsElements", None) or ()
    return voided[0].RelatingBuildingElement.GlobalId if voided else ""
