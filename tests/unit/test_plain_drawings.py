"""Drawings of walls, holes and boxes mean what they meant before drawings could hold more."""

import json

import numpy as np
import pytest

from benchmarks import drawn_buildings
from scanplan.lab.buildings import drawing_file, drawn_floor, extrusion, truth

DEFAULTS = {
    "wall": {"material": "wall", "curved": False},
    "opening": {"frame_m": 0.0, "leaf": None},
    "furniture": {"base_m": 0.0, "type": None},
}
DRAWINGS = ("demo_office", "pavilion", "ring_office", "tiny_office", 3, 8)
TOLD = {"face", "screen", "wall", "opening", "room"}


def read(project_root, name):
    if isinstance(name, int):
        return json.loads(drawn_buildings.draw_building(name))
    return json.loads((project_root / f"config/buildings/{name}.geojson").read_bytes())


@pytest.mark.parametrize("name", DRAWINGS)
def test_defaults_that_are_written_out_change_nothing(project_root, name):
    document = read(project_root, name)
    plain = drawing_file.parse_drawing(json.dumps(document), "plain")
    for feature in document["features"]:
        feature["properties"].update(DEFAULTS.get(feature["properties"]["kind"], {}))
    full = drawing_file.parse_drawing(json.dumps(document), "full")
    assert not plain.is_detailed and not full.is_detailed
    meshes = [extrusion.make_building_mesh(plan) for plan in (plain, full)]
    for field in ("vertices_m", "triangles", "surface"):
        np.testing.assert_array_equal(*(getattr(mesh, field) for mesh in meshes))
    texts = [truth.format_features(truth.truth_features(plan, 0.4)) for plan in (plain, full)]
    assert texts[0] == texts[1]


@pytest.mark.parametrize("name", DRAWINGS)
def test_nothing_is_told_of_what_no_drawing_holds(project_root, name):
    plan = drawing_file.parse_drawing(json.dumps(read(project_root, name)), "plain")
    features = truth.truth_features(plan, 0.4)
    assert {values["kind"] for _, values in features} <= TOLD
    keys = {
        kind: {key for _, values in features if values["kind"] == kind for key in values}
        for kind in TOLD
    }
    assert keys["face"] == {"kind", "side"}
    assert keys["wall"] == {"kind", "thickness_m", "height_m"}
    assert keys["opening"] == {"kind", "type", "width_m", "sill_m", "lintel_m"}
    assert keys["room"] == {"kind", "name", "area_m2", "visited"}
    mesh = extrusion.make_building_mesh(plan)
    names = {extrusion.SURFACES[i] for i in np.unique(mesh.surface)}
    assert names <= {"wall", "floor", "ceiling", "furniture", "glass"}
    # all of the floor is floor, and walls cut for panes and for others are all of them
    assert drawn_floor.cut_walls(plan, 0.4, glass=True).is_empty
    assert drawn_floor.cut_walls(plan, 0.4).equals(drawn_floor.cut_walls(plan, 0.4, glass=False))
