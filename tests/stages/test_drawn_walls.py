"""Walls that are drawn on the page, and the returns that they go to."""

import json

import numpy as np
import pytest

from helpers import report_making
from helpers.pages import entries, in_sight, needs_browser, press, tap, text_of
from scanplan.store import tables

pytestmark = needs_browser
LINE = [[0.0, 0.0], [3.4, 0.0]]
X_M = 0.05 + np.arange(34) / 10


def row(off_m, x_m=X_M, z_m=1.2):
    """Returns beside the line."""
    x_m = np.asarray(x_m)
    return np.column_stack([x_m, np.broadcast_to(off_m, len(x_m)), np.full(len(x_m), z_m)])


def fit(page, *rows, line=LINE, heights=(0.2, 2.3)):
    xyz_m = np.concatenate(rows).ravel().tolist() if rows else []
    return page.run(f"returns.fit({json.dumps(line)}, {xyz_m}, {list(heights)})")


@pytest.mark.parametrize(
    ("off_m", "ends_m"),
    [
        (0.06, (0.06, 0.06)),
        (-0.13, (-0.13, -0.13)),
        (0.02 + 0.02 * X_M, (0.02, 0.088)),
        (-0.08 + 0.04 * X_M, (-0.08, 0.056)),
        # noise that is the same on both sides, and ends level
        (0.06 + np.resize([0.01, -0.01, -0.01, 0.01], 32), (0.06, 0.06)),
    ],
)
def test_a_line_goes_onto_the_returns_along_it(page, off_m, ends_m):
    found = fit(page, row(off_m, X_M[: np.size(off_m)] if np.size(off_m) > 1 else X_M))
    assert [x for x, _ in found["line"]] == pytest.approx([0, 3.4])
    assert [y for _, y in found["line"]] == pytest.approx(ends_m, abs=1e-6)
    assert found["moved"] == pytest.approx(np.abs(ends_m).max())
    assert found["n"] == (np.size(off_m) if np.size(off_m) > 1 else 34)


def test_it_goes_to_one_side_of_a_wall_and_not_between_both(page):
    shown = [row(0.04, z_m=z_m) for z_m in (0.6, 1.2, 1.8)]
    found = fit(page, *shown, row(-0.06), row(0.14, X_M[:5]))
    assert np.ravel(found["line"]) == pytest.approx([0, 0.04, 3.4, 0.04])
    assert found["n"] == 3 * 34


@pytest.mark.parametrize("n_rows", [(4, 4), (3, 4), (4, 3)])
def test_it_goes_to_the_nearer_side_where_both_are_seen_alike(page, n_rows):
    for near_m, far_m in ((0.04, -0.08), (-0.05, 0.09), (0.04, 0.15), (0.04, 0.17)):
        near = [row(near_m, z_m=0.5 + 0.4 * i) for i in range(n_rows[0])]
        far = [row(far_m, z_m=0.5 + 0.4 * i) for i in range(n_rows[1])]
        found = fit(page, *near, *far)
        assert np.ravel(found["line"]) == pytest.approx([0, near_m, 3.4, near_m])


@pytest.mark.parametrize(
    ("rows", "is_moved"),
    [
        ([row(0.06, X_M[:18])], True),  # along 1.8 m of 3.4 m
        ([row(0.06, X_M[:16]), row(0.06, X_M[:16], 0.8)], False),  # along 1.6 m
        ([row(0.06, X_M[::2])], True),
        ([row(0.06, X_M[::3])], False),
        ([], False),
        ([row(0.149)], True),
        ([row(0.17)], False),
        ([row(0.06, z_m=0.1), row(0.06, z_m=2.4)], False),  # of floor and ceiling
        ([row(-0.1, X_M[:16]), row(0.1, X_M[18:])], False),  # of two walls, neither as long
    ],
)
def test_it_stays_without_returns_along_half_of_it(page, rows, is_moved):
    assert (fit(page, *rows) is not None) == is_moved


def test_few_returns_are_not_followed(page):
    short = [[0.0, 0.0], [1.0, 0.0]]
    assert fit(page, row(0.06, X_M[:9]), line=short) is None
    assert fit(page, row(0.06, X_M[:10]), line=short)["n"] == 10


@pytest.mark.parametrize("seed", range(20))
def test_whatever_is_near_it_lies_on_the_wall_anywhere(page, seed):
    rng = np.random.default_rng(seed)
    way = rng.uniform(0, 2 * np.pi)
    along, left = np.array([[np.cos(way), np.sin(way)], [-np.sin(way), np.cos(way)]])
    start_m, length_m = rng.uniform(-20, 20, 2), rng.uniform(1.5, 6)
    at_m = rng.uniform(0, length_m, 400)
    wall_m = start_m + at_m[:, None] * along + rng.normal(0, 0.01, 400)[:, None] * left
    stray_m = start_m + rng.uniform(-0.5, 0.5, (60, 2)) + rng.uniform(0, length_m, (60, 1)) * along
    xyz_m = np.column_stack([np.concatenate([wall_m, stray_m]), np.ones(460)])
    shift_m = rng.uniform(-0.1, 0.1, 2)
    ends_m = start_m + np.array([[0], [length_m]]) * along
    drawn = (ends_m + shift_m[:, None] * left).tolist()
    ends_off_m = (np.array(fit(page, xyz_m, line=drawn)["line"]) - start_m) @ left
    # a quarter of the noise: its mean over 400 returns is twenty times less, at ends half of it
    assert np.abs(ends_off_m).max() < 0.004


# --- drawn by two taps ---
WALL_M = np.array([(2.0, y, z) for y in np.arange(0.05, 3, 0.05) for z in (0.6, 1.2, 1.8)])


def write_report(folder, points_m, *, planar=False):
    files = report_making.files(folder)
    with tables.open_scan_writer(files["scans"], planar=planar) as write:
        for scan_id in report_making.SCAN_IDS[:4]:
            write(scan_id, points_m if scan_id == 12 else report_making.SCANNED_M)
    return report_making.written(folder, files)


def draw_wall(page, report, *places_m):
    """Draw a wall in the report of somebody who has said nothing yet; return its ends."""
    page.open(report.as_uri())
    page.run("localStorage.clear()")
    page.open(report.as_uri())
    press(page, "Draw")
    press(page, "Wall", "#draw")
    tap(page, *places_m)
    page.run("returns.read().then(() => null)")
    (entry,) = entries(page)
    assert entry.keys() == {"element", "action", "line"}
    return np.array(entry["line"])


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.wording
def test_a_wall_drawn_beside_one_that_is_missing_lies_on_its_returns(chromium, tmp_path, planar):
    points_m = WALL_M[1::3] if planar else WALL_M
    report = write_report(tmp_path, points_m, planar=planar)
    ends_m = draw_wall(chromium, report, (2.08, -0.05), (2.08, 3.05))
    assert ends_m[:, 0] == pytest.approx([2.0, 2.0], abs=0.02)
    # on the walls that it leads to, as it was drawn
    assert ends_m[:, 1] == pytest.approx([-0.1, 3.1], abs=0.001)
    # one point more is on the floor, which surveys in one plane know nothing of, and one on a wall
    n_returns = len(points_m) + 1 + planar
    # where it is tapped is exact to a pixel
    assert text_of(chromium, "#hint") in [
        f"On {n_returns} returns, moved by {moved_cm} cm" for moved_cm in (7, 8, 9)
    ]
    press(chromium, "Undo", "#corrections")
    assert entries(chromium) == [] and in_sight(chromium, "#edits [data-entry]") == 0
    assert chromium.complaints == []


def test_ends_that_lie_on_no_wall_stay_where_they_were_put_along_it(chromium, tmp_path):
    report = write_report(tmp_path, WALL_M)
    ends_m = draw_wall(chromium, report, (2.08, 0.7), (2.08, 2.3))
    assert ends_m[:, 0] == pytest.approx([2.0, 2.0], abs=0.005)
    assert ends_m[:, 1] == pytest.approx([0.7, 2.3], abs=0.01)


def test_an_end_on_a_slanting_wall_stays_on_it(chromium, tmp_path):
    chromium.open(write_report(tmp_path, WALL_M).as_uri())
    chromium.run("localStorage.clear(), edits.entries().forEach(edits.takeBack)")
    chromium.run("edits.add({element: 'wall', action: 'add', line: [[1.5, 1], [2.5, 1.4]]})")
    found = chromium.run("returns.settle([[2.08, 1.232], [2.08, 3.1]])")
    assert np.array(found["line"]) == pytest.approx(np.array([[2, 1.2], [2, 3.1]]), abs=0.002)


def test_what_was_taken_back_does_not_come_again_with_its_returns(page):
    page.run("window.drawn = {element: 'wall', action: 'add', line: [[2, 1], [2, 2]]}")
    page.run("edits.add(drawn), edits.undo()")
    assert page.run("edits.refine(drawn, {line: [[3, 1], [3, 2]]})") is False
    assert entries(page) == []
    page.run("edits.redo()")
    assert page.run("edits.refine(drawn, {line: [[3, 1], [3, 2]]})") is True
    assert [entry["line"] for entry in entries(page)] == [[[3, 1], [3, 2]]]
    page.run("edits.undo()")
    assert entries(page) == []


def test_a_wall_that_nobody_saw_stays_where_it_was_drawn(chromium, tmp_path):
    report = write_report(tmp_path, WALL_M)
    ends_m = draw_wall(chromium, report, (3.0, -0.05), (3.0, 3.05))
    assert ends_m[:, 0] == pytest.approx([3.0, 3.0], abs=0.01)
    assert in_sight(chromium, "#hint") == 0


def test_a_wall_drawn_along_another_stays_on_it(chromium, tmp_path):
    beside_m = np.array([(x, 3.0, z) for x in np.arange(0, 4, 0.05) for z in (0.6, 1.2, 1.8)])
    report = write_report(tmp_path, beside_m)
    ends_m = draw_wall(chromium, report, (1.0, 3.1), (2.0, 3.1))
    assert ends_m[:, 1] == pytest.approx([3.1, 3.1], abs=0.001)
    assert in_sight(chromium, "#hint") == 0
