import io
import os
import re
import subprocess
import sys
from dataclasses import replace
from functools import partial
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
from matplotlib.figure import Figure
from matplotlib.textpath import TextPath
from PIL import Image

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from scanplan.exports import drawing, svg
from scanplan.exports.sheet import composition, lettering
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.locale import make_locale
from scanplan.project.words_file import read_words
from scanplan.stage import figure_files

NAMESPACE = "{http://www.w3.org/2000/svg}"
_POINTS_PER_MM = 72 / 25.4


def formatted(drawn, facts=None):
    return svg.format_svg_sheet(composition.compose_sheet(drawn, facts))


def elements(text, tag):
    return list(ElementTree.fromstring(text).iter(f"{NAMESPACE}{tag}"))


def texts(text):
    return [element.text for element in elements(text, "text")]


def points(path):
    return np.array(re.findall(r"-?\d+\.?\d*", path.get("d")), float).reshape(-1, 2)


def test_lines_are_drawn_at_the_scale_that_is_stated():
    text = formatted(bare([(0, 0, 12, 0, -1), (0, 8, 0, 0, -1), (12, 0, 12, 8, -1)]))
    assert "1:50" in texts(text)
    (line,) = [e for e in elements(text, "path") if e.get("id") == "surface-0"]
    assert np.hypot(*np.diff(points(line), axis=0)[0]) == pytest.approx(12_000 / 50, abs=0.01)


def test_the_scale_bar_is_as_long_as_it_says():
    text = formatted(plan())
    parts = [e for e in elements(text, "path") if e.get("id", "").startswith("scale-bar-")]
    corners = np.concatenate([points(part) for part in parts])
    (stated,) = [word for word in texts(text) if re.fullmatch(r"\d+ m", word)]
    assert np.ptp(corners[:, 0]) * 50 / 1000 == pytest.approx(float(stated.removesuffix(" m")))


def test_elements_are_in_groups_of_their_kind_with_titles():
    text = formatted(plan())
    kinds = {group.get("class") for group in elements(text, "g")}
    assert {"wall", "inferred", "assumed", "door", "window", "surface", "words stamp"} <= kinds
    paths = {path.get("id"): path for path in elements(text, "path")}
    assert {"door-0", "door-1", "window-2", "wall-0", "room-0"} <= set(paths)
    assert paths["door-0"].find(f"{NAMESPACE}title").text == "door 0, 1.00 m"
    assert "Room 0" in texts(text) and "12.0 m²" in texts(text)


def test_ids_are_unique():
    names = re.findall(r' id="([^"]+)"', formatted(plan()))
    assert len(names) == len(set(names))


def test_an_area_of_an_open_room_is_told_as_such():
    rooms = floorplan_making.rooms() | {"closed": np.array([True, False])}
    assert "about 9.0 m²" in texts(formatted(plan(rooms=rooms)))


@pytest.mark.parametrize(
    "name", ["</text><script>alert(1)</script>", "a\nb & <c>", '"><g onload="x"', "$x^2_", "\\P{a}"]
)
def test_names_are_letters_and_no_markup(name):
    rooms = floorplan_making.rooms() | {"name": np.array([name, ""], object)}
    drawn = replace(plan(rooms=rooms), name=name)
    text = formatted(drawn, SheetFacts(project=name, storey=name, version=name))
    tags = {element.tag.removeprefix(NAMESPACE) for element in ElementTree.fromstring(text).iter()}
    assert tags == {"svg", "title", "desc", "view", "style", "rect", "g", "path", "text"}
    assert not any("onload" in e.attrib for e in ElementTree.fromstring(text).iter())
    assert " ".join(name.split()) in texts(text)
    figure = drawing.draw_sheet(composition.compose_sheet(drawn))
    assert figure_files.format_pdf([figure], name).startswith(b"%PDF")


def test_the_same_plan_gives_the_same_bytes():
    sheets = [composition.compose_sheet(plan()) for _ in range(2)]
    assert svg.format_svg_sheet(sheets[0]) == svg.format_svg_sheet(sheets[1])
    once, again = (drawing.draw_sheet(sheet) for sheet in sheets)
    assert figure_files.format_pdf([once]) == figure_files.format_pdf([again])
    assert figure_files.format_png(once) == figure_files.format_png(again)


@pytest.mark.parametrize("size_mm", [(297, 210), (594, 841)])
def test_letters_are_as_many_pixels_high_on_every_sheet(size_mm):
    figure = Figure(figsize=[side / 25.4 for side in size_mm])
    with Image.open(io.BytesIO(figure_files.format_png(figure))) as picture:
        pixels_per_mm = np.array(picture.size) / size_mm
    np.testing.assert_allclose(pixels_per_mm, 150 / 25.4, atol=0.01)


def test_pdf_is_one_page_of_the_sheet_s_size_with_letters_of_its_own():
    sheet = composition.compose_sheet(plan())
    made = figure_files.format_pdf([drawing.draw_sheet(sheet)], "Floor plan of office")
    assert made.startswith(b"%PDF") and b"CreationDate" not in made
    assert b"Floor plan of office" in made and b"DejaVuSans" in made
    (box,) = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", made)
    size_mm = np.array(box, float) / _POINTS_PER_MM
    np.testing.assert_allclose(size_mm, sheet.page.size_mm, atol=0.01)
    assert sorted(sheet.page.size_mm) == [210, 297]


@pytest.mark.parametrize("turn_deg", [0.0, 90.0])
def test_the_svg_has_a_view_of_the_plan_alone(turn_deg):
    sheet = composition.compose_sheet(plan(), turn_deg=turn_deg)
    view = ElementTree.fromstring(svg.format_svg_sheet(sheet)).find(f"{NAMESPACE}view")
    x, y, width, height = map(float, view.get("viewBox").split())
    # 7.4 m x 3.4 m at 1:50
    sides_mm = [7.4 * 20, 3.4 * 20]
    assert [width, height] == pytest.approx(sides_mm if turn_deg == 0 else sides_mm[::-1], abs=0.1)
    x0, y0, x1, y1 = sheet.page.drawing_mm
    assert x0 <= x and x + width <= x1
    assert y0 <= sheet.page.size_mm[1] - y - height and sheet.page.size_mm[1] - y <= y1


def test_svg_has_the_sheet_s_size():
    root = ElementTree.fromstring(formatted(plan()))
    size = [float(root.get(side).removesuffix("mm")) for side in ("width", "height")]
    assert [0, 0, *size] == [float(number) for number in root.get("viewBox").split()]
    assert sorted(size) == [210, 297]


def test_a_line_of_a_png_is_as_long_as_it_was_measured():
    text, inch_mm = "from a damaged recording; 41 walls, 6 doors, 6 passages, 3 unknown gaps,", 25.4
    figure = Figure(figsize=(130 / inch_mm, 10 / inch_mm))
    size = lettering.font_size_mm(1.8) * lettering.POINTS_PER_MM
    figure.text(0.02, 0.5, text, fontsize=size, family=lettering.FONT)
    with Image.open(io.BytesIO(figure_files.format_png(figure))) as picture:
        _, columns = np.nonzero(np.asarray(picture.convert("L")) < 128)
    drawn_mm = np.ptp(columns) * inch_mm / 150
    assert drawn_mm == pytest.approx(lettering.measure_width_mm(text, 1.8), abs=1.0)


_DRAWN = """
import hashlib
from helpers.floorplan_making import plan
from scanplan.exports import drawing, svg
from scanplan.exports.sheet import composition
from scanplan.stage import figure_files
sheet = composition.compose_sheet(plan())
figure = drawing.draw_sheet(sheet)
for made in (figure_files.format_pdf([figure]), figure_files.format_png(figure),
             figure_files.format_svg(figure).encode(), svg.format_svg_sheet(sheet).encode()):
    print(hashlib.sha256(made).hexdigest())
"""


def test_a_matplotlibrc_of_the_user_changes_nothing(tmp_path, project_root):
    path = os.pathsep.join(str(project_root / folder) for folder in ("scripts", "tests"))
    environ = {"PYTHONPATH": path, "HOME": str(tmp_path), "MPLBACKEND": "agg"}
    run = partial(
        subprocess.run,
        [sys.executable, "-W", "ignore", "-c", _DRAWN],
        cwd=tmp_path,
        env=environ,
        capture_output=True,
        text=True,
        check=True,
    )
    ours = run().stdout
    (tmp_path / "matplotlibrc").write_text(
        "savefig.bbox: tight\nsavefig.dpi: 50\nfigure.dpi: 33\nfont.size: 30\nlines.linewidth: 9\n"
        "axes.facecolor: red\npdf.compression: 0\nsvg.fonttype: none\ntext.hinting: native\n"
    )
    assert len(ours.split()) == 4 and run().stdout == ours


def test_a_sheet_no_larger_than_a3_is_one_page_of_its_own_size():
    (page,) = drawing.draw_tiles(composition.compose_sheet(plan()))
    assert page.get_size_inches() == pytest.approx(np.array([297, 210]) / 25.4)


@pytest.mark.parametrize(
    ("size_mm", "page_mm", "n_pages"),
    # pages show 410 x 284 mm or 287 x 407 and overlap by 5; frames are 565 x 401 mm and 812 x 575
    [((594.0, 420.0), (297, 420), 2), ((841.0, 594.0), (420, 297), 6)],
)
def test_a_large_sheet_goes_on_pages_of_a3_that_show_all_of_it_to_scale(size_mm, page_mm, n_pages):
    sheet = composition.compose_sheet(plan())
    german = make_locale("m", read_words("de"))
    page = replace(sheet.page, name="large", size_mm=size_mm, locale=german)
    large = replace(sheet, page=page)
    tiles = drawing.draw_tiles(large)
    assert len(tiles) == n_pages
    windows_mm = []
    for tile in tiles:
        assert tile.get_size_inches() == pytest.approx(np.array(page_mm) / 25.4)
        (axes,) = tile.axes
        (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
        shown = axes.get_position().size * tile.get_size_inches() * 25.4
        # a millimetre of the sheet is one of the page
        np.testing.assert_allclose([x1 - x0, y1 - y0], shown)
        windows_mm.append(shapely.box(x0, y0, x1, y1))
    assert shapely.union_all(windows_mm).buffer(1e-6).covers(shapely.box(*large.page.inner_mm))
    beside = windows_mm[0].intersection(windows_mm[1])
    assert beside.bounds[2] - beside.bounds[0] >= 5
    # row by row from the upper left
    assert windows_mm[0].bounds[0] == pytest.approx(19.5)
    assert windows_mm[0].bounds[3] >= size_mm[1] - 10
    (mark,) = tiles[-1].texts
    last, pages = {2: ("A2", "1 x 2"), 6: ("C2", "3 x 2")}[n_pages]
    assert mark.get_text().endswith(f"Seite {last} von {pages}")
    capitals = TextPath((0, 0), "H", size=mark.get_fontsize(), prop={"family": lettering.FONT})
    # points of the size are 72 an inch
    assert capitals.get_extents().height / 72 * 25.4 >= 1.79
    drawn = {patch.get_gid() for tile in tiles for patch in tile.axes[0].patches}
    assert {patch.get_gid() for patch in drawing.draw_sheet(large).axes[0].patches} == drawn


@pytest.mark.parametrize(
    ("language", "said"),
    [("", "page A1 of 1 x 2"), ("de", "Seite A1 von 1 x 2"), ("fr", "page A1 sur 1 x 2"),
     ("es", "página A1 de 1 x 2")],
)  # fmt: skip
def test_a_page_of_a_large_sheet_says_which_it_is_where_printers_reach(language, said):
    locale = make_locale("m", read_words(language) if language else None)
    sheet = composition.compose_sheet(plan(), SheetFacts(locale=locale))
    large = replace(sheet, page=replace(sheet.page, size_mm=(594.0, 420.0)))
    tile, _ = drawing.draw_tiles(large)
    (tag,) = tile.texts
    assert tag.get_text() == f"office: {said}"
    capitals_mm = tag.get_fontsize() / lettering.POINTS_PER_MM / lettering.font_size_mm(1.0)
    assert capitals_mm == pytest.approx(1.8)
    # above what printers leave white, below the part of the sheet
    y_mm = tag.get_position()[1] * 420
    assert y_mm == pytest.approx(5) and y_mm + 1.8 < tile.axes[0].get_position().y0 * 420
