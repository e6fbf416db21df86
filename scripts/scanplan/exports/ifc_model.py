"""Building an IFC4 file: the tree of a building, solids, properties, identifiers that stay."""

import math
import uuid
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import ifcopenshell
import ifcopenshell.guid
import numpy as np
import shapely
from ifcopenshell import entity_instance
from shapely.geometry import Polygon

from scanplan.types import Array, FloatArray

_NAMESPACE = uuid.UUID("6f1c2c0e-6b0b-5f0e-9d55-3d2f6f0a7c11")  # ours, drawn once
_TIME = "1970-01-01T00:00:00"  # of the header: the same plan gives the same bytes
_PRECISION_M = 1e-5  # of the coordinates: points nearer than this are one, 0.01 mm
_VIEW = "ViewDefinition [ReferenceView_V1.2]"  # buildingSMART's view for coordination

Values = Mapping[str, tuple[str, Any]]
"""IFC types and values by name; None for what is not known."""


class IfcModel:
    """An IFC4 file of one storey, in metres.

    Attributes
    ----------
    name : str
    file : ifcopenshell.file
    ids : set of str
        GlobalIds in use.
    body, axis : entity
        The contexts of solids and of lines that products run along.
    storey : entity
        The IfcBuildingStorey; products are placed relative to its `ObjectPlacement`, whose z is 0
        at the floor.
    """

    def __init__(self, name: str, floor_m: float) -> None:
        self.name = name
        self.file = ifcopenshell.file(schema="IFC4")
        self.ids: set[str] = set()
        units = self._units()
        context = self._contexts()
        project = self.root("IfcProject", (), Name=name)
        project.RepresentationContexts = [context]
        project.UnitsInContext = self.new("IfcUnitAssignment", units)
        self.storey = self._storey(project, floor_m)

    def guid(self, *words: Any) -> str:
        """Return the GlobalId that follows from words and numbers.

        The same ones again give another.
        """
        key = "/".join([self.name, *map(str, words)])
        global_id = _compress(key)
        while global_id in self.ids:
            key += "+"
            global_id = _compress(key)
        self.ids.add(global_id)
        return global_id

    def root(self, ifc_class: str, key: Iterable[Any], **attributes: Any) -> entity_instance:
        """Add an entity with a GlobalId that follows from its class and `key`."""
        return self.file.create_entity(ifc_class, GlobalId=self.guid(ifc_class, *key), **attributes)

    def new(self, ifc_class: str, *values: Any) -> entity_instance:
        """Add an entity without identity, its attributes in order."""
        return self.file.create_entity(ifc_class, *values)

    def point(self, coordinates: Iterable[float]) -> entity_instance:
        """Add a point of two or three coordinates."""
        return self.new("IfcCartesianPoint", [float(value) for value in coordinates])

    def placement(
        self,
        place_m: Iterable[float],
        along: Iterable[float],
        relative_to: entity_instance | None,
    ) -> entity_instance:
        """Add the placement of a product at (x, y, z).

        Its own x axis has the level direction `along` (x, y).
        """
        x = self.new("IfcDirection", [*map(float, along), 0.0])
        z = self.new("IfcDirection", [0.0, 0.0, 1.0])
        axes = self.new("IfcAxis2Placement3D", self.point(place_m), z, x)
        return self.new("IfcLocalPlacement", relative_to, axes)

    def prism(self, polygon: Polygon, low_m: float, high_m: float) -> entity_instance:
        """Return a solid over the ground of a polygon (local x, y), from `low_m` to `high_m`."""
        rings = shapely.get_rings(shapely.orient_polygons(polygon))
        outer, *inner = [self._polyline(shapely.get_coordinates(ring)) for ring in rings]
        if inner:
            profile = self.new("IfcArbitraryProfileDefWithVoids", "AREA", None, outer, inner)
        else:
            profile = self.new("IfcArbitraryClosedProfileDef", "AREA", None, outer)
        base = self.new("IfcAxis2Placement3D", self.point((0, 0, low_m)), None, None)
        up = self.new("IfcDirection", [0.0, 0.0, 1.0])
        return self.new("IfcExtrudedAreaSolid", profile, base, up, high_m - low_m)

    def shape(
        self, solids: Sequence[entity_instance], axis: FloatArray | None = None
    ) -> entity_instance:
        """Return a product's shape: solids, and the line (n, 2) that it runs along, if any."""
        bodies = self.new("IfcShapeRepresentation", self.body, "Body", "SweptSolid", solids)
        if axis is None:
            return self.new("IfcProductDefinitionShape", None, None, [bodies])
        line = self._polyline(axis)
        curve = self.new("IfcShapeRepresentation", self.axis, "Axis", "Curve2D", [line])
        return self.new("IfcProductDefinitionShape", None, None, [curve, bodies])

    def aggregate(self, whole: entity_instance, parts: Sequence[entity_instance]) -> None:
        """Make parts the parts of a whole."""
        if parts:
            key = (whole.GlobalId,)
            self.root("IfcRelAggregates", key, RelatingObject=whole, RelatedObjects=parts)

    def contain(self, products: Sequence[entity_instance]) -> None:
        """Put products into the storey."""
        if products:
            self.root(
                "IfcRelContainedInSpatialStructure",
                (),
                RelatedElements=products,
                RelatingStructure=self.storey,
            )

    def describe(self, product: entity_instance, name: str, values: Values) -> None:
        """Give a product a set of properties; what is None is not known and left out."""
        properties = [
            self.new("IfcPropertySingleValue", key, None, self.new(kind, value), None)
            for key, (kind, value) in values.items()
            if value is not None
        ]
        key = (product.GlobalId, name)
        self._define(product, self.root("IfcPropertySet", key, Name=name, HasProperties=properties))

    def measure(self, product: entity_instance, name: str, values: Values) -> None:
        """Give a product a set of quantities, IfcQuantityLength or IfcQuantityArea."""
        quantities = [
            self.new(kind, key, None, None, value) for key, (kind, value) in values.items()
        ]
        key = (product.GlobalId, name)
        self._define(
            product, self.root("IfcElementQuantity", key, Name=name, Quantities=quantities)
        )

    def text(self) -> str:
        """Return the file's text, without time or user."""
        header = self.file.header
        header.file_description.description = (_VIEW,)
        header.file_name.name = self.name.encode("ascii", "replace").decode()
        header.file_name.time_stamp = _TIME
        header.file_name.preprocessor_version = "scanplan"
        header.file_name.originating_system = "scanplan"
        return self.file.to_string()

    def _units(self) -> list[entity_instance]:
        units = [
            ("LENGTHUNIT", "METRE"),
            ("AREAUNIT", "SQUARE_METRE"),
            ("VOLUMEUNIT", "CUBIC_METRE"),
            ("PLANEANGLEUNIT", "RADIAN"),
        ]
        return [self.new("IfcSIUnit", None, kind, None, name) for kind, name in units]

    def _contexts(self) -> entity_instance:
        """Add the context of all shapes, and those of bodies and axes in it."""
        origin = self.new("IfcAxis2Placement3D", self.point((0, 0, 0)), None, None)
        whole = self.new(
            "IfcGeometricRepresentationContext", None, "Model", 3, _PRECISION_M, origin, None
        )
        self.body = self._subcontext(whole, "Body", "MODEL_VIEW")
        self.axis = self._subcontext(whole, "Axis", "GRAPH_VIEW")
        return whole

    def _subcontext(self, whole: entity_instance, name: str, view: str) -> entity_instance:
        return self.file.create_entity(
            "IfcGeometricRepresentationSubContext",
            ContextIdentifier=name,
            ContextType="Model",
            ParentContext=whole,
            TargetView=view,
        )

    def _storey(self, project: entity_instance, floor_m: float) -> entity_instance:
        """Add site, building and storey, whose floor lies at `floor_m`; return the storey."""
        whole = project
        placement = None
        for ifc_class, name, height_m in (
            ("IfcSite", "Site, place on earth and north unknown", 0.0),
            ("IfcBuilding", self.name, 0.0),
            ("IfcBuildingStorey", "Surveyed storey", floor_m),
        ):
            placement = self.placement((0, 0, height_m), (1, 0), placement)
            part = self.root(
                ifc_class, (), Name=name, ObjectPlacement=placement, CompositionType="ELEMENT"
            )
            self.aggregate(whole, [part])
            whole = part
        whole.Elevation = floor_m
        return whole

    def _polyline(self, points_m: Array) -> entity_instance:
        return self.new("IfcPolyline", [self.point(xy) for xy in points_m.tolist()])

    def _define(self, product: entity_instance, definition: entity_instance) -> None:
        self.root(
            "IfcRelDefinesByProperties",
            (product.GlobalId, definition.Name),
            RelatedObjects=[product],
            RelatingPropertyDefinition=definition,
        )


class Frame:
    """The frame of a line (2, 2): x along it from its start, y to its left."""

    def __init__(self, line: FloatArray) -> None:
        self.length_m = math.dist(*line)
        self.along = (line[1] - line[0]) / self.length_m
        self._start = line[0]

    def move_here(self, polygon: Polygon) -> Polygon:
        """Return a polygon of the map in this frame."""
        turn = np.array([self.along, (-self.along[1], self.along[0])])
        return shapely.transform(polygon, lambda xy_m: (xy_m - self._start) @ turn.T)

    def placement(self, model: IfcModel) -> entity_instance:
        """Return the placement of a product in this frame, on the storey's floor."""
        return model.placement((*self._start, 0), self.along, model.storey.ObjectPlacement)


def _compress(key: str) -> str:
    return ifcopenshell.guid.compress(uuid.uuid5(_NAMESPACE, key).hex)
