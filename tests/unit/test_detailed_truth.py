"""The truth of leaves, panes, columns and others in a box of 4 m by 3 m, written down by hand."""

import numpy as np
import pytest
import shapely

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import truth
from scanplan.lab.evaluation import visible_faces
from scanplan.lab.simulation import survey_truth

GLASS = drawn.wall((0, 1.5), (4, 1.5), thickness_m=0.02, material="glass")
WALL = drawn.wall((0, 1.5), (4, 1.5), thickness_m=0.1)


def ring(x0, y0, x1, y1):
    return [[[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]]


def of_kind(plan, kind, **seen):
    return [(g, v) for g, v in truth.truth_features(plan, 0.4, **seen) if v["kind"] == kind]


def screen_bounds(plan, **seen):
    screens = [line for line, _ in of_kind(plan, "screen", **seen)]
    return shapely.total_bounds(screens) if screens else None


def test_a_leaf_is_told_with_its_opening_and_occludes():
    plan = drawn.plan(WALL, drawn.door(1.0, -0.1), drawn.door(2.0, 1.5, leaf="hinged", open_deg=90))
    ((line, values),) = of_kind(plan, "leaf")
    np.testing.assert_allclose(line.coords, [(1.525, 1.55), (1.525, 2.54)])
    assert values == {
        "kind": "leaf",
        "type": "hinged",
        "open_deg": 90.0,
        "open_share": 0.0,
        "thickness_m": 0.04,
        "height_m": 1.995,
        "width_m": 0.99,
        "opening": 1,
        "glass": False,
    }
    assert screen_bounds(plan) == pytest.approx((1.505, 1.55, 1.545, 2.54), abs=1e-5)


def test_a_shut_leaf_occludes_and_one_of_glass_does_not():
    shut = drawn.plan(WALL, drawn.door(2.0, 1.5, leaf="hinged"))
    assert screen_bounds(shut) == pytest.approx((1.505, 1.51, 2.495, 1.55), abs=1e-5)
    assert (
        screen_bounds(drawn.plan(WALL, drawn.door(2.0, 1.5, leaf="hinged", leaf_glass=True)))
        is None
    )


def test_openings_tell_panes_and_frames_only_where_a_drawing_has_such_things():
    window = drawn.door(2, 3.1, type="window", sill_m=0.9, glazed=True)
    ((_, plain),) = of_kind(drawn.plan(window), "opening")
    assert "glazed" not in plain and of_kind(drawn.plan(window), "pane") == []
    plan = drawn.plan(window, drawn.door(1.0, -0.1, frame_m=0.05))
    (_, first), (_, second) = of_kind(plan, "opening")
    assert (first["glazed"], second["glazed"]) == (True, False)
    assert second["frame_m"] == 0.05 and "frame_m" not in first
    ((line, values),) = of_kind(plan, "pane")
    assert line.length == pytest.approx(1.0)
    assert values == {"kind": "pane", "sill_m": 0.9, "lintel_m": 2.0}


def test_faces_of_a_pane_are_glass_and_those_of_walls_are_not():
    faces = of_kind(drawn.plan(GLASS), "face")
    glass = [line for line, v in faces if v.get("material") == "glass"]
    assert sorted(line.centroid.y for line in glass) == pytest.approx([1.49, 1.51])
    assert [line.length for line in glass] == pytest.approx([4.0, 4.0])
    assert sum(v["side"] == "inside" for _, v in faces) == 2 + 6
    ((_, values),) = [f for f in of_kind(drawn.plan(GLASS), "wall") if "material" in f[1]]
    assert values["material"] == "glass"


def test_a_pane_that_goes_on_in_line_with_a_wall_as_thick_parts_the_face():
    walls = [
        drawn.wall((0, 1.5), (1.5, 1.5), thickness_m=0.05),
        drawn.wall((1.5, 1.5), (4, 1.5), thickness_m=0.05, material="glass"),
    ]
    faces = [
        (g, v)
        for g, v in of_kind(drawn.plan(*walls), "face")
        if g.bounds[1] > 1.4 and g.bounds[3] < 1.6
    ]
    lengths = sorted((round(g.length, 2), v.get("material", "wall")) for g, v in faces)
    assert lengths == [(1.5, "wall"), (1.5, "wall"), (2.5, "glass"), (2.5, "glass")]
    # and the wall stays on the left
    for line, _ in faces:
        (x0, _), (x1, _) = line.coords
        assert (x1 < x0) == (line.centroid.y > 1.5)


def test_panes_of_a_glass_wall_are_what_its_door_leaves():
    into_walls = drawn.wall((-0.1, 1.5), (4.1, 1.5), thickness_m=0.02, material="glass")
    panes = of_kind(drawn.plan(into_walls, drawn.door(2.0, 1.5)), "pane")
    found = sorted((round(g.length, 2), v["sill_m"], v["lintel_m"]) for g, v in panes)
    assert found == [(1.0, 2.0, 2.5), (1.5, 0.0, 2.5), (1.5, 0.0, 2.5)]


def test_walls_are_seen_through_panes():
    plan = drawn.plan(GLASS)
    features = truth.truth_features(plan, 0.4)
    pose = np.eye(4)[None].copy()
    pose[0, :3, 3] = 2.0, 0.5, 0.4
    marked = survey_truth.mark_visible(features, pose, visible_faces.SensorView(30.0))
    visible_m = {
        (v.get("material"), round(line.centroid.x, 2), round(line.centroid.y, 2)): v["visible_m"]
        for line, v in marked
        if v["kind"] == "face" and v["side"] == "inside"
    }
    assert visible_m["glass", 2.0, 1.49] == pytest.approx(4.0)
    assert visible_m["glass", 2.0, 1.51] == pytest.approx(0.0)
    assert visible_m[None, 2.0, 3.0] == pytest.approx(4.0)


def test_a_column_hides_the_wall_behind_it():
    column = drawn.feature("column", "Polygon", ring(1.8, 1.0, 2.2, 1.4), type="column")
    plan = drawn.plan(column)
    ((polygon, values),) = of_kind(plan, "column")
    assert polygon.area == pytest.approx(0.16)
    assert values == {"kind": "column", "type": "column", "height_m": 2.5}
    assert screen_bounds(plan) == pytest.approx((1.8, 1.0, 2.2, 1.4), abs=1e-5)
    # no face of the truth is the column's
    assert len(of_kind(plan, "face")) == len(of_kind(drawn.plan(), "face"))


def test_a_pilaster_is_a_screen_without_its_back():
    pilaster = drawn.feature("column", "Polygon", ring(1.8, 2.9, 2.2, 3.05), type="pilaster")
    lengths = [line.length for line, _ in of_kind(drawn.plan(pilaster), "screen")]
    assert sorted(lengths) == pytest.approx([0.1, 0.1, 0.4], abs=1e-4)


def test_furniture_voids_stairs_beams_and_mirrors_are_told():
    things = [
        drawn.feature("furniture", "Polygon", ring(0, 2, 1, 3), height_m=2.0, type="cupboard"),
        drawn.feature("furniture", "Polygon", ring(2, 2, 3, 3), height_m=0.7, base_m=0.6),
        drawn.feature("void", "Polygon", ring(3, 2, 4, 3)),
        drawn.feature("stairs", "Polygon", ring(3, 2, 4, 3), rise_m=-2.0, steps=8),
        drawn.feature("beam", "Polygon", ring(1, 0, 1.2, 3), underside_m=2.2),
        drawn.feature("mirror", "LineString", [[3, 0], [3.5, 0]], sill_m=0.5, lintel_m=1.5),
    ]
    plan = drawn.plan(*things, way=drawn.way((0.5, 1), (1, 1)))
    told = {
        kind: [
            {k: v for k, v in values.items() if k != "kind"} for _, values in of_kind(plan, kind)
        ]
        for kind in ("furniture", "void", "stairs", "beam", "mirror")
    }
    assert told == {
        "furniture": [{"type": "cupboard", "base_m": 0.0, "height_m": 2.0}],
        "void": [{"depth_m": 3.0}],
        "stairs": [{"rise_m": -2.0, "steps": 8}],
        "beam": [{"underside_m": 2.2}],
        "mirror": [{"sill_m": 0.5, "lintel_m": 1.5}],
    }


def test_what_hangs_above_the_slice_is_no_screen_to_a_planar_scanner():
    table = {"height_m": 0.75, "type": "table"}
    for base_m, n_screens in ((0.0, 4), (0.7, 0)):
        box = drawn.feature("furniture", "Polygon", ring(1, 1, 2, 2), base_m=base_m, **table)
        assert len(of_kind(drawn.plan(box), "screen", planar=True)) == n_screens


def test_only_steps_as_high_as_the_slice_are_screens_to_a_planar_scanner():
    flight = [[[1, 0], [1, 1], [3, 1], [3, 0], [1, 0]]]
    stairs = drawn.feature("stairs", "Polygon", flight, rise_m=0.8, steps=4)
    bounds = screen_bounds(drawn.plan(stairs), planar=True)
    assert bounds == pytest.approx((1.5, 0.0, 3.0, 1.0), abs=1e-5)


def test_curved_walls_and_their_faces_say_so():
    turns = np.linspace(0, np.pi / 2, 16)
    arc = [(2 * np.cos(t), 2 * np.sin(t)) for t in turns]
    plan = drawn.plan(drawn.wall(*arc, curved=True))
    curved = [line for line, v in of_kind(plan, "face") if v.get("curved")]
    assert shapely.union_all(curved).length == pytest.approx(2 * np.pi * (1.9 + 2.1) / 4, abs=0.25)
    assert sum("curved" in v for _, v in of_kind(plan, "wall")) == 15
    assert len(of_kind(plan, "wall")) == 15 + 4


def test_a_tapering_wall_tells_both_thicknesses():
    plan = drawn.plan(drawn.wall((0, 1.5), (4, 1.5), thickness_m=0.1, end_thickness_m=0.3))
    ((_, values),) = [f for f in of_kind(plan, "wall") if "end_thickness_m" in f[1]]
    assert (values["thickness_m"], values["end_thickness_m"]) == (0.1, 0.3)


def test_what_is_outside_is_no_truth():
    outside = [
        drawn.feature("ground", "Polygon", ring(-20, -20, 20, 20)),
        drawn.feature("facade", "LineString", [[10, -5], [10, 8]], height_m=12.0),
    ]
    assert truth.truth_features(drawn.plan(*outside), 0.4) == truth.truth_features(
        drawn.plan(), 0.4
    )
