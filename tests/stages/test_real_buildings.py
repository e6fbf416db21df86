"""Published building models, every storey: their parts, and truth that lies on what rays hit."""

import functools

import numpy as np
import open3d as o3d
import pytest
import shapely

from scanplan.design import ifc_file
from scanplan.design.storey_choice import find_storey
from scanplan.errors import StageError
from scanplan.lab.buildings import building, building_route

pytestmark = pytest.mark.recordings
SLICE_M = 0.4
# walls at the slice, doors, windows, rooms; the rooms that a way enters, None without a floor
FZK = {"Erdgeschoss": (9, 5, 9, 6, 6), "Dachgeschoss": (4, 0, 2, 1, 1)}
DUPLEX = {
    "T/FDN": (7, 0, 0, 2, None),
    "Level 1": (21, 6, 4, 10, 5),
    "Level 2": (25, 8, 18, 10, 5),
    "Roof": (4, 0, 0, 1, None),
}


@pytest.fixture(scope="module")
def models(recordings_dir):
    names = {"fzk": "AC20-FZK-Haus.ifc", "duplex": "duplex.ifc"}
    return {
        key: ifc_file.parse_ifc((recordings_dir / "buildings" / name).read_bytes(), name)
        for key, name in names.items()
    }


WAY = building_route.WaySettings("rooms", clearance_m=0.25)


@pytest.fixture(scope="module")
def storey_of(models):
    """Give a storey of a model, cut once for all tests."""

    @functools.cache
    def cut(name, storey):
        index = find_storey(models[name].storeys, storey, name, "simulate.site.storey")
        return building.building_of_model(models[name], index, SLICE_M, name)

    return cut


def off_the_mesh(found):
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    vertices, triangles = (
        found.mesh.vertices_m.astype(np.float32),
        found.mesh.triangles.astype(np.uint32),
    )
    scene.add_triangles(o3d.core.Tensor(vertices), o3d.core.Tensor(triangles))
    faces = [g for g, values in found.truth if values["kind"] == "face"]
    xy = np.concatenate([shapely.get_coordinates(g.segmentize(0.1)) for g in faces])
    points = np.column_stack([xy, np.full(len(xy), SLICE_M)]).astype(np.float32)
    return scene.compute_distance(o3d.core.Tensor(points)).numpy().max()


@pytest.mark.parametrize(
    ("name", "storey", "expected"),
    [
        *(("fzk", *known) for known in FZK.items()),
        *(("duplex", *known) for known in DUPLEX.items()),
    ],
)
def test_a_storey_has_its_parts_and_its_truth(storey_of, name, storey, expected):
    n_walls, n_doors, n_windows, n_rooms, n_reached = expected
    found = storey_of(name, storey)
    kinds = [values["kind"] for _, values in found.truth]
    types = [values["type"] for _, values in found.truth if values["kind"] == "opening"]
    assert (types.count("door"), types.count("window"), kinds.count("room")) == (
        n_doors,
        n_windows,
        n_rooms,
    )
    assert kinds.count("wall") >= n_walls
    assert off_the_mesh(found) < 1e-3
    if n_reached is None:
        with pytest.raises(StageError, match="can be entered"):
            building_route.plan_building_route(found, name, WAY)
        return
    driven = building_route.plan_building_route(found, name, WAY)
    assert (
        sum(values["visited"] for _, values in driven.truth if values["kind"] == "room")
        >= n_reached
    )
    assert shapely.LineString(driven.waypoints_m).distance(found.obstacles_m) >= 0.25


def test_walls_are_as_thick_as_their_layers(storey_of):
    found = storey_of("fzk", "Erdgeschoss")
    walls = [
        (g.length, values["thickness_m"]) for g, values in found.truth if values["kind"] == "wall"
    ]
    assert sorted(thickness for _, thickness in walls) == [0.24] * 5 + [0.3] * 4
    outside = [g.length for g, values in found.truth if values.get("side") == "outside"]
    # 12 m x 10 m, less the front door's 1.01 m and the terrace door's 2.01 m
    assert sum(outside) == pytest.approx(44 - 1.01 - 2.01, abs=0.02)


def test_a_building_of_two_storeys_asks_which(models):
    with pytest.raises(
        StageError, match=r"0 'Erdgeschoss' at 0\.00 m, 1 'Dachgeschoss' at 2\.70 m"
    ):
        find_storey(models["fzk"].storeys, None, "AC20-FZK-Haus.ifc", "simulate.site.storey")
