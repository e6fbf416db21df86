"""The plan in space, as the report's page has it: bodies, thinned points, words about heights."""

import base64
import gzip
import hashlib
import io
import json
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making, report_making
from helpers.floorplan_making import HEIGHT_M, plan
from helpers.refusals import refused
from scanplan.report import sent_points, solid_view
from scanplan.report.chart import MARGIN_M

NOTHING = np.zeros((0, 3))


def unpack(data, kind):
    return np.frombuffer(gzip.decompress(base64.b64decode(data)), kind)


def corners_of(view):
    """Corners (n, 3, 3) of triangles by element, map frame and above the floor."""
    bodies = view["bodies"]
    steps = unpack(bodies["data"], "<u2").reshape(-1, 3, 3)
    corners_m = np.array(view["low_m"]) + steps * bodies["step_m"]
    ends = np.cumsum([n for *_, n in bodies["parts"]])
    return {
        element: corners_m[end - n : end]
        for (element, _, n), end in zip(bodies["parts"], ends, strict=True)
    }


def points_of(view):
    """Points (n, 3) as the page works them out: sums of differences of 16 bits, axis by axis."""
    points = view["points"]
    low, high = np.split(unpack(points["data"], np.uint8).reshape(3, -1), 2, axis=1)
    steps = np.cumsum(low + 256 * high.astype(np.int64), axis=1) % 2**16
    return np.array(view["low_m"]) + steps.T * points["step_m"]


def view_of(points_m, **changed):
    return solid_view.pack_view(plan(**changed), [(0, np.array(points_m, float))])


def test_a_wall_is_as_long_and_high_as_the_plan_says():
    view = view_of(NOTHING)
    corners = corners_of(view)
    low, high = floorplan_making.plan().bodies[1].bounds[:2], HEIGHT_M
    assert corners["wall 1"].reshape(-1, 3).min(axis=0) == pytest.approx([*low, 0], abs=1e-3)
    assert corners["wall 1"][..., 2].max() == pytest.approx(high, abs=1e-3)
    assert {element.split()[0] for element in corners} == {"wall", "opening", "room"}


def test_points_are_where_they_were_measured_above_the_floor():
    points = [(1.0, 0.5, 1.0), (6.0, 2.5, 2.25), (1.0, 0.5, 1.0)]
    view = view_of(points, floor_z_m=0.25, ceiling_z_m=2.75)
    assert (view["points"]["n"], view["points"]["n_all"]) == (2, 3)
    found = sorted(points_of(view).tolist())
    np.testing.assert_allclose(found, [(1.0, 0.5, 0.75), (6.0, 2.5, 2.0)], atol=0.0051)


def test_points_from_elsewhere_are_left_out():
    _, (east_m, _) = plan().bounds_m
    beside, above = east_m + MARGIN_M + 0.1, HEIGHT_M + 1
    assert view_of([(beside, 1, 1), (1, 1, above), (1, 1, -1)])["points"]["n_all"] == 0


@given(st.lists(st.tuples(*[st.integers(0, 200)] * 3), min_size=1, max_size=60))
def test_every_point_has_one_that_is_kept_within_its_cube(places):
    points = np.array(places) * [0.03, 0.014, 0.012]
    kept = points_of(view_of(points))
    apart = np.linalg.norm(points[:, None] - kept, axis=2).min(axis=1)
    # across a cube, and what is rounded
    assert apart.max() <= (solid_view._CUBE_M + 0.01) * np.sqrt(3)
    assert np.linalg.norm(kept[:, None] - points, axis=2).min(axis=1).max() < 0.01


def test_what_is_too_much_for_a_page_is_thinned_until_it_fits(monkeypatch):
    points = np.random.default_rng(1).uniform([0, 0, 0], [7, 3, 2], (20_000, 3))
    most = 20_000
    monkeypatch.setattr(solid_view, "_MOST_LETTERS", most)
    view = view_of(points)
    assert len(view["points"]["data"]) + len(view["bodies"]["data"]) <= most
    assert 1_000 < view["points"]["n"] < view["points"]["n_all"] == len(points)
    # evenly: no quarter of the floor is left out
    counts, _ = np.histogram(points_of(view)[:, 0], bins=4, range=(0, 7))
    assert counts.min() > 0.2 * view["points"]["n"]


def test_all_effort_is_made_for_what_may_fit_alone():
    content = np.random.default_rng(1).integers(0, 8, 9_000, np.uint8).tobytes()
    whole = solid_view._pack(content)
    assert solid_view._pack_within(content, len(whole)) == whole
    # what one more of its letters would fit into is still packed well
    assert solid_view._pack_within(content, len(whole) - 1) == whole
    hasty = solid_view._pack_within(content, len(whole) // 2)
    assert len(hasty) > len(whole) // 2 and hasty != whole


def test_many_scans_are_thinned_while_they_are_read(monkeypatch):
    monkeypatch.setattr(solid_view, "_MOST_KEPT", 500)
    points = np.random.default_rng(2).uniform([0, 0, 0], [7, 3, 2], (40, 100, 3))
    view = solid_view.pack_view(plan(), enumerate(points))
    assert view["points"]["n"] <= 500 and view["points"]["n_all"] == 4_000


def test_the_same_plan_gives_the_same_bytes():
    assert view_of([(1, 1, 1)]) == view_of([(1, 1, 1)])
    assert solid_view.pack_script("a") == solid_view.pack_script("a")


def test_a_floor_without_rooms_and_points_is_shown_all_the_same():
    empty = {name: values[:0] for name, values in floorplan_making.rooms().items()}
    view = view_of(NOTHING, rooms=empty)
    assert not [part for part, *_ in view["bodies"]["parts"] if part.startswith("room")]
    assert view["points"]["n"] == 0


@pytest.mark.parametrize(
    ("seen", "told"),
    [
        ({"floor_z_m": 0.0, "ceiling_z_m": 2.6}, "The ceiling is 2.60 m above the floor"),
        ({}, "2.50 m high"),
    ],
)
def test_what_heights_follow_from_is_said(seen, told):
    assert told in view_of(NOTHING, **seen)["heights"]


@pytest.mark.wording
def test_of_scans_in_one_plane_heights_are_not_known():
    unseen = dict.fromkeys(("z_min_m", "z_max_m", "top_m"), np.full(6, np.nan))
    walls = floorplan_making.walls()
    flat = walls | {name: values[: len(walls["wall"])] for name, values in unseen.items()}
    view = view_of(NOTHING, walls=flat)
    assert view["heights"].startswith("Heights are not known: walls are drawn 2.50 m high")
    assert view["height_m"] == 2.5


def test_all_points_are_sent_in_steps_of_the_page(tmp_path):
    report_making.written(tmp_path, report_making.files(tmp_path), name="office")
    output = io.BytesIO()
    sent_points.write_points(tmp_path, output)
    content = output.getvalue()
    n_head = int.from_bytes(content[:4], "little")
    head = json.loads(content[4 : 4 + n_head])
    steps = np.frombuffer(content[4 + n_head :], "<u2").reshape(-1, 3)
    # three scans are chosen, each of four points
    assert (head["n"], head["n_all"]) == (12, 12) == (len(steps), 12) and n_head % 2 == 0
    places_m = np.array(head["low_m"]) + steps[:4] * head["step_m"]
    np.testing.assert_allclose(places_m, report_making.SCANNED_M, atol=0.0051)


def test_more_points_than_a_browser_draws_are_thinned(tmp_path, monkeypatch):
    report_making.written(tmp_path, report_making.files(tmp_path), name="office")
    monkeypatch.setattr(sent_points, "_MOST_SENT", 5)
    output = io.BytesIO()
    sent_points.write_points(tmp_path, output)
    assert b'"n": 6, "n_all": 12' in output.getvalue()


def test_a_page_that_states_no_points_is_told(tmp_path):
    (tmp_path / "report.html").write_text("of an earlier release")
    with refused(file="report.html", remedy="dataset again"):
        sent_points.write_points(tmp_path, io.BytesIO())


def test_the_library_is_the_one_that_its_table_states(project_root):
    table = (project_root / "workflow/report/three/README.md").read_text()
    content = (project_root / "workflow/report/page/three.js").read_bytes()
    assert re.search(r"SHA-256 \| `(\w+)`", table)[1] == hashlib.sha256(content).hexdigest()
    assert int(re.search(r"size \| (\d+) bytes", table)[1]) == len(content)
    release = re.search(r"release \| ([\d.]+),", table)[1]
    assert f"three.js {release}".encode() in content[:100]
    assert b"Permission is hereby granted, free of charge" in content[:500]
    # all that the view uses is in it
    scripts = ("workflow/report/page/solid.js", "workflow/report/page/solid_edits.js")
    text = "".join((project_root / script).read_text() for script in scripts)
    used = re.findall(r"THREE\.(\w+)", text)
    named = (project_root / "workflow/report/three/entry.js").read_text()
    assert set(used) - set(re.findall(r"\w+", named)) == set()
