"""Building an IFC4 file: the tree of a building, solids, properties, identifiers."""

import math
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from itertools import pairwise
from typing import Any, NamedTuple

import ifcopenshell
import numpy as np
import shapely
from ifcopenshell import entity_instance
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.exports.data import element_ids
from scanplan.exports.earth import find_geographic
from scanplan.exports.model_colours import read_colour
from scanplan.exports.model_origin import ModelOrigin, Site
from scanplan.geometry.arcs import NO_CIRCLES, SAGITTA_M, bend_path, middle_of_bulge, turn_rad
from scanplan.types import Array, FloatArray

_APPLICATION = "scanplan"
_REFERENCE = "ViewDefinition [ReferenceView_V1.2]"  # buildingSMART's view for coordination
_TRANSFER = "ViewDefinition [DesignTransferView_V1.0]"  # likewise for going on with a model

_RELATED = {
    "IfcRelAggregates": "RelatedObjects",
    "IfcRelAssociatesClassification": "RelatedObjects",
    "IfcRelAssociatesMaterial": "RelatedObjects",
    "IfcRelCoversSpaces": "RelatedCoverings",
    "IfcRelDefinesByProperties": "RelatedObjects",
    "IfcRelDefinesByType": "RelatedObjects",
    "IfcRelFillsElement": "RelatedBuildingElement",
    "IfcRelVoidsElement": "RelatedOpeningElement",
}

Values = Mapping[str, tuple[str, Any]]
"""IFC types and values by name; None for what is not known."""


class ClassCode(NamedTuple):
    """A code of a system of classification; title, publisher and edition None where not stated."""

    system: str
    code: str
    title: str | None = None
    source: str | None = None
    edition: str | None = None


class IfcModel:
    """An IFC4 file of one storey, in metres.

    Attributes
    ----------
    name : str
    file : ifcopenshell.file
    ids : set of str
        GlobalIds in use.
    origin : ModelOrigin
    is_editable : bool
        Whether it is for a modeller to go on with, and not to look at alone.
    body, axis : entity
        The contexts of solids and of lines that products run along.
    footprint : entity or None
        The context of symbols in plan, of what is editable.
    storey : entity
        The IfcBuildingStorey; products are placed relative to its `ObjectPlacement`, whose z is 0
        at the floor.
    """

    def __init__(
        self, name: str, floor_m: float, origin: ModelOrigin, *, is_editable: bool = False
    ) -> None:
        self.name = name
        self.is_editable = is_editable
        self.origin = origin
        self.file = ifcopenshell.file(schema="IFC4")
        self.ids: set[str] = set()
        self._styles: dict[str, entity_instance] = {}
        self._systems: dict[str, entity_instance] = {}
        self._codes: dict[ClassCode, entity_instance] = {}
        self._history = self._owner_history()
        units = self._units()
        context = self._contexts()
        project = self.root("IfcProject", (), Name=origin.project or name)
        project.RepresentationContexts = [context]
        project.UnitsInContext = self.new("IfcUnitAssignment", units)
        self.storey = self._storey(project, floor_m)

    def guid(self, *words: Any) -> str:
        """Return the GlobalId that follows from words and numbers.

        The same ones again give another.
        """
        key = "/".join([self.name, *map(str, words)])
        global_id = element_ids.derive_id(key)
        while global_id in self.ids:
            key += "+"
            global_id = element_ids.derive_id(key)
        self.ids.add(global_id)
        return global_id

    def root(self, ifc_class: str, key: Iterable[Any], **attributes: Any) -> entity_instance:
        """Add an entity with a GlobalId that follows from its class and `key`."""
        return self.known(ifc_class, self.guid(ifc_class, *key), **attributes)

    def known(self, ifc_class: str, global_id: str, **attributes: Any) -> entity_instance:
        """Add an entity with a GlobalId that it has."""
        self.ids.add(global_id)
        return self.new(ifc_class, GlobalId=global_id, OwnerHistory=self._history, **attributes)

    def rooted(self, ifc_class: str, *joined: entity_instance) -> dict[str, Any]:
        """Return the attributes of a relation's identity, which follows from what it joins."""
        words = [part.GlobalId for part in joined]
        return {"GlobalId": self.guid(ifc_class, *words), "OwnerHistory": self._history}

    def join(
        self,
        ifc_class: str,
        related: entity_instance | Sequence[entity_instance],
        **relating: entity_instance,
    ) -> None:
        """Add a relation to what is relating, of one or of several."""
        first = related if isinstance(related, entity_instance) else related[0]
        self.new(
            ifc_class, **self.rooted(ifc_class, first), **relating, **{_RELATED[ifc_class]: related}
        )

    def new(self, ifc_class: str, *values: Any, **attributes: Any) -> entity_instance:
        """Add an entity, its attributes in order or by name."""
        made = self.file.create(ifc_class, -1)
        # `create_entity` asks for each of them whether there is a transaction: twice the time
        for place, value in enumerate(values):
            made.set_attribute_value_py(place, value)
        for name, value in attributes.items():
            made.set_attribute_value_py(made.get_argument_index(name), value)
        return made

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

    def prism(
        self,
        polygon: Polygon,
        low_m: float,
        high_m: float,
        circles_m: FloatArray = NO_CIRCLES,
    ) -> entity_instance:
        """Return a solid over the ground of a polygon (local x, y), from `low_m` to `high_m`.

        Where its outline follows one of some circles (k, 3), it is an arc.
        """
        rings = shapely.get_rings(shapely.orient_polygons(polygon))
        outer, *inner = [self._outline(shapely.get_coordinates(ring), circles_m) for ring in rings]
        if inner:
            profile = self.new("IfcArbitraryProfileDefWithVoids", "AREA", None, outer, inner)
        else:
            profile = self.new("IfcArbitraryClosedProfileDef", "AREA", None, outer)
        base = self.new("IfcAxis2Placement3D", self.point((0, 0, low_m)), None, None)
        up = self.new("IfcDirection", [0.0, 0.0, 1.0])
        return self.new("IfcExtrudedAreaSolid", profile, base, up, high_m - low_m)

    def upright(self, line_m: FloatArray, extent_m: tuple[float, float]) -> entity_instance:
        """Return the upright rectangle over a line (2, 2), facing to its right, as a connection.

        `extent_m` is from where to where it reaches above the floor.
        """
        length_m = math.dist(*line_m)
        along_x, along_y = ((line_m[1] - line_m[0]) / length_m).tolist()
        facing = self.new("IfcDirection", [along_y, -along_x, 0.0])
        along = self.new("IfcDirection", [along_x, along_y, 0.0])
        axes = self.new("IfcAxis2Placement3D", self.point((*line_m[0], 0)), facing, along)
        low_m, high_m = extent_m
        return self._connection(axes, shapely.box(0, low_m, length_m, high_m))

    def level(self, polygon: Polygon, height_m: float, *, up: bool) -> entity_instance:
        """Return a level polygon at a height above the floor, facing up or down, likewise."""
        side = 1.0 if up else -1.0
        facing = self.new("IfcDirection", [0.0, 0.0, side])
        along = self.new("IfcDirection", [1.0, 0.0, 0.0])
        axes = self.new("IfcAxis2Placement3D", self.point((0, 0, height_m)), facing, along)
        return self._connection(axes, shapely.transform(polygon, lambda xy: xy * (1.0, side)))

    def arc(self, ends_m: FloatArray, centre_m: FloatArray) -> entity_instance:
        """Return the shorter arc from one end to another (2, 2) around a centre (local x, y)."""
        from_centre_m = ends_m - centre_m
        first, second = (self.point(xy) for xy in ends_m.tolist())
        axes = self.new("IfcAxis2Placement2D", self.point(centre_m.tolist()), None)
        circle = self.new("IfcCircle", axes, float(np.hypot(*from_centre_m.T).mean()))
        is_left = turn_rad(from_centre_m[1], from_centre_m[0]) > 0
        return self.new("IfcTrimmedCurve", circle, [first], [second], bool(is_left), "CARTESIAN")

    def shape(
        self,
        solids: Sequence[entity_instance],
        axis: FloatArray | None = None,
        curve: entity_instance | None = None,
        symbol: Sequence[entity_instance] = (),
    ) -> entity_instance:
        """Return a product's shape: solids, and the line (n, 2) or curve it runs along, if any.

        `symbol` has the curves that it is drawn with in plan, of an editable model.
        """
        shapes: list[entity_instance] = []
        if axis is not None:
            line = self.polyline(axis) if curve is None else curve
            shapes.append(self.new("IfcShapeRepresentation", self.axis, "Axis", "Curve2D", [line]))
        if solids:
            shapes.append(
                self.new("IfcShapeRepresentation", self.body, "Body", "SweptSolid", solids)
            )
        if self.footprint is not None and symbol:
            drawn = [self.new("IfcGeometricCurveSet", symbol)]
            shapes.append(
                self.new(
                    *("IfcShapeRepresentation", self.footprint, "FootPrint"),
                    *("GeometricCurveSet", drawn),
                )
            )
        return self.new("IfcProductDefinitionShape", None, None, shapes)

    def outline(
        self, area: BaseGeometry, circles_m: FloatArray = NO_CIRCLES
    ) -> list[entity_instance]:
        """Return the curves around an area (local x, y) in plan; none of a model to look at."""
        if not self.is_editable:
            return []
        rings = shapely.get_rings(shapely.get_parts(area))
        return [self._outline(shapely.get_coordinates(ring), circles_m) for ring in rings]

    def classify(self, products: Sequence[entity_instance], code: "ClassCode") -> None:
        """Give products a code of a system of classification."""
        if code.system not in self._systems:
            self._systems[code.system] = self.new(
                "IfcClassification", Name=code.system, Source=code.source, Edition=code.edition
            )
        if code not in self._codes:
            self._codes[code] = self.new(
                "IfcClassificationReference",
                Identification=code.code,
                Name=code.title,
                ReferencedSource=self._systems[code.system],
            )
        self.join(
            "IfcRelAssociatesClassification", products, RelatingClassification=self._codes[code]
        )

    def aggregate(self, whole: entity_instance, parts: Sequence[entity_instance]) -> None:
        """Make parts the parts of a whole."""
        if parts:
            self.join("IfcRelAggregates", parts, RelatingObject=whole)

    def contain(self, products: Sequence[entity_instance]) -> None:
        """Put products into the storey."""
        if products:
            self.root(
                "IfcRelContainedInSpatialStructure",
                (),
                RelatedElements=products,
                RelatingStructure=self.storey,
            )

    def describe(
        self, product: entity_instance, name: str, values: Values, unknown: Sequence[str] = ()
    ) -> None:
        """Give a product a set of properties; what is None is not known and left out.

        Those named `unknown` stand in the set without a value.
        """
        properties = [
            self.new("IfcPropertySingleValue", key, None, self.new(kind, value), None)
            for key, (kind, value) in values.items()
            if value is not None
        ]
        properties += [self.new("IfcPropertySingleValue", key) for key in unknown]
        key = (product.GlobalId, name)
        self._define(product, self.root("IfcPropertySet", key, Name=name, HasProperties=properties))

    def measure(self, product: entity_instance, name: str, values: Mapping[str, float]) -> None:
        """Give a product a set of quantities; their names say whether length, area or volume."""
        quantities = [
            self.new(_quantity_class(key), key, None, None, float(value))
            for key, value in values.items()
        ]
        key = (product.GlobalId, name)
        self._define(
            product, self.root("IfcElementQuantity", key, Name=name, Quantities=quantities)
        )

    def colour(self, solids: Iterable[entity_instance], name: str) -> None:
        """Give solids one of `model_colours.COLOURS`."""
        if name not in self._styles:
            *rgb, opacity = read_colour(name)
            tone = self.new("IfcColourRgb", None, *rgb)
            shading = self.new("IfcSurfaceStyleShading", tone, 1 - opacity)
            shown = self.origin.locale.say(name)
            self._styles[name] = self.new("IfcSurfaceStyle", shown, "BOTH", [shading])
        for solid in solids:
            self.new("IfcStyledItem", solid, [self._styles[name]], None)

    def text(self) -> str:
        """Return the file's text; its time is the survey's, not that of writing."""
        header = self.file.header
        view = _TRANSFER if self.is_editable else _REFERENCE
        header.file_description.description = (view,)
        header.file_name.name = self.name
        header.file_name.time_stamp = self._surveyed_at.strftime("%Y-%m-%dT%H:%M:%S")
        header.file_name.author = (self.origin.author,)
        header.file_name.organization = (self.origin.organisation,)
        header.file_name.preprocessor_version = _APPLICATION
        header.file_name.originating_system = _APPLICATION
        return self.file.to_string()

    @property
    def _surveyed_at(self) -> datetime:
        return datetime.fromtimestamp(self.origin.t_ns // 10**9, UTC)

    def _owner_history(self) -> entity_instance:
        nobody = self.origin.locale.say("not stated")
        person = self.new("IfcPerson", None, self.origin.author or nobody)
        organisation = self.new("IfcOrganization", None, self.origin.organisation or nobody)
        maker = self.new("IfcOrganization", None, _APPLICATION)
        application = self.new(
            "IfcApplication",
            maker,
            self.origin.version,
            "scanplan, floor plans of LiDAR surveys",
            _APPLICATION,
        )
        return self.new(
            "IfcOwnerHistory",
            OwningUser=self.new("IfcPersonAndOrganization", person, organisation, None),
            OwningApplication=application,
            CreationDate=int(self._surveyed_at.timestamp()),
        )

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
        precision_m = 1e-5  # of the coordinates: points nearer than this are one, 0.01 mm
        whole = self.new(
            "IfcGeometricRepresentationContext", None, "Model", 3, precision_m, origin, None
        )
        self._georeference(whole, self.origin.site)
        self.body = self._subcontext(whole, "Body", "MODEL_VIEW")
        self.axis = self._subcontext(whole, "Axis", "GRAPH_VIEW")
        self.footprint = (
            self._subcontext(whole, "FootPrint", "PLAN_VIEW") if self.is_editable else None
        )
        return whole

    def _georeference(self, context: entity_instance, site: Site) -> None:
        """State where the map frame lies on earth, and where north is, as far as that is known."""
        if site.north_deg is not None:
            north_rad = math.radians(site.north_deg)
            ratios = [math.cos(north_rad), math.sin(north_rad)]
            context.TrueNorth = self.new("IfcDirection", ratios)
        if site.crs is not None:
            turn_rad = math.radians(site.turn_deg)
            self.new(
                "IfcMapConversion",
                SourceCRS=context,
                TargetCRS=self.new("IfcProjectedCRS", site.crs),
                Eastings=site.east_m,
                Northings=site.north_m,
                OrthogonalHeight=site.height_m,
                XAxisAbscissa=math.cos(turn_rad),
                XAxisOrdinate=math.sin(turn_rad),
                Scale=1.0,
            )

    def _subcontext(self, whole: entity_instance, name: str, view: str) -> entity_instance:
        return self.new(
            "IfcGeometricRepresentationSubContext",
            ContextIdentifier=name,
            ContextType="Model",
            ParentContext=whole,
            TargetView=view,
        )

    def _storey(self, project: entity_instance, floor_m: float) -> entity_instance:
        """Add site, building and storey; return the storey.

        The building's height 0 is its floor, at `floor_m` of the map frame.
        """
        is_placed = self.origin.site.crs is not None
        say = self.origin.locale.say
        whole = project
        placement = None
        for ifc_class, name, height_m in (
            ("IfcSite", say("Site" if is_placed else "Site, place on earth unknown"), 0.0),
            ("IfcBuilding", self.origin.project or self.name, floor_m),
            ("IfcBuildingStorey", self.origin.storey or say("Surveyed storey"), 0.0),
        ):
            placement = self.placement((0, 0, height_m), (1, 0), placement)
            part = self.root(
                ifc_class, (), Name=name, ObjectPlacement=placement, CompositionType="ELEMENT"
            )
            self.aggregate(whole, [part])
            if ifc_class == "IfcSite" and is_placed:
                self._state_place(part, self.origin.site)
            if ifc_class == "IfcBuilding" and is_placed:
                part.ElevationOfRefHeight = self.origin.site.height_m + floor_m
            whole = part
        whole.Elevation = 0.0
        return whole

    def _state_place(self, part: entity_instance, site: Site) -> None:
        """State latitude and longitude of a site, where they are known, and its height."""
        part.RefElevation = site.height_m
        place = find_geographic(site.crs, site.east_m, site.north_m)
        if place is not None:
            part.RefLatitude, part.RefLongitude = map(_split_degrees, place)

    def _connection(self, axes: entity_instance, face: Polygon) -> entity_instance:
        """Return a face in the plane of two axes as what connects two elements."""
        outer, *inner = [
            self.polyline(shapely.get_coordinates(ring)) for ring in shapely.get_rings(face)
        ]
        plane = self.new("IfcPlane", axes)
        surface = self.new("IfcCurveBoundedPlane", plane, outer, inner)
        return self.new("IfcConnectionSurfaceGeometry", surface, None)

    def _outline(self, points_m: FloatArray, circles_m: FloatArray) -> entity_instance:
        """Return a closed line through points, in arcs where it follows circles."""
        path = bend_path(points_m, circles_m, SAGITTA_M)
        return self.path(path) if path[:, 2].any() else self.polyline(points_m)

    def path(self, path: FloatArray) -> entity_instance:
        """Return a line through corners (n, 3) with bulges, closed if it ends where it began."""
        is_closed = bool((path[0, :2] == path[-1, :2]).all())
        n_corners = len(path) - is_closed
        corners = path[:n_corners, :2].tolist()
        segments = []
        numbers = [*range(1, n_corners + 1), *([1] if is_closed else [])]
        for row, (begin, end) in enumerate(pairwise(numbers)):
            if path[row, 2]:
                corners.append(middle_of_bulge(path[row : row + 2]).tolist())
                segments.append(self.new("IfcArcIndex", (begin, len(corners), end)))
            else:
                segments.append(self.new("IfcLineIndex", (begin, end)))
        points = self.new("IfcCartesianPointList2D", corners)
        return self.new("IfcIndexedPolyCurve", points, segments, False)

    def polyline(self, points_m: Array) -> entity_instance:
        """Return a line through points (n, 2)."""
        return self.new("IfcPolyline", [self.point(xy) for xy in points_m.tolist()])

    def _define(self, product: entity_instance, definition: entity_instance) -> None:
        self.join("IfcRelDefinesByProperties", [product], RelatingPropertyDefinition=definition)


class Frame:
    """The frame of a line (2, 2): x along it from its start, y to its left."""

    def __init__(self, line: FloatArray) -> None:
        self.length_m = math.dist(*line)
        self.along = (line[1] - line[0]) / self.length_m
        self._start = line[0]

    def move_here(self, polygon: Polygon) -> Polygon:
        """Return a polygon of the map in this frame."""
        return shapely.transform(
            polygon, lambda xy_m: np.asarray(self.place_here(xy_m), np.float64)
        )

    def place_here(self, xy_m: FloatArray) -> FloatArray:
        """Return places (..., 2) of the map in this frame."""
        turn = np.array([self.along, (-self.along[1], self.along[0])])
        return (xy_m - self._start) @ turn.T

    def move_circles_here(self, circles_m: FloatArray) -> FloatArray:
        """Return circles (k, 3) of the map, x and y of centre and radius, in this frame."""
        return np.column_stack([self.place_here(circles_m[:, :2]), circles_m[:, 2]])

    def placement(self, model: IfcModel) -> entity_instance:
        """Return the placement of a product in this frame, on the storey's floor."""
        return model.placement((*self._start, 0), self.along, model.storey.ObjectPlacement)


def _split_degrees(angle_deg: float) -> list[int]:
    """Return an angle as degrees, minutes, seconds and millionths of these, all of its sign.

    >>> _split_degrees(-79.5041675)
    [-79, -30, -15, -3000]
    """
    sign = -1 if angle_deg < 0 else 1
    seconds, millionths = divmod(round(abs(angle_deg) * 3600e6), 10**6)
    minutes, seconds = divmod(seconds, 60)
    return [sign * part for part in (*divmod(minutes, 60), seconds, millionths)]


def _quantity_class(name: str) -> str:
    """Return the class of a base quantity of IFC4."""
    for measure in ("Area", "Volume"):
        if name.endswith(measure):
            return f"IfcQuantity{measure}"
    return "IfcQuantityLength"
