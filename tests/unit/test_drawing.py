import itertools
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from helpers import floorplan_making
from helpers.floorplan_making import bare
from scanplan.exports import drawing
from scanplan.stage import figure_files

_POINTS_PER_MM = 72 / 25.4


@pytest.fixture
def plan():
    return bare([(0, 0, 12, 0, -1), (0, 8, 0, 0, -1), (12, 0, 12, 8, -1)])


def groups(text):
    return {e.get("id"): e for e in ElementTree.fromstring(text).iter() if e.get("id")}


def texts(text):
    return re.findall(r"<!-- (.*?) -->", text, flags=re.DOTALL)


def path_points(element):
    numbers = re.findall(r"-?\d+\.?\d*", element.find("{http://www.w3.org/2000/svg}path").get("d"))
    return np.array(numbers, float).reshape(-1, 2)


def path_length_mm(element):
    return np.hypot(*np.diff(path_points(element), axis=0).T).sum() / _POINTS_PER_MM


def test_faces_are_drawn_at_the_scale_that_is_stated(plan):
    text = figure_files.format_svg(drawing.draw_plan(plan))
    assert any("scale 1:50" in said for said in texts(text))
    assert path_length_mm(groups(text)["single-observed-0"]) == pytest.approx(12_000 / 50, abs=0.01)


def test_scale_bar_is_drawn_at_the_scale_that_is_stated(plan):
    text = figure_files.format_svg(drawing.draw_plan(plan))
    assert "5 m" in texts(text)
    low, high = groups(text)["scale-bar-0"], groups(text)["scale-bar-3"]
    starts = [
        float(re.search(r"M (-?[\d.]+)", e.find("{http://www.w3.org/2000/svg}path").get("d"))[1])
        for e in (low, high)
    ]
    assert (starts[1] - starts[0]) / _POINTS_PER_MM == pytest.approx(5000 / 50 * 3 / 4, abs=0.01)


def test_it_says_what_it_shows(plan):
    said = texts(figure_files.format_svg(drawing.draw_plan(plan)))
    assert "office" in said
    assert any("3 wall faces" in line for line in said)
    assert any("north unknown" in line for line in said)
    assert {"12.00", "8.00"} <= set(said)


def test_the_same_plan_give_the_same_bytes(plan):
    assert figure_files.format_svg(drawing.draw_plan(plan)) == figure_files.format_svg(
        drawing.draw_plan(plan)
    )
    assert "<dc:date>" not in figure_files.format_svg(drawing.draw_plan(plan))


def test_walls_openings_and_rooms_are_drawn():
    text = figure_files.format_svg(drawing.draw_plan(floorplan_making.plan()))
    drawn = set(groups(text))
    assert {
        "walls-observed-0",
        "walls-inferred-0",
        "door-0",
        "door-1",
        "window-2",
        "single-observed-0",
    } <= drawn
    said = "\n".join(texts(text))
    assert "Room 0" in said and "12.0 m²" in said and "9.0 m²" in said
    assert "inferred wall" in said and "thickness not known" in said
    assert {"0.90", "1.00", "1.20"} <= set(texts(text))


def test_an_area_of_an_open_room_is_told_as_such():
    rooms = floorplan_making.rooms() | {"closed": np.array([True, False])}
    assert "about 9.0 m²" in "\n".join(
        texts(figure_files.format_svg(drawing.draw_plan(floorplan_making.plan(rooms=rooms))))
    )


def test_pdf_is_one_page_of_the_same_bytes_and_size():
    made = figure_files.format_pdf(drawing.draw_plan(floorplan_making.plan()))
    assert made == figure_files.format_pdf(drawing.draw_plan(floorplan_making.plan()))
    assert made.startswith(b"%PDF") and b"CreationDate" not in made
    (box,) = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", made)
    svg = ElementTree.fromstring(
        figure_files.format_svg(drawing.draw_plan(floorplan_making.plan()))
    )
    size = [float(svg.get(side).removesuffix("pt")) for side in ("width", "height")]
    assert np.array(box, float) == pytest.approx(size, abs=0.01)


@pytest.mark.parametrize("segment", [(0, 0, 0.3, 0), (0, 0, 900, 400), (3, 0, 3, 40)])
def test_everything_lies_on_the_page_and_no_text_on_another(segment):
    figure = drawing.draw_plan(replace(bare([(*segment, -1)]), name="W" * 100))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    written = [text for text in figure.findobj(Text) if text.get_text()]
    boxes = [text.get_window_extent(renderer) for text in written]
    page = figure.bbox
    for box in boxes:
        assert page.x0 <= box.x0 <= box.x1 <= page.x1
        assert page.y0 <= box.y0 <= box.y1 <= page.y1
    assert not [1 for one, other in itertools.combinations(boxes, 2) if one.overlaps(other)]


@pytest.mark.parametrize("segment", [(0, 0, 0.3, 0), (5, 5, 5, 9), (0, 0, 900, 400)])
def test_one_face_of_any_size_can_be_drawn(segment):
    ElementTree.fromstring(
        figure_files.format_svg(
            drawing.draw_plan(replace(bare([(*segment, -1)]), name="$one_face^"))
        )
    )


@pytest.mark.parametrize(
    ("extent_m", "scale"), [((3.8, 2.6), 10), ((3.9, 1), 20), ((1, 26), 100), ((30, 30), 200)]
)
def test_scale_is_the_largest_usual_one_that_fits(extent_m, scale):
    assert drawing.choose_scale(np.array(extent_m)) == scale
