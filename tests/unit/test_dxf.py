import io
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.addons.drawing import Frontend, RenderContext
from ezdxf.addons.drawing.matplotlib import MatplotlibBackend
from ezdxf.tools.text import caret_decode
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from helpers import floorplan_making
from helpers.floorplan_making import FOOTPRINT_M2, bare, plan
from scanplan.exports import dxf
from scanplan.exports.sheet import composition
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.lettering import clean_text
from scanplan.exports.sheet.marks import Word
from scanplan.exports.sheet.styles import LAYERS


def reopened(drawn, unit="m", facts=None):
    sheet = composition.compose_sheet(drawn, facts)
    return ezdxf.read(io.StringIO(dxf.format_dxf(sheet, unit)))


def outlines(document, layer):
    polylines = document.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
    return shapely.union_all([shapely.Polygon(p.get_points("xy")) for p in polylines if p.closed])


def attributes(insert):
    return {attribute.dxf.tag: attribute.dxf.text for attribute in insert.attribs}


def read_text(entity):
    """What a CAD program shows of a text."""
    return ezdxf.decode_dxf_unicode(entity.plain_text())


def room_stamps(document):
    inserts = document.modelspace().query("INSERT")
    return [insert for insert in inserts if insert.dxf.name.startswith("ROOM-STAMP")]


def facts_of(entity):
    tags = list(entity.get_xdata("SCANPLAN"))
    return {name.value: value.value for name, value in zip(tags[::2], tags[1::2], strict=True)}


def test_walls_are_double_lines_as_far_apart_as_the_walls_are_thick():
    walls = outlines(reopened(plan()), "A-WALL")
    for start, end, thick_m in (
        ((-1, 2.5), (1, 2.5), 0.2),
        ((3, 0.5), (5, 0.5), 0.1),
        ((3, -1), (3, 1), 0.2),
    ):
        assert shapely.intersection(
            shapely.LineString([start, end]), walls
        ).length == pytest.approx(thick_m, abs=1e-3)


def test_what_is_inferred_and_assumed_has_layers_of_its_own():
    document = reopened(plan())
    inferred, assumed = (outlines(document, f"A-WALL-{name}") for name in ("INFR", "ASMD"))
    assert inferred.bounds == pytest.approx((4.05, 3.0, 7.1, 3.2), abs=0.06)
    assert assumed.bounds[0] == pytest.approx(7.1, abs=1e-3)
    drawn_m2 = outlines(document, "A-WALL").area + inferred.area + assumed.area
    openings_m2 = 1.0 * 0.2 + 0.9 * 0.1 + 1.2 * 0.2
    assert drawn_m2 == pytest.approx(FOOTPRINT_M2 - openings_m2, abs=1e-2)


def test_walls_are_hatched_with_holes_left_out():
    rows = [
        ((0, 0, 5, 0), 0.2, 0, 1, "observed"),
        ((5, 0, 5, 5), 0.2, 2, 3, "observed"),
        ((5, 5, 0, 5), 0.2, 4, 5, "observed"),
        ((0, 5, 0, 0), 0.2, 6, 7, "observed"),
    ]
    ring = plan(
        walls=floorplan_making.walls(rows),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms([]),
    )
    hatches = reopened(ring).modelspace().query('HATCH[layer=="A-WALL-PATT"]')
    assert [hatch.dxf.solid_fill for hatch in hatches] == [1]
    (hatch,) = hatches
    outer, inner = [shapely.Polygon([v[:2] for v in path.vertices]) for path in hatch.paths]
    assert outer.area - inner.area == pytest.approx(5.2**2 - 4.8**2)
    assert [path.path_type_flags & 1 for path in hatch.paths] == [1, 0]


def test_openings_are_blocks_with_attributes_as_wide_as_they_are():
    inserts = {
        attributes(insert)["TAG"]: insert
        for insert in reopened(plan()).modelspace().query("INSERT")
        if not insert.dxf.name.startswith("ROOM-STAMP")
    }
    assert {tag: insert.dxf.name for tag, insert in inserts.items()} == {
        "door-0": "DOOR", "door-1": "DOOR", "window-2": "WINDOW"
    }  # fmt: skip
    assert {tag: insert.dxf.layer for tag, insert in inserts.items()} == {
        "door-0": "A-DOOR", "door-1": "A-DOOR", "window-2": "A-GLAZ"
    }  # fmt: skip
    scales = {tag: (i.dxf.xscale, i.dxf.yscale) for tag, i in inserts.items()}
    assert scales["door-1"] == pytest.approx((0.9, 0.1))
    assert scales["window-2"] == pytest.approx((1.2, 0.2))
    window = attributes(inserts["window-2"])
    assert (window["WIDTH"], window["SILL"], window["LINTEL"]) == ("1.20", "0.90", "2.10")
    assert facts_of(inserts["window-2"])["n_rays"] == 40


@pytest.mark.wording
def test_every_kind_of_opening_has_a_symbol_and_a_meaning():
    openings = floorplan_making.openings() | {
        "type": np.array(["passage", "gap", "glass"], object),
        "corrected": np.array(["kept by hand", "", ""], object),
    }
    sheet = composition.compose_sheet(plan(openings=openings))
    document = ezdxf.read(io.StringIO(dxf.format_dxf(sheet)))
    inserts = document.modelspace().query("INSERT")
    assert {"PASSAGE", "GAP", "GLASS"} <= {insert.dxf.name for insert in inserts}
    said = [word.text for word in sheet.paper_words]
    assert {"passage", "gap, not known what", "glass down to the floor"} <= set(said)
    assert sheet.symbols[0].title == "passage 0, 1.00 m; kept by hand"


def test_openings_are_cut_out_of_the_walls():
    walls = outlines(reopened(plan()), "A-WALL")
    assert not walls.intersects(shapely.LineString([(3, 1.5), (5, 1.5)]))


def test_rooms_are_outlines_of_their_area_below_all_else_with_a_stamp():
    document = reopened(plan())
    assert outlines(document, "A-AREA").area == pytest.approx(21)
    first = next(e for e in document.modelspace() if e.dxftype() != "HATCH")
    assert first.dxf.layer == "A-AREA"
    stamps = [attributes(insert) for insert in room_stamps(document)]
    assert [(s["NUMBER"], s["AREA"], s["PERIMETER"]) for s in stamps] == [
        ("0", "12.0 m²", "14.00 m"), ("1", "9.0 m²", "12.00 m")
    ]  # fmt: skip


def test_what_a_stamp_shows_is_text_of_its_block_and_no_attribute():
    sheet = composition.compose_sheet(plan())
    document = ezdxf.read(io.StringIO(dxf.format_dxf(sheet, "mm")))
    drawn = {
        (text.dxf.text, tuple(np.round(text.get_placement()[1].vec2, 1)))
        for insert in room_stamps(document)
        for text in insert.virtual_entities()
        if text.dxftype() == "TEXT"
    }
    words = [word for stamp in sheet.stamps for word in stamp.words]
    assert drawn == {(word.text, tuple(np.round(1000 * word.place, 1))) for word in words}
    assert {text for text, _ in drawn} >= {"12.0 m²", "9.0 m²"}
    assert all(a.is_invisible for insert in room_stamps(document) for a in insert.attribs)


def test_a_stamp_beside_its_room_has_a_line_to_it():
    sheet = composition.compose_sheet(plan())
    beside = replace(
        sheet.stamps[0],
        words=[Word("stamp", "0", np.array([3.0, 9.0]), 1.8, leader=np.array([[2, 7], [3, 8]]))],
    )
    document = ezdxf.read(io.StringIO(dxf.format_dxf(replace(sheet, stamps=[beside]), "m")))
    (insert,) = room_stamps(document)
    (line,) = [e for e in insert.virtual_entities() if e.dxftype() == "LWPOLYLINE"]
    assert np.allclose(line.get_points("xy"), [[2, 7], [3, 8]])


def test_an_open_room_s_area_is_a_guess_here_too():
    rooms = floorplan_making.rooms() | {"closed": np.array([True, False])}
    stamps = room_stamps(reopened(plan(rooms=rooms)))
    assert [attributes(i)["AREA"] for i in stamps] == ["12.0 m²", "about 9.0 m²"]
    assert [attributes(i)["PERIMETER"] for i in stamps] == ["14.00 m", "about 12.00 m"]


def test_evidence_of_walls_lies_on_their_lines_on_a_layer_that_is_off():
    document = reopened(plan())
    axes = document.modelspace().query('LWPOLYLINE[layer=="A-WALL-CNTR"]')
    facts = [facts_of(axis) for axis in axes]
    assert [fact["wall"] for fact in facts] == list(range(6))
    assert facts[0]["sigma_offset_m"] == pytest.approx(0.002) and facts[0]["n_points"] == 500
    assert document.layers.get("A-WALL-CNTR").is_off()


def test_furniture_has_a_layer_of_its_own():
    document = reopened(plan(furniture=floorplan_making.furniture()))
    (piece,) = document.modelspace().query('LWPOLYLINE[layer=="A-FURN"]')
    assert len(piece) == 4 and piece.closed


def test_columns_have_a_layer_of_their_own():
    document = reopened(plan(furniture=floorplan_making.furniture(kind="column")))
    (column,) = document.modelspace().query('LWPOLYLINE[layer=="A-COLS"]')
    assert len(column) == 4 and column.closed


def test_open_leaves_are_on_the_layer_of_doors():
    document = reopened(plan(furniture=floorplan_making.furniture(kind="leaf")))
    doors = document.modelspace().query('LWPOLYLINE[layer=="A-DOOR"]')
    assert [len(door) for door in doors if door.closed] == [4]


def test_doubt_has_layers_of_its_own():
    openings = floorplan_making.openings() | {
        "verify": np.array([True, False, True]),
        "p_true": np.array([0.4, 0.9, 0.6]),
        "doubt": np.array(["few rays", "", "no sill"], object),
    }
    space = reopened(plan(openings=openings)).modelspace()
    doubted = {
        insert.dxf.layer: insert for insert in space.query("INSERT") if "VRFY" in insert.dxf.layer
    }
    assert set(doubted) == {"A-DOOR-VRFY", "A-GLAZ-VRFY"}
    assert facts_of(doubted["A-DOOR-VRFY"])["doubt"] == "few rays"
    assert facts_of(doubted["A-DOOR-VRFY"])["p_true"] == pytest.approx(0.4)
    assert len(space.query('LWPOLYLINE[layer=="A-WALL-VRFY"]')) == 1
    assert any(text.dxf.text.endswith("?") for text in space.query('TEXT[layer=="A-ANNO-VRFY"]'))


@pytest.mark.parametrize(("unit", "per_m"), [("m", 1.0), ("mm", 1000.0)])
def test_dimensions_measure_metres_in_any_unit(unit, per_m):
    document = reopened(plan(), unit)
    dimensions = document.modelspace().query("DIMENSION")
    style = document.dimstyles.get("SCANPLAN")
    read = sorted(d.get_measurement() * style.dxf.dimlfac for d in dimensions)
    assert read[-1] == pytest.approx(7.4, abs=1e-3)
    assert outlines(document, "A-AREA").area == pytest.approx(21 * per_m**2)
    assert {d.dxf.layer for d in dimensions} == {"A-ANNO-DIMS"}


def test_the_drawing_states_its_style_of_dimensions_for_programs_without_styles():
    header = reopened(plan(), "mm").header
    # letters of 1.8 mm at 1:50, metres of millimetres
    stated = {name: header[name] for name in ("$DIMTXT", "$DIMLFAC", "$DIMDEC", "$DIMTAD")}
    assert stated == {"$DIMTXT": 90.0, "$DIMLFAC": 0.001, "$DIMDEC": 2, "$DIMTAD": 1}
    assert header["$DIMSTYLE"] == "SCANPLAN"


@pytest.mark.parametrize("unit", ["m", "mm"])
@pytest.mark.parametrize("drawn", [plan(), bare()])
def test_it_is_in_its_unit_on_named_layers_and_clean(drawn, unit):
    document = reopened(drawn, unit)
    assert document.dxfversion == "AC1024"
    assert document.units == {"m": ezdxf.units.M, "mm": ezdxf.units.MM}[unit]
    used = {
        entity.dxf.layer
        for space in (document.modelspace(), document.layout("Sheet"))
        for entity in space
    }
    assert used <= set(LAYERS) <= {e.dxf.name for e in document.layers}
    auditor = document.audit()
    assert not auditor.errors and not auditor.fixes


def test_letters_are_as_high_on_paper_as_the_standard_says():
    document = reopened(plan(), "mm")
    heights = {text.dxf.height for text in document.modelspace().query("TEXT")}
    assert min(heights) >= 1.8 * 50 - 1e-6
    assert {t.dxf.height for t in document.layout("Sheet").query("TEXT")} <= {1.8, 2.5, 3.5}


def test_the_layout_shows_the_plan_to_scale_and_turned():
    drawn = plan()
    sheet = composition.compose_sheet(drawn)
    document = ezdxf.read(io.StringIO(dxf.format_dxf(sheet, "mm")))
    layout = document.layout("Sheet")
    (port,) = [v for v in layout.query("VIEWPORT") if v.dxf.status > 1]
    assert port.get_scale() == pytest.approx(1 / sheet.page.scale)
    to_paper = port.get_transformation_matrix()
    for place_m in ([0, 0], [7.1, 3.0]):
        x, y, _ = to_paper.transform((*np.multiply(place_m, 1000), 0))
        np.testing.assert_allclose([x, y], sheet.page.to_paper(np.array(place_m, float)), atol=0.01)
    (title,) = layout.query('INSERT[name=="TITLE-BLOCK"]')
    assert attributes(title)["SCALE"] == "1:50"


def test_extent_and_view_are_those_of_the_plan():
    document = reopened(plan())
    low, high = document.header["$EXTMIN"], document.header["$EXTMAX"]
    assert low[0] < -0.2 and high[0] > 7.2 and high[0] - low[0] < 20
    port = document.viewports.get_config("*Active")[0]
    # the middle of the walls, from -0.2 to 7.2 m and from -0.2 to 3.2; left and below is a chain
    # more, 8 mm at 1:50
    assert port.dxf.center.isclose((3.5 - 0.2, 1.5 - 0.2), abs_tol=0.05)


@pytest.mark.parametrize(
    "name",
    [
        "a\n  0\nLINE\n",
        "%%d ^J \\U+0041",
        "\\P{\\fArial;x}",
        "<b>&",
        "^^ %%%c% 100%",
        "\\\\M+1A2B4 \\U+005C",
        "{a} ёж\\",
    ],
)
def test_names_are_letters_and_no_commands(name):
    rooms = floorplan_making.rooms() | {"name": np.array([name, ""], object)}
    drawn = replace(plan(rooms=rooms), name=name)
    document = reopened(drawn, facts=SheetFacts(project=name, storey=name))
    other = reopened(plan())
    assert len(document.modelspace()) == len(other.modelspace())
    shown = clean_text(name)
    (title,) = document.layout("Sheet").query('INSERT[name=="TITLE-BLOCK"]')
    assert [read_text(attribute) for attribute in title.attribs].count(shown) == 3
    named = [a for stamp in room_stamps(document) for a in stamp.attribs if a.dxf.tag == "NAME"]
    words = document.blocks.get("ROOM-STAMP-0").query("TEXT")
    assert shown in map(read_text, named) and shown in map(read_text, words)
    outlines = document.modelspace().query("LWPOLYLINE")
    facts = [facts_of(outline) for outline in outlines if outline.has_xdata("SCANPLAN")]
    stated = [str(fact["name"]) for fact in facts if "name" in fact]
    assert shown in [ezdxf.decode_dxf_unicode(caret_decode(name)) for name in stated]


def rendered(document, layout):
    figure = Figure(figsize=(8, 6))
    axes = figure.add_axes((0, 0, 1, 1))
    Frontend(RenderContext(document), MatplotlibBackend(axes)).draw_layout(layout)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].astype(int)


def test_rendered_by_another_program_walls_are_grey_and_doors_blue():
    document = reopened(plan(), "mm")
    for layout in (document.modelspace(), document.layout("Sheet")):
        pixels = rendered(document, layout).reshape(-1, 3)
        background = np.median(pixels, axis=0)
        is_drawn = np.abs(pixels - background).max(axis=1) > 60
        assert 0.01 < is_drawn.mean() < 0.5
        is_blue = (pixels[:, 2] > 150) & (pixels[:, :2].max(axis=1) < 90)
        is_grey = (np.ptp(pixels, axis=1) < 8) & (abs(pixels[:, 0] - 128) < 10)
        assert is_blue.sum() > 20 and is_grey.sum() > 200


def test_the_same_plan_gives_the_same_bytes():
    sheet = composition.compose_sheet(plan())
    assert dxf.format_dxf(sheet) == dxf.format_dxf(sheet)


def test_it_leaves_the_options_of_ezdxf_as_they_were():
    before = ezdxf.options.write_fixed_meta_data_for_testing
    dxf.format_dxf(composition.compose_sheet(plan()))
    assert ezdxf.options.write_fixed_meta_data_for_testing == before
