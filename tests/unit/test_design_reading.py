"""Designs read of IFC and DXF files made here: one room of 4 m x 3 m, or two."""

from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import shapely

from helpers import ifc_making
from helpers.refusals import refused
from scanplan.design import design_reading, ifc_design, ifc_file
from scanplan.design.design_plan import make_plan
from scanplan.design.layer_words import kind_of_layer

OUTER = [(0, 0), (7.2, 0), (7.2, 3.4), (0, 3.4)]
ROOMS = [[(0.2, 0.2), (4.2, 0.2), (4.2, 3.2), (0.2, 3.2)], [(4.3, 0.2), (7.0, 0.2), (7.0, 3.2)]]
ROOMS[1].append((4.3, 3.2))
DOOR = (4.2, 1.0, 4.3, 1.9)
WINDOW = (1.0, 0.0, 2.2, 0.2)


@pytest.mark.parametrize("millimetres", [False, True])
def test_a_building_model_gives_walls_openings_and_rooms_in_metres(millimetres):
    model = ifc_file.parse_ifc(ifc_making.model(millimetres=millimetres), "made.ifc")
    (storey,) = ifc_design.list_storeys(model)
    assert (storey.name, storey.floor_m) == ("Ground", 0.0)
    assert {wall.name for wall in storey.walls} == set(ifc_making.WALLS)
    assert [wall.thickness_m for wall in storey.walls] == pytest.approx([0.2] * 4)
    openings = {opening.kind: opening for opening in storey.openings}
    assert set(openings) == {"door", "window"}
    for kind, (_, low, high, sill_m, lintel_m) in ifc_making.OPENINGS.items():
        line_m = openings[kind].line_m
        assert sorted(line_m[:, 0]) == pytest.approx([low, high], abs=1e-6)
        assert line_m[:, 1] == pytest.approx([-0.1, -0.1], abs=1e-6)
        heights_m = (openings[kind].sill_m, openings[kind].lintel_m)
        assert heights_m == pytest.approx((sill_m, lintel_m))
    assert [space.area.area for space in storey.spaces] == pytest.approx([12.0])


def test_storeys_stand_on_their_floors():
    model = ifc_file.parse_ifc(ifc_making.model(("Ground", "Upper")), "made.ifc")
    ground, upper = ifc_design.list_storeys(model)
    assert upper.floor_m == pytest.approx(ifc_making.HEIGHT_M + 0.2)
    assert upper.walls[0].solid.low_m == pytest.approx(ground.walls[0].solid.low_m, abs=1e-6)
    assert len(ground.walls) == len(upper.walls) == 4


def test_an_opening_over_no_ground_is_left_out():
    model = ifc_file.parse_ifc(ifc_making.model(), "made.ifc")
    flat = [
        replace(part, triangles_m=part.triangles_m * [1, 0, 1]) if part.fills == "window" else part
        for part in model.parts
    ]
    (storey,) = ifc_design.list_storeys(replace(model, parts=tuple(flat)))
    assert [opening.kind for opening in storey.openings] == ["door"]


@pytest.fixture
def drawn(tmp_path):
    def draw(unit=4, walls="A-WALL", *, door=True):
        scale = {4: 1000.0, 5: 100.0, 6: 1.0, 0: 1.0}[unit]
        document = ezdxf.new()
        document.units = unit
        space = document.modelspace()

        def ring(corners, layer):
            scaled = [(scale * x, scale * y) for x, y in corners]
            space.add_lwpolyline(scaled, close=True, dxfattribs={"layer": layer})

        def box(line, layer):
            x0, y0, x1, y1 = line
            ring([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], layer)

        # walls are drawn without what their openings take
        x0, y0, x1, y1 = DOOR
        ring(OUTER, walls)
        ring(
            [
                *(ROOMS[0][0], (4.2, 0.2), (x0, y0), (x1, y0), (4.3, 0.2), ROOMS[1][1]),
                *(ROOMS[1][2], ROOMS[1][3], (x1, y1), (x0, y1), (4.2, 3.2), ROOMS[0][3]),
            ],
            walls,
        )
        box(WINDOW, walls)
        box(WINDOW, "A-GLAZ")
        if door:
            box(DOOR, "A-DOOR")
        for room in ROOMS:
            ring(room, "A-AREA")
        path = tmp_path / "design.dxf"
        document.saveas(path)
        return path

    return draw


@pytest.mark.parametrize("unit", [4, 5, 6])
def test_a_drawing_gives_walls_between_their_sides_in_metres(drawn, unit):
    (storey,) = design_reading.read_design(drawn(unit))
    thick_m = sorted(round(wall.thickness_m, 6) for wall in storey.walls)
    assert thick_m == [0.1, 0.2, 0.2, 0.2, 0.2]
    (inner,) = [wall for wall in storey.walls if wall.thickness_m < 0.15]
    assert np.abs(inner.line_m[:, 0] - 4.25).max() < 1e-6
    assert [round(space.area.area, 6) for space in storey.spaces] == [12.0, 8.1]
    door = next(o for o in storey.openings if o.kind == "door")
    assert storey.walls[door.wall] is inner
    assert sorted(door.line_m[:, 1]) == pytest.approx([1.0, 1.9])


def test_a_gap_in_which_nothing_is_drawn_is_a_passage(drawn):
    (storey,) = design_reading.read_design(drawn(door=False))
    assert "passage" in {opening.kind for opening in storey.openings}


def test_a_drawing_without_unit_or_walls_is_refused_with_the_remedy(drawn):
    with refused(value="no unit", remedy="in metres"):
        design_reading.read_design(drawn(0))
    with refused(value="no wall", remedy="its layers"):
        design_reading.read_design(drawn(walls="0"))


def test_a_drawing_in_no_known_unit_is_refused(drawn):
    path = drawn()
    document = ezdxf.filemanagement.readfile(path)
    document.header["$INSUNITS"] = 99
    document.saveas(path)
    with refused(file="design.dxf", value=99) as fault:
        design_reading.read_design(path)
    assert "\n" not in str(fault.value)


@pytest.mark.parametrize("n_blocks", [1, 2, 40])
def test_blocks_that_insert_one_another_are_refused_in_one_line(drawn, n_blocks):
    path = drawn()
    document = ezdxf.filemanagement.readfile(path)
    blocks = [document.blocks.new(f"B{n}") for n in range(n_blocks)]
    for block, inner in zip(blocks, [*blocks[1:], blocks[0]], strict=True):
        for x in range(3):
            block.add_blockref(inner.name, (x, 0), dxfattribs={"layer": "A-WALL"})
    document.modelspace().add_blockref("B0", (0, 0), dxfattribs={"layer": "A-WALL"})
    document.saveas(path)
    with refused(file="design.dxf", value="B0", remedy="export it") as fault:
        design_reading.read_design(path)
    assert "\n" not in str(fault.value)


def test_what_lies_in_a_block_is_read(drawn):
    path = drawn(door=False)
    document = ezdxf.filemanagement.readfile(path)
    leaf = document.blocks.new("LEAF")
    leaf.add_line((0, 0), (0, 900), dxfattribs={"layer": "A-DOOR"})
    document.blocks.new("DOOR").add_blockref("LEAF", (0, 0), dxfattribs={"layer": "A-DOOR"})
    document.modelspace().add_blockref("DOOR", (4250, 1000), dxfattribs={"layer": "A-DOOR"})
    document.saveas(path)
    (storey,) = design_reading.read_design(path)
    assert [opening.kind for opening in storey.openings] == ["door"]


@pytest.mark.parametrize(
    ("kind", "layers"),
    [
        ("wall", ("A-WALL-EXTR", "InnenWand", "Trennwände", "Außenwaende", "Murs_2", "WallsExt")),
        ("door", ("A-DOOR", "DOORS", "Haustür", "A-344---E-TUER", "Innentüren", "TUR", "portes")),
        ("window", ("A-GLAZ", "Windows", "E-FENSTER", "Dachfenster", "Fenêtres", "GLAZING")),
        ("column", ("S-COLS", "Column", "Stützen", "E-STUETZE", "poteau")),
        ("room", ("A-AREA", "Rooms", "A-RAUM", "Wohnzimmer", "pièces", "Spaces")),
        (None, ("Furniture", "Structure", "Fixtures", "A-AREA-IDEN", "Natur", "Outdoor", "0")),
    ],
)
def test_layers_are_told_by_whole_words(kind, layers):
    assert {layer: kind_of_layer(layer) for layer in layers} == dict.fromkeys(layers, kind)


def test_a_damaged_drawing_is_refused_in_one_line(tmp_path):
    path = tmp_path / "design.dxf"
    path.write_bytes(b"  0\nSECTION\n  2\nENTI")
    with refused(file="design.dxf", remedy="export it") as fault:
        design_reading.read_design(path)
    assert "\n" not in str(fault.value)


def test_a_plan_of_a_design_has_faces_whose_normals_lead_out_of_their_walls(drawn):
    (storey,) = design_reading.read_design(drawn())
    plan = make_plan(storey, "design")
    ends = np.column_stack([plan.faces[name] for name in ("x0_m", "y0_m", "x1_m", "y1_m")])
    middle_m = (ends[:, :2] + ends[:, 2:]) / 2
    out_m = middle_m + 0.01 * np.column_stack([plan.faces["nx"], plan.faces["ny"]])
    in_m = 2 * middle_m - out_m
    bodies = [storey.walls[wall].solid.ground for wall in plan.faces["wall"]]
    assert shapely.contains_xy(bodies, *in_m.T).all()
    assert not shapely.contains_xy(bodies, *out_m.T).any()
