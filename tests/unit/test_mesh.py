"""trimesh reads the 3-D model, and it is as large as the plan."""

import io

import numpy as np
import pytest
import trimesh

from helpers import floorplan_making
from helpers.floorplan_making import FOOTPRINT_M2, HEIGHT_M, VOID_M3, bare, plan
from scanplan.exports.data import element_ids, mesh
from scanplan.exports.sheet.locale import make_locale
from scanplan.project.words_file import read_words


def read(drawn):
    content = mesh.format_glb(drawn, element_ids.ids_from_places(drawn))
    return trimesh.load_scene(io.BytesIO(content), file_type="glb")


def test_walls_have_the_volume_of_the_plan_less_its_openings():
    walls = [g for name, g in read(plan()).geometry.items() if name.startswith("Wall")]
    assert len(walls) == 6
    volume_m3 = FOOTPRINT_M2 * HEIGHT_M - VOID_M3
    assert sum(wall.volume for wall in walls) == pytest.approx(volume_m3, rel=1e-3)


def test_a_wall_without_openings_is_closed_and_faces_outwards():
    wall = read(plan()).geometry["Wall 1"]
    assert wall.is_watertight and wall.is_winding_consistent and wall.volume > 0


def test_it_lies_where_the_plan_does_with_y_up():
    low, high = read(plan()).bounds
    assert low == pytest.approx([-0.2, 0.0, -3.2], abs=1e-5)
    assert high == pytest.approx([7.2, HEIGHT_M, 0.2], abs=1e-5)


def test_objects_have_names_ids_and_materials():
    drawn = plan()
    scene = read(drawn)
    names = [f"Wall {n}" for n in range(6)] + ["Door 0", "Door 1", "Window 2", "Room 0", "Room 1"]
    assert list(scene.geometry) == names
    ids = element_ids.ids_from_places(drawn)
    assert scene.geometry["Room 0"].area == pytest.approx(12.0)
    extras = scene.graph.transforms.edge_data["world", "Door 1"]["metadata"]
    assert extras["global_id"] == ids["opening"][1]
    colours = {n: scene.geometry[n].visual.material.name for n in ("Wall 0", "Wall 2", "Window 2")}
    assert colours == {"Wall 0": "wall", "Wall 2": "to verify", "Window 2": "window"}


@pytest.mark.wording
def test_objects_and_materials_are_named_in_the_language():
    german = make_locale("m", read_words("de"))
    drawn = plan(room_word=german.say("Room"))
    content = mesh.format_glb(drawn, element_ids.ids_from_places(drawn), locale=german)
    shapes = trimesh.load_scene(io.BytesIO(content), file_type="glb").geometry
    assert {"Wand 1", "Tür 0", "Fenster 2", "Raum 1"} < set(shapes)
    assert shapes["Wand 2"].visual.material.name == "zu prüfen"


def test_a_doubtful_door_is_shown_as_such():
    openings = floorplan_making.openings() | {"verify": np.array([True, False, False])}
    scene = read(plan(openings=openings))
    colours = [scene.geometry[n].visual.material.name for n in ("Door 0", "Door 1")]
    assert colours == ["to verify", "door"]


def test_a_passage_is_a_hole_with_nothing_in_it():
    openings = floorplan_making.openings() | {"type": np.array(["passage"] * 3, object)}
    assert not [n for n in read(plan(openings=openings)).geometry if n.startswith("Passage")]


def test_a_plan_of_faces_alone_is_an_empty_model():
    content = mesh.format_glb(bare(), element_ids.ids_from_places(bare()))
    assert content.startswith(b"glTF") and b'"nodes":[]' in content
