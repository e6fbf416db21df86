"""A building of any kind of file as a simulation needs it: what rays hit, what is true, where a rover can be."""

from dataclasses import dataclass, replace

import numpy as np

from scanplan.errors import StageError
from scanplan.lab.buildings import drawing_file, drawn_floor, extrusion, ground, storeys, truth
from scanplan.lab.buildings.route import KINDS, plan_route
from scanplan.lab.simulation import rover

DOORS = ("open", "closed")
WINDOWS = ("glass", "empty")
MESH_SUFFIXES = (".stl", ".obj", ".ply")
GIVEN_WAY = "simulate.site.waypoints_m"


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
        What was odd in the file and is used all the same.
    """

    mesh: extrusion.Mesh
    truth: list
    rooms: list
    floor_m: object
    obstacles_m: object
    waypoints_m: np.ndarray | None
    notes: tuple = ()


def load_building(
    data,
    source,
    *,
    slice_height_m,
    storey=None,
    unit="m",
    floor_z_m=0.0,
    doors="open",
    windows="glass",
):
    """Read a building from a drawing (.geojson), a mesh (.stl, .obj, .ply) or a building model (.ifc).

    Parameters
    ----------
    data : bytes
        The file's content.
    source : pathlib.Path
        The file's name: its suffix tells the format, errors name it.
    slice_height_m : float
        Height above the floor at which wall faces are cut, the sensor's.
    storey : str, int or None
        Of a building model: name, or index from below; may be None where there is one.
    unit : str
        Of a mesh: `m`, `cm`, `mm`, `in` or `ft`. The other formats tell theirs.
    floor_z_m : float
        Of a mesh: the height of the floor to drive on, in metres of its own frame.
    doors : str
        Of a building model: `open` leaves out doors with their frames, `closed` keeps them.
    windows : str
        Of a building model: `glass` keeps windows, their panes marked as glass, `empty` leaves them out.

    Returns
    -------
    Building

    Raises
    ------
    StageError
        In one line, if the file cannot be used.
    """
    if doors not in DOORS or windows not in WINDOWS:
        raise ValueError(
            f"doors {doors!r} is none of {DOORS}, or windows {windows!r} none of {WINDOWS}"
        )
    suffix = source.suffix.lower()
    if suffix in (".geojson", ".json"):
        return _of_drawing(drawing_file.parse_drawing(data, source), slice_height_m)
    if suffix in MESH_SUFFIXES:
        return _of_mesh(data, source, suffix, unit, floor_z_m, slice_height_m)
    if suffix == ".ifc":
        return _of_model(data, source, storey, doors, windows, slice_height_m)
    raise StageError(
        f"{source}: is no building; accepted are .geojson (a drawing), {', '.join(MESH_SUFFIXES)} (meshes) and .ifc"
    )


def plan_building_route(
    found, source, *, route, clearance_m, reach_m=0.0, waypoints_m=None, start_m=None, seed=0
):
    """Give a building the rover's way, and its truth which rooms that visits.

    Parameters
    ----------
    found : Building
    source : path-like
        What errors name as their origin.
    route : str
        `given`: by `waypoints_m`, else the file's own way, else as `rooms`; `rooms`, `hallways`: see `route.plan_route`.
    clearance_m : float
        What a planned way keeps from any obstacle.
    reach_m : float
        How far the sensor sits from the rover's middle, which any way keeps too.
    waypoints_m : (n, 2) float or None
        Corners of the way.
    start_m : (2,) float, "random" or None
        Where a planned way begins, see `route.plan_route`.
    seed : int
        Of a random start.

    Returns
    -------
    Building

    Raises
    ------
    StageError
        If the way leads through walls or furniture, none can be planned, or it is both given and to be planned.
    """
    if route not in KINDS:
        raise ValueError(f"route {route!r} is none of {', '.join(KINDS)}")
    if waypoints_m is not None and (route != "given" or start_m is not None):
        raise StageError(
            f"{GIVEN_WAY}: they are given, and route {route} with start_m {start_m}; keep route: given and"
            " start_m: null, or leave out waypoints_m"
        )
    if route == "given" and start_m is not None and found.waypoints_m is not None:
        raise StageError(
            f"simulate.site.start_m: {start_m} is where a planned way begins, and the file gives one; set route:"
            " rooms or hallways"
        )
    way_m, notes = found.waypoints_m if waypoints_m is None else np.array(waypoints_m, float), ()
    if route != "given" or way_m is None:
        kind = "rooms" if route == "given" else route
        clearance_m = max(clearance_m, reach_m)
        here = (found.floor_m, found.obstacles_m, found.rooms)
        planned = plan_route(
            *here, source, kind=kind, clearance_m=clearance_m, start_m=start_m, seed=seed
        )
        way_m, notes = planned.waypoints_m, _told(planned, source)
    given = source if waypoints_m is None else f"{GIVEN_WAY}: in {source}"
    rover.check_way(way_m, found.floor_m, found.obstacles_m, given, reach_m=reach_m)
    return replace(
        found,
        waypoints_m=way_m,
        truth=truth.mark_visited(found.truth, way_m),
        notes=(*found.notes, *notes),
    )


def _told(planned, source):
    count = len(planned.reached) + len(planned.missed)
    missed = f"; cannot be reached: {', '.join(planned.missed)}" if planned.missed else ""
    return (f"{source}: planned a way through {len(planned.reached)} of {count} rooms{missed}",)


def _of_drawing(plan, slice_height_m):
    return Building(
        mesh=extrusion.make_building_mesh(plan),
        truth=truth.truth_features(plan, slice_height_m),
        rooms=drawn_floor.floor_rooms(plan),
        floor_m=drawn_floor.floor_footprint(plan),
        obstacles_m=drawn_floor.floor_obstacles(plan, slice_height_m),
        waypoints_m=plan.waypoints_m,
    )


def _of_mesh(data, source, suffix, unit, floor_z_m, slice_height_m):
    # imported here so that the demo does not wait a second for a reader it has no use for
    from scanplan.lab.buildings import mesh_file

    triangles_m, notes = mesh_file.parse_mesh(data, suffix, source, unit=unit)
    storey = storeys.storey_of_mesh(triangles_m - [0.0, 0.0, floor_z_m], slice_height_m, source)
    return _of_storey(storey, slice_height_m, source, notes)


def _of_model(data, source, chosen, doors, windows, slice_height_m):
    from scanplan.lab.buildings import ifc_file

    model = ifc_file.parse_ifc(data, source)
    index = ifc_file.find_storey(model, chosen, source)
    return building_of_model(model, index, slice_height_m, source, doors=doors, windows=windows)


def building_of_model(model, index, slice_height_m, source, *, doors="open", windows="glass"):
    """Return one storey of an ifc_file.IfcBuilding that is read already; as `load_building` otherwise."""
    storey = storeys.storey_of_model(model, index, doors=doors, windows=windows)
    if not 0 < slice_height_m < storey.height_m:
        raise StageError(
            f"{source}: the sensor is {slice_height_m:g} m above the floor, and the next storey's floor"
            f" {storey.height_m:g} m; lower simulate.mount.height_m"
        )
    return _of_storey(storey, slice_height_m, source, model.notes)


def _of_storey(storey, slice_height_m, source, notes):
    cut = ground.cut_storey(storey, slice_height_m, source)
    faces = [(line, {"kind": "face", "side": side}) for line, side in cut.faces]
    faces += [(line, {"kind": "screen"}) for line in cut.screens]
    walls = [
        (line, {"kind": "wall", "thickness_m": round(thick, 6), "height_m": round(cut.height_m, 6)})
        for line, thick in ground.find_storey_walls(storey, cut, slice_height_m)
    ]
    openings = [truth.opening_feature(*opening) for opening in storey.openings]
    return Building(
        mesh=extrusion.join_meshes([soup for body in storey.bodies for soup in body.surfaces]),
        truth=faces + walls + openings + truth.room_features(cut.rooms),
        rooms=cut.rooms,
        floor_m=cut.floor_m,
        obstacles_m=cut.obstacles_m,
        waypoints_m=None,
        notes=(*notes, *cut.notes),
    )
