"""A building of any kind of file as a simulation needs it: surfaces, truth, ground to drive on."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.design.storey_choice import find_storey
from scanplan.errors import StageError
from scanplan.lab.buildings import drawing_file, drawn_floor, extrusion, ground, storeys, truth
from scanplan.lab.buildings.tolerances import DECIMALS
from scanplan.types import FilePath, FloatArray

if TYPE_CHECKING:
    from scanplan.design.ifc_file import IfcBuilding

DOORS = ("open", "closed")
WINDOWS = ("glass", "empty")
MESH_SUFFIXES = (".stl", ".obj", ".ply")


@dataclass(frozen=True)
class Building:
    """One floor in the map frame: metres, z up, the floor at z = 0.

    Attributes
    ----------
    mesh : extrusion.Mesh
    truth : list of (geometry, dict)
        As `truth.truth_features`; no room is marked visited.
    rooms : list of (str, Polygon)
        Name and floor.
    floor_m : Polygon or MultiPolygon
        Where there is floor, within the outer walls.
    obstacles_m : shapely geometry
        What stands on it up to the sensor's height.
    waypoints_m : (n, 2) float64 or None
        The way that the file gives.
    notes : tuple of str
        What is odd in the file and used all the same.
    doorways : tuple of (int, DrawnOpening)
        Doors without a leaf: row among the openings of the truth, and the hole.
    """

    mesh: extrusion.Mesh
    truth: list[truth.Feature]
    rooms: list[tuple[str, Polygon]]
    floor_m: BaseGeometry
    obstacles_m: BaseGeometry
    waypoints_m: FloatArray | None
    notes: tuple[str, ...] = ()
    doorways: tuple[storeys.Doorway, ...] = ()


@dataclass(frozen=True)
class FileReading:
    """What a file leaves open; of drawings nothing.

    Attributes
    ----------
    storey : str, int or None
        Of a building model: name, or index from below; may be None where there is one.
    unit : str
        Of a mesh: `m`, `cm`, `mm`, `in` or `ft`. The other formats state theirs.
    floor_z_m : float
        Of a mesh: the height of the floor to drive on, in metres of its own frame.
    doors : str
        Of a building model: `open` leaves out doors with their frames, `closed` keeps them.
    windows : str
        Of a building model: `glass` keeps windows, their panes marked as glass, `empty` leaves
        them out.
    """

    storey: str | int | None = None
    unit: str = "m"
    floor_z_m: float = 0.0
    doors: str = "open"
    windows: str = "glass"

    def __post_init__(self) -> None:
        if self.doors not in DOORS or self.windows not in WINDOWS:
            raise ValueError(
                f"doors {self.doors!r} is none of {DOORS}, or windows {self.windows!r} none of"
                f" {WINDOWS}"
            )


AS_STATED = FileReading()


def load_building(
    data: bytes,
    source: Path,
    *,
    slice_height_m: float,
    planar: bool = False,
    reading: FileReading = AS_STATED,
) -> Building:
    """Read a building from a drawing (.geojson), a mesh (.stl, .obj, .ply) or a model (.ifc).

    Parameters
    ----------
    data : bytes
        The file's content.
    source : pathlib.Path
        The file's name: its suffix is that of the format, errors name it.
    slice_height_m : float
        Height above the floor at which wall faces are cut, the sensor's.
    planar : bool
        Whether all beams of the sensor are level, so that low furniture occludes walls, too.

    Returns
    -------
    Building

    Raises
    ------
    StageError
        In one line, if the file cannot be used.
    """
    suffix = source.suffix.lower()
    if suffix in (".geojson", ".json"):
        plan = drawing_file.parse_drawing(data, source)
        return _building_of_drawing(plan, slice_height_m, planar)
    if suffix in MESH_SUFFIXES:
        return _load_mesh(data, source, reading, slice_height_m, planar)
    if suffix == ".ifc":
        return _load_model(data, source, reading, slice_height_m, planar)
    raise StageError(
        f"{source}: is no building; accepted are .geojson (a drawing),"
        f" {', '.join(MESH_SUFFIXES)} (meshes) and .ifc"
    )


def building_of_model(
    model: "IfcBuilding",
    index: int,
    slice_height_m: float,
    source: FilePath,
    *,
    reading: FileReading = AS_STATED,
    planar: bool = False,
) -> Building:
    """Return one storey of a building model that is read already; as `load_building` otherwise."""
    storey = storeys.storey_of_model(model, index, doors=reading.doors, windows=reading.windows)
    if reading.doors == "closed":
        storey = replace(storey, doorways=())
    if not 0 < slice_height_m < storey.height_m:
        raise StageError(
            f"{source}: the sensor is {slice_height_m:g} m above the floor, and the next storey's"
            f" floor {storey.height_m:g} m; lower simulate.mount.height_m"
        )
    return _building_of_storey(storey, slice_height_m, source, model.notes, planar)


def _building_of_drawing(
    plan: drawn_floor.DrawnFloor, slice_height_m: float, planar: bool
) -> Building:
    return Building(
        mesh=extrusion.make_building_mesh(plan),
        truth=truth.truth_features(plan, slice_height_m, planar=planar),
        rooms=drawn_floor.floor_rooms(plan),
        floor_m=drawn_floor.floor_footprint(plan),
        obstacles_m=drawn_floor.floor_obstacles(plan, slice_height_m),
        waypoints_m=plan.waypoints_m,
        doorways=tuple(
            (row, opening)
            for row, opening in enumerate(plan.openings)
            if opening.type == "door" and opening.leaf is None and not opening.glazed
        ),
    )


def _load_mesh(
    data: bytes, source: Path, reading: FileReading, slice_height_m: float, planar: bool
) -> Building:
    # imported here so that the demo does not wait a second for a reader that it has no use for
    from scanplan.lab.buildings import mesh_file

    triangles_m, notes = mesh_file.parse_mesh(
        data, source.suffix.lower(), source, unit=reading.unit
    )
    on_floor_m = triangles_m - [0.0, 0.0, reading.floor_z_m]
    storey = storeys.storey_of_mesh(on_floor_m, slice_height_m, source)
    return _building_of_storey(storey, slice_height_m, source, notes, planar)


def _load_model(
    data: bytes, source: Path, reading: FileReading, slice_height_m: float, planar: bool
) -> Building:
    from scanplan.design import ifc_file

    model = ifc_file.parse_ifc(data, source)
    index = find_storey(model.storeys, reading.storey, source, "simulate.site.storey")
    return building_of_model(model, index, slice_height_m, source, reading=reading, planar=planar)


def _building_of_storey(
    storey: storeys.Storey,
    slice_height_m: float,
    source: FilePath,
    notes: tuple[str, ...],
    planar: bool,
) -> Building:
    cut = ground.cut_storey(storey, slice_height_m, source, planar=planar)
    walls = ground.find_storey_walls(storey, cut, slice_height_m)
    features = [truth.face_feature(line, side) for line, side in cut.faces]
    features += [truth.screen_feature(line) for line in cut.screens]
    height_m = round(cut.height_m, DECIMALS)
    for line, thickness_m in walls:
        features.append(truth.wall_feature(line, round(thickness_m, DECIMALS), height_m))
    features += [truth.opening_feature(*opening) for opening in storey.openings]
    surfaces = [surface for body in storey.bodies for surface in body.surfaces]
    return Building(
        mesh=extrusion.join_meshes(surfaces),
        truth=features + truth.room_features(cut.rooms),
        rooms=cut.rooms,
        floor_m=cut.floor_m,
        obstacles_m=cut.obstacles_m,
        waypoints_m=None,
        notes=(*notes, *cut.notes),
        doorways=storey.doorways,
    )
