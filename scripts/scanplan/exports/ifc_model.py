"""An IFC4 file in the making: the tree of a building, solids over polygons, properties, identifiers that stay."""

import uuid

import ifcopenshell
import ifcopenshell.guid
import shapely

_NAMESPACE = uuid.UUID("6f1c2c0e-6b0b-5f0e-9d55-3d2f6f0a7c11")
_TIME = "1970-01-01T00:00:00"


class IfcModel:
    """An IFC4 file of one storey, in metres.

    Attributes
    ----------
    storey : entity
        The IfcBuildingStorey; products are placed relative to its `ObjectPlacement`, whose z is 0 at the floor.
    """

    def __init__(self, name, floor_m):
        self.name = name
        self.file = ifcopenshell.file(schema="IFC4")
        self.ids = set()
        self._begin(floor_m)

    def guid(self, *words):
        """Return the GlobalId that follows from words and numbers; the same ones again give another."""
        key = "/".join([self.name, *map(str, words)])
        while (found := ifcopenshell.guid.compress(uuid.uuid5(_NAMESPACE, key).hex)) in self.ids:
            key += "+"
        self.ids.add(found)
        return found

    def root(self, ifc_class, key, **attributes):
        """Add an entity with a GlobalId that follows from its class and `key`."""
        return self.file.create_entity(ifc_class, GlobalId=self.guid(ifc_class, *key), **attributes)

    def new(self, ifc_class, *values):
        """Add an entity without identity, its attributes in order."""
        return self.file.create_entity(ifc_class, *values)

    def _begin(self, floor_m):
        """Add units, contexts and the tree from the project down to the storey, whose floor lies at `floor_m`."""
        units = [
            ("LENGTHUNIT", "METRE"),
            ("AREAUNIT", "SQUARE_METRE"),
            ("VOLUMEUNIT", "CUBIC_METRE"),
        ]
        units = [
            self.new("IfcSIUnit", None, kind, None, name)
            for kind, name in [*units, ("PLANEANGLEUNIT", "RADIAN")]
        ]
        origin = self.new("IfcAxis2Placement3D", self.point((0, 0, 0)), None, None)
        whole = self.new("IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, origin, None)
        self.body, self.axis = (
            self.new(
                "IfcGeometricRepresentationSubContext",
                name,
                "Model",
                None,
                None,
                None,
                None,
                whole,
                None,
                view,
                None,
            )
            for name, view in (("Body", "MODEL_VIEW"), ("Axis", "GRAPH_VIEW"))
        )
        project = self.root("IfcProject", (), Name=self.name)
        project.RepresentationContexts, project.UnitsInContext = (
            [whole],
            self.new("IfcUnitAssignment", units),
        )
        above, where = project, None
        for ifc_class, name, height_m in (
            ("IfcSite", "Site, place on earth and north unknown", 0.0),
            ("IfcBuilding", self.name, 0.0),
            ("IfcBuildingStorey", "Surveyed storey", floor_m),
        ):
            where = self.placement((0, 0, height_m), (1, 0), where)
            part = self.root(
                ifc_class, (), Name=name, ObjectPlacement=where, CompositionType="ELEMENT"
            )
            self.aggregate(above, [part])
            above = part
        self.storey = above
        self.storey.Elevation = floor_m

    def point(self, coordinates):
        """Add a point of two or three coordinates."""
        return self.new("IfcCartesianPoint", [float(v) for v in coordinates])

    def placement(self, place_m, along, relative_to):
        """Add the placement of a product at (x, y, z), whose own x axis has the level direction `along` (x, y)."""
        x = self.new("IfcDirection", [*map(float, along), 0.0])
        z = self.new("IfcDirection", [0.0, 0.0, 1.0])
        axes = self.new("IfcAxis2Placement3D", self.point(place_m), z, x)
        return self.new("IfcLocalPlacement", relative_to, axes)

    def prism(self, polygon, low_m, high_m):
        """Return a solid over the ground of a polygon (local x, y), from `low_m` to `high_m`."""
        outer, *inner = (
            self.new(
                "IfcPolyline", [self.point(xy) for xy in shapely.get_coordinates(ring).tolist()]
            )
            for ring in shapely.get_rings(shapely.orient_polygons(polygon))
        )
        profile = (
            self.new("IfcArbitraryProfileDefWithVoids", "AREA", None, outer, inner)
            if inner
            else self.new("IfcArbitraryClosedProfileDef", "AREA", None, outer)
        )
        where = self.new("IfcAxis2Placement3D", self.point((0, 0, low_m)), None, None)
        return self.new(
            "IfcExtrudedAreaSolid",
            profile,
            where,
            self.new("IfcDirection", [0.0, 0.0, 1.0]),
            high_m - low_m,
        )

    def shape(self, solids, axis=None):
        """Return a product's shape: solids, and the line that it runs along, if any, as points (x, y)."""
        parts = [self.new("IfcShapeRepresentation", self.body, "Body", "SweptSolid", solids)]
        if axis is not None:
            line = self.new("IfcPolyline", [self.point(xy) for xy in axis])
            parts.insert(
                0, self.new("IfcShapeRepresentation", self.axis, "Axis", "Curve2D", [line])
            )
        return self.new("IfcProductDefinitionShape", None, None, parts)

    def aggregate(self, whole, parts):
        """Make parts the parts of a whole."""
        if parts:
            self.root(
                "IfcRelAggregates", (whole.GlobalId,), RelatingObject=whole, RelatedObjects=parts
            )

    def contain(self, products):
        """Put products into the storey."""
        if products:
            self.root(
                "IfcRelContainedInSpatialStructure",
                (),
                RelatedElements=products,
                RelatingStructure=self.storey,
            )

    def describe(self, product, name, values):
        """Give a product properties; what is None is not known and left out."""
        properties = [
            self.new("IfcPropertySingleValue", key, None, self.new(kind, value), None)
            for key, (kind, value) in values.items()
            if value is not None
        ]
        self._define(
            product,
            self.root(
                "IfcPropertySet", (product.GlobalId, name), Name=name, HasProperties=properties
            ),
        )

    def measure(self, product, name, values):
        """Give a product quantities: name to (IfcQuantityLength or IfcQuantityArea, value)."""
        quantities = [
            self.new(kind, key, None, None, value) for key, (kind, value) in values.items()
        ]
        made = self.root(
            "IfcElementQuantity", (product.GlobalId, name), Name=name, Quantities=quantities
        )
        self._define(product, made)

    def _define(self, product, definition):
        self.root(
            "IfcRelDefinesByProperties", (product.GlobalId, definition.Name),
            RelatedObjects=[product], RelatingPropertyDefinition=definition,
        )  # fmt: skip

    def text(self):
        """Return the file's text, without time or user."""
        header = self.file.header
        header.file_description.description = ("ViewDefinition [ReferenceView_V1.2]",)
        header.file_name.name = self.name.encode("ascii", "replace").decode()
        header.file_name.time_stamp = _TIME
        header.file_name.originating_system = header.file_name.preprocessor_version = "scanplan"
        return self.file.to_string()
