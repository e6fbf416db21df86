"""Parts of the report: the points under the plan, what to verify, links to files."""

import base64
import io
import re

import numpy as np
import pytest
from PIL import Image

from helpers import floorplan_making
from scanplan.report.chart import chart_svg
from scanplan.report.point_image import draw_point_image
from scanplan.report.result_links import link_results
from scanplan.validation.doubts import list_doubts


def pixels(points_m, **plan):
    image = draw_point_image([(0, np.array(points_m, float))], floorplan_making.plan(**plan))
    picture = Image.open(io.BytesIO(base64.b64decode(image.base64)))
    ink = np.asarray(picture.convert("RGBA"))[..., 3]
    rows, columns = np.nonzero(ink)
    scale_m = image.size_m / ink.shape[::-1]
    x_m = image.low_m[0] + (columns + 0.5) * scale_m[0]
    y_m = image.low_m[1] + (ink.shape[0] - rows - 0.5) * scale_m[1]
    return sorted(zip(x_m.tolist(), y_m.tolist(), strict=True)), scale_m


def test_points_are_drawn_where_they_are():
    found, scale_m = pixels([(1.0, 0.5, 1.0), (6.0, 2.5, 1.0), (99.0, 0.0, 1.0)])
    np.testing.assert_allclose(found, [(1.0, 0.5), (6.0, 2.5)], atol=scale_m.max())


def test_points_of_floor_and_ceiling_are_left_out_where_these_were_seen():
    points = [(1.0, 0.5, 0.05), (2.0, 0.5, 1.2), (3.0, 0.5, 2.45)]
    assert len(pixels(points)[0]) == 3
    ((x_m, _),), _ = pixels(points, floor_z_m=0.0, ceiling_z_m=2.5)
    assert abs(x_m - 2.0) < 0.05


def test_no_point_makes_a_clear_picture():
    assert pixels(np.empty((0, 3)))[0] == []


@pytest.mark.wording
def test_doubts_are_taken_where_the_tables_have_them():
    rooms = floorplan_making.rooms() | {"closed": np.array([True, False])}
    openings = floorplan_making.openings() | {
        "verify": np.array([True, False, True]),
        "doubt": np.array(["few rays", "", "no sill seen"], object),
        "p_true": np.array([0.4, 0.99, 0.2]),
    }
    faces = floorplan_making.faces()
    # a side of wall 1, one of the doubtful wall 2, and one of no wall
    faces["verify"] = np.isin(faces["face"], [1, 2, 8])
    faces["doubt"] = np.where(faces["verify"], "short", "")
    plan = floorplan_making.plan(faces=faces, rooms=rooms, openings=openings)
    assert [(d.element, d.name, d.reason) for d in list_doubts(plan)] == [
        ("room 1", "Room 1", "its outline is not closed: the area is a guess"),
        ("wall 2", "Wall 2", "few scans show it, or its place is uncertain"),
        ("opening 0", "Door 0", "few rays"),
        ("opening 2", "Window 2", "no sill seen"),
        ("face 1", "Face 1 of wall 1", "short"),
        ("face 8", "Face 8", "short"),
    ]


def test_links_are_of_what_people_open_the_drawing_first():
    files = ["plan/faces.parquet", "plan/other.step", "plan/plan.dxf", "figures/a.svg",
             "plan/plan.svg", "comparison.html", "../x.csv"]  # fmt: skip
    links = [(link.href, link.text) for link in link_results(files)]
    assert links == [
        ("plan/plan.svg", "drawing (SVG)"),
        ("plan/plan.dxf", "CAD (DXF)"),
        ("plan/other.step", "other.step"),
    ]


@pytest.mark.parametrize(
    ("n_scans", "ticks"),
    [
        (1, [1]),
        (7, [1, 2, 3, 4, 5, 6, 7]),
        (21, [1, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20]),
        (22, [1, 5, 10, 15, 20]),
        (99, [1, 10, 20, 30, 40, 50, 60, 70, 80, 90]),
        (100, [1, 2, 5, 10, 20, 50, 100]),
        (1173, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]),
    ],
)
def test_the_chart_counts_scans_in_round_numbers(n_scans, ticks):
    labels = re.findall(r'text-anchor="middle">([0-9,]+)<', chart_svg({}, n_scans, 1))
    assert [int(label.replace(",", "")) for label in labels] == ticks
