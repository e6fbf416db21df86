"""What the report draws of a plan is what its sheet draws of it, element by element."""

import re
from collections import defaultdict
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import shapely

from helpers import curved_floor, floorplan_making
from helpers.floorplan_making import plan
from scanplan.exports import svg
from scanplan.exports.sheet import composition
from scanplan.exports.sheet.openings import list_symbols
from scanplan.report.plan_view import plan_svg

# what is of sheets alone: doubts stand as marks in the report, whose rooms have corners as text
OF_SHEETS = {"room", "verify", "corrected", "dimension", "tick", "leader", "title", "scale-bar"}
OF_SHEETS |= {"frame"}


def paths_of(text, to_metres):
    """Corners of all paths, by class; of arcs the radius, and how they turn, too."""
    found = defaultdict(list)
    paths = ((group, path) for group in ET.fromstring(text).iter() for path in group)
    for group, path in paths:
        if not path.tag.endswith("path"):
            continue
        # sheets have groups, the page classes
        kind = group.get("class") or path.get("class").split()[-1]
        if kind in OF_SHEETS or (path.get("id") or "").startswith("legend-"):
            continue
        steps = re.findall(r"([MLA])([^MLAZ]*)", path.get("d"))
        corners = np.array([words.split()[-2:] for _, words in steps], float)
        arcs = [
            (to_metres(float(words.split()[0])), words.split()[3:5])
            for step, words in steps
            if step == "A"
        ]
        found[kind].append((corners, arcs))
    return found


def furnished():
    """The plan of two rooms with furniture, a column, a standing leaf and a low wall."""
    (x, y0), (_, y1) = list_symbols(plan())[1].ends_m
    pieces = [
        (shapely.box(3.0, 2.5, 4.0, 3.0), "furniture"),
        (shapely.box(5.0, 2.0, 5.3, 2.3), "column"),
        (shapely.box(x, y0 - 0.02, x + y1 - y0, y0 + 0.02), "leaf"),
    ]
    furniture = floorplan_making.furniture([shape for shape, _ in pieces])
    furniture["kind"] = np.array([kind for _, kind in pieces], object)
    openings = floorplan_making.openings() | {
        "verify": np.array([True, False, False]),
        "doubt": np.array(["few rays", "", ""], object),
        "p_true": np.array([0.4, 0.99, 0.9]),
    }
    return plan(furniture=furniture, openings=openings)


@pytest.mark.parametrize("drawn", [furnished(), curved_floor.surveyed().plan])
def test_the_report_draws_what_the_sheet_draws(drawn):
    sheet = composition.compose_sheet(drawn, turn_deg=0.0)
    on_paper = paths_of(svg.format_svg_sheet(sheet), lambda mm: mm / sheet.page.mm_per_m)
    parts = "".join(plan_svg.draw_finished(drawn))
    on_page = paths_of(f"<svg>{parts}</svg>", float)
    kinds = {kind for kind in on_paper if not kind.startswith("words")}
    assert kinds == on_page.keys() and len(kinds) > 2
    height_mm = sheet.page.size_mm[1]
    for kind in kinds:
        assert len(on_paper[kind]) == len(on_page[kind])
        for (places_mm, bows), (places_m, arcs) in zip(on_paper[kind], on_page[kind], strict=True):
            in_map_m = sheet.page.to_plan(places_mm * [1, -1] + [0, height_mm])
            # sheets cut the arcs of symbols into short lines: both begin and end alike
            either = [0, -1] if len(in_map_m) != len(places_m) else np.s_[:]
            off_m = in_map_m[either] - (places_m * [1, -1])[either]
            assert np.abs(off_m).max() < 2e-3
            if len(in_map_m) == len(places_m):
                assert [turn for _, turn in arcs] == [turn for _, turn in bows]
                radii_m = [radius for radius, _ in arcs]
                assert radii_m == pytest.approx([radius for radius, _ in bows], abs=2e-3)


def test_doors_of_the_page_swing_and_say_which_they_are():
    drawn = furnished()
    openings = [part for part in plan_svg.draw_finished(drawn) if "data-opening" in part]
    assert [re.search(r'opening (\w+)"', part)[1] for part in openings] == [
        "door",
        "swing",
        "window",
    ]
    assert 'data-opening="opening 1" data-host="wall 5"' in openings[1]
    assert "A0.9 0.9" in openings[1] and "A" not in re.search(' d="(.*?)"', openings[0])[1]
