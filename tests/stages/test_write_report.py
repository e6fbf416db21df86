import re
from html.parser import HTMLParser

import numpy as np
import pytest

from helpers import floorplan_making, report_making
from helpers.pages import click, in_sight, middle_of, needs_browser, text_of
from helpers.refusals import refused
from scanplan.recordings.motion import pose_kind
from scanplan.store import schemas, tables


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    return report_making.written(folder, report_making.files(folder))


class Tables(HTMLParser):
    """The tables of a page: id to rows of texts."""

    def __init__(self, text):
        super().__init__()
        self.rows, self._table, self._cell = {}, None, False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == "table":
            self._table = self.rows.setdefault(dict(attributes)["id"], [])
        elif tag == "tr":
            self._table.append([])
        elif tag in ("td", "th"):
            self._table[-1].append("")
            self._cell = True

    def handle_endtag(self, tag):
        self._cell &= tag not in ("td", "th")

    def handle_data(self, data):
        if self._cell:
            self._table[-1][-1] += data


def test_tables_state_what_the_stages_found(report):
    found = Tables(report.read_text()).rows
    assert found["walls"][1][:8] == ["0", "", "observed", "7.20", "200", "", "2.0", "10.0"]
    assert found["walls"][2][4] == "–"
    assert found["walls"][3][1:3] == ["few points", "inferred"]
    joined = ["door", "0.90", "0.00", "2.00", "Room 0 – Room 1", "40", ""]
    assert found["openings"][2] == ["1", "", *joined]
    assert found["rooms"][1] == ["0", "Room 0", "", "12.00", "14.00", "yes", "2", ""]
    assert found["registration"][1] == ["kept", "yes", "3", "60.0", "0.800", "0.900", "50", "30"]
    assert found["stages"][1:] == [
        ["build_hulls", "2.5", "3.4", "444"],
        ["draw_area", "0.1", "–", "–"],
        ["all", "2.6", "3.4", ""],
    ]
    is_true = "share of the drawn faces' length that is true, within 0.10 m"
    assert found["truth"][0] == ["measure", "registered", "aligned", "meaning"]
    assert ["correctness 010m", "0.980", "0.970", is_true] in found["truth"]
    assert found["sizes"][1] == ["recording", "survey.bag", "2.500"]
    assert ["plan.merge.min_scans", "2"] in found["settings"]


def test_of_odometry_the_figures_after_one_motion_come_first(tmp_path):
    files = report_making.files(tmp_path)
    notes = {pose_kind.NOTE: pose_kind.ODOMETRY, schemas.N_RECORDED: "23"}
    tables.write_table(files["poses"], schemas.POSES, report_making.poses(), notes=notes)
    text = report_making.written(tmp_path, files).read_text()
    assert Tables(text).rows["truth"][0][1:3] == ["aligned", "registered"]


@pytest.mark.wording
def test_it_says_what_it_was_made_of_and_how_good_that_is(report):
    text = report.read_text()
    assert "made of 3 scans chosen from 4 registered ones; 5 were candidates" in text
    assert "The plan is made of 3 of 4 registered scans, which give 95.0% of the" in text
    assert "wall shown of all (19.0 of 20.0 m)" in text
    assert (
        "the best possible 3 scans would give at most 19.5 m: this choice is within 2.6% of it"
        in text
    )
    assert "office &lt;two&gt; rooms" in text and "<two>" not in text


def test_it_says_how_well_the_plan_predicts(report):
    said = report.read_text().partition('<p id="prediction">')[2].partition("</p>")[0]
    counted = ["1 ", "1,000", "90.0%", "85.0%", "93.0%", "7.0%", "2.0%", "1.0%", "95.0%"]
    assert re.findall(r"[\d,.]+%|\d,\d{3}|\b1 ", said) == counted


def links(report):
    return re.findall(r'<a [^>]*href="([^"#][^"]*)"', report.read_text())


def test_its_links_lead_to_the_files_beside_it(report):
    assert links(report) == ["plan.svg", "plan.dxf", "summary.txt"]
    assert all((report.parent / link).is_file() for link in links(report))


def test_the_reports_of_a_building_lead_to_each_other(tmp_path):
    storeys = [("Ground", "floor_0"), ("First", "floor_1")]
    made = report_making.written(
        tmp_path, report_making.files(tmp_path), name="floor_1", storeys=storeys
    )
    switch = made.read_text().partition('<nav id="storeys"')[2].partition("</nav>")[0]
    assert re.findall(r'href="([^"]*)"( aria-current="page")?>([^<]*)<', switch) == [
        ("../floor_0/report.html", "", "Ground"),
        ("../floor_1/report.html", ' aria-current="page"', "First"),
    ]
    alone = report_making.written(tmp_path, report_making.files(tmp_path))
    assert 'id="storeys"' not in alone.read_text()


def test_what_to_verify_comes_before_all_tables(report):
    text = report.read_text()
    listed = re.findall(r'data-show="([^"]*)"><.*?<span class="note"><b>([^<]*)</b> ([^<]*)<', text)
    assert listed == [("wall 2", "Wall 2", "few points")]
    assert text.index("data-show=") < text.index("<table")


def test_it_holds_all_it_needs(report):
    text = report.read_text()
    # names of namespaces and the figures' own data apart, there is no address in it
    addresses = re.findall(r"""(?:href|src)\s*=\s*["']([^"']*)|url\(([^)]*)|@import""", text)
    own = ("data:", "#", *links(report))
    assert addresses and all(a.startswith(own) for pair in addresses for a in pair if a)
    assert "http-equiv" in text and "default-src 'none'" in text


def test_the_same_input_gives_the_same_bytes(report, tmp_path):
    assert (
        report_making.written(tmp_path, report_making.files(tmp_path)).read_bytes()
        == report.read_bytes()
    )


def test_faces_alone_without_truth_and_times_make_a_report(tmp_path):
    files = report_making.files(tmp_path)
    for name, schema in (
        ("walls", schemas.PLAN_WALLS),
        ("openings", schemas.OPENINGS),
        ("rooms", schemas.ROOMS),
    ):
        tables.write_table(
            files[name], schema, getattr(floorplan_making, name)([]), allow_empty=True
        )
    nobody = {column: values[:0] for column, values in floorplan_making.evidence().items()}
    tables.write_table(files["evidence"], schemas.EVIDENCE, nobody, allow_empty=True)
    (tmp_path / "benchmarks/build_hulls.tsv").write_text("")
    (tmp_path / "benchmarks/draw_area.tsv").unlink()
    found = Tables(
        report_making.written(tmp_path, files | {"evaluation": [], "figures": []}).read_text()
    ).rows
    assert len(found["walls"]) == 1 and len(found["stages"]) == 1


@pytest.mark.wording
def test_a_survey_without_any_wall_in_sight_makes_a_report(tmp_path):
    files = report_making.files(tmp_path)
    nothing = {column: np.zeros(4) for column in ("gain", "covered", "bound")}
    tables.write_table(files["selection"], schemas.SELECTION, report_making.selection() | nothing)
    assert "no scan has any wall shown" in report_making.written(tmp_path, files).read_text()


def test_a_selection_of_another_run_is_told(tmp_path):
    files = report_making.files(tmp_path)
    selection = report_making.selection() | {"scan_id": np.array([9, 7, 12, 0], np.int32)}
    tables.write_table(files["selection"], schemas.SELECTION, selection)
    with refused(file="selection", value="scan 7"):
        report_making.written(tmp_path, files)


CTRL = 2  # of DevTools' modifier keys


@pytest.fixture
def page(report, chromium):
    yield chromium.open(report.as_uri())
    assert chromium.complaints == []


def slide(page, k):
    page.run(
        f"slider = document.getElementById('k'), slider.value = {k},"
        " slider.dispatchEvent(new Event('input'))"
    )


@needs_browser
@pytest.mark.wording
def test_the_slider_moves_the_plan(page):
    def state():
        return [in_sight(page, s) for s in (".scan", ".stretch", ".stretch.sure", "#shown path")]

    whole = page.screenshot()
    assert (
        state()[0] == 3
        and page.run("document.getElementById('plan').classList.contains('growing')") is False
    )
    slide(page, 1)
    # the first scan shows three faces, none of them by two; the second adds two, and one is sure
    assert state() == [1, 3, 0, 1]
    assert page.screenshot() != whole
    slide(page, 2)
    assert state() == [2, 5, 1, 1]
    assert "2 of 3 (scan 5): 90.0 % of the wall shown" in page.run(
        "document.getElementById('said').textContent"
    )
    slide(page, 3)
    assert state() == [3, 5, 2, 0]


@needs_browser
def test_the_mark_in_the_chart_follows_the_slider(page):
    def marked():
        return page.run("document.getElementById('chart-k').getBoundingClientRect().x")

    slide(page, 1)
    first = marked()
    slide(page, 2)
    assert marked() > first + 50


@needs_browser
def test_wheel_drag_and_keys_zoom_and_move(page):
    def box():
        return np.array(
            page.run("document.getElementById('plan').getAttribute('viewBox')").split(), float
        )

    fit = box()
    page.mouse("mouseWheel", 640, 500, deltaX=0, deltaY=-300, modifiers=CTRL)
    nearer = box()
    assert nearer[2] < 0.5 * fit[2] and nearer[2] / nearer[3] == pytest.approx(fit[2] / fit[3])
    page.drag((640, 500), (740, 540))
    dragged = box()
    assert dragged[0] < nearer[0] and dragged[1] < nearer[1] and dragged[2] == nearer[2]
    page.run("document.getElementById('plan').focus()")
    page.key("ArrowRight")
    assert box()[0] > dragged[0]
    page.key("+")
    assert box()[2] < dragged[2]
    page.run("document.querySelector('[data-zoom=fit]').click()")
    np.testing.assert_allclose(box(), fit)


@needs_browser
def test_what_lies_under_the_pointer_stays_there_when_the_wheel_turns(page):
    def under():
        to_plan = "document.getElementById('plan').getScreenCTM().inverse()"
        return page.run(f"(p => [p.x, p.y])(new DOMPoint(500, 480).matrixTransform({to_plan}))")

    before = under()
    page.mouse("mouseWheel", 500, 480, deltaX=0, deltaY=-240, modifiers=CTRL)
    assert under() == pytest.approx(before, abs=1e-3)


@needs_browser
def test_a_table_is_sorted_by_any_column_and_a_row_shows_its_wall(page):
    def column(number):
        return page.run(
            "[...document.querySelectorAll('#walls tbody tr')]"
            f".map(r => r.cells[{number}].textContent)"
        )

    page.run("document.querySelectorAll('#walls th button')[3].click()")
    assert column(3) == ["3.05", "3.20", "3.20", "3.20", "4.15", "7.20"]
    page.run("document.querySelectorAll('#walls th button')[3].click()")
    assert column(3)[0] == "7.20"
    assert (
        page.run("document.querySelectorAll('#walls th')[3].getAttribute('aria-sort')")
        == "descending"
    )
    page.run("document.querySelector('#walls tr[data-element=\"wall 5\"]').click()")
    shown = "[...document.querySelectorAll('#plan .picked')].map(e => e.dataset.element)"
    assert page.run(shown) == ["wall 5"]


@needs_browser
def test_a_click_says_what_was_clicked_beside_it_and_marks_its_row(page):
    place = middle_of(page, '#plan .pick[data-element="wall 3"]')
    click(page, place)
    rows = "[...document.querySelectorAll('tr.picked')].map(e => e.dataset.element)"
    assert page.run(rows) == ["wall 3"]
    assert text_of(page, "#card h2") == "Wall 3" and "4.15" in text_of(page, "#card")
    left, top, right, bottom = page.run(
        "(r => [r.left, r.top, r.right, r.bottom])"
        "(document.getElementById('card').getBoundingClientRect())"
    )
    across = max(left - place[0], place[0] - right)
    assert 0 < across < 40 and top - 40 < place[1] < bottom + 40


@needs_browser
def test_what_to_verify_is_shown_where_it_is(page):
    page.run("document.querySelector('[data-show=\"wall 2\"]').click()")
    assert "To verify: few points" in text_of(page, "#card")
    x, y = middle_of(page, '#plan .pick[data-element="wall 2"]')
    view = middle_of(page, "#view")
    assert abs(x - view[0]) < 5 and abs(y - view[1]) < 5


@needs_browser
def test_the_tape_measures_what_lies_between_two_clicks(page):
    # the corners of the first room's outline are 4 m and 3 m apart
    corners = page.run(
        "(r => [[r.left, r.bottom], [r.right, r.top]])"
        "(document.querySelector('#plan .room').getBoundingClientRect())"
    )
    page.run("document.getElementById('measure').click()")
    for corner in corners:
        click(page, corner)
    said = page.run("document.querySelector('#tape text').textContent")
    assert float(said.removesuffix(" m")) == pytest.approx(5, abs=0.05)
    page.key("Escape")
    assert in_sight(page, "#tape path") == 0


@needs_browser
def test_letters_are_as_large_however_near_the_plan_is(page):
    def height():
        box = "document.querySelector('#plan .label text').getBoundingClientRect().height"
        return page.run(box)

    far = height()
    page.run("document.querySelector('[data-zoom=in]').click()")
    assert height() == pytest.approx(far, abs=0.5) and 10 < far < 24


@needs_browser
def test_the_wheel_over_the_plan_scrolls_the_page(page):
    page.mouse("mouseWheel", 500, 400, deltaX=0, deltaY=200)
    page.run("new Promise(done => setTimeout(done, 300))")
    assert page.run("scrollY") > 100


SIZES = [(1600, 1000), (1280, 800), (390, 844), (360, 640)]


@needs_browser
@pytest.mark.parametrize(("width", "height"), SIZES)
def test_plan_and_slider_are_in_the_first_screen_and_nothing_is_wider(
    report, chromium, width, height
):
    page = chromium.open(report.as_uri(), width=width, height=height)
    low = "document.getElementById('{}').getBoundingClientRect().bottom"
    assert page.run(low.format("plan")) < height and page.run(low.format("k")) <= height
    assert page.run("document.documentElement.scrollWidth") <= width
    assert text_of(page, "#files a") == "drawing (SVG)"
    assert page.complaints == []


@needs_browser
def test_points_lie_under_the_walls_where_they_were_measured(page):
    # both ends of the image are known: half a metre around the plan
    x, y, width, height = page.run(
        "['x', 'y', 'width', 'height'].map(a => Number(document.querySelector('#points image')"
        ".getAttribute(a)))"
    )
    assert (x, y + height) == pytest.approx((-0.7, 0.7), abs=1e-6)
    assert page.run("document.querySelector('#points').compareDocumentPosition("
                    "document.querySelector('#finished'))") == 4  # fmt: skip
    assert (width, height) == pytest.approx((8.4, 4.4), abs=0.05)


@needs_browser
def test_play_grows_the_plan_to_its_end(page):
    page.run("document.getElementById('play').click()")
    assert page.run("document.getElementById('play').textContent") == "Stop"
    page.run(
        "new Promise(done => new MutationObserver(done)"
        ".observe(document.getElementById('play'), {childList: true}))"
    )
    assert page.run("document.getElementById('play').textContent") == "Play"
    assert page.run("document.getElementById('k').value") == "3"


@needs_browser
def test_layers_can_be_hidden(page):
    page.run("document.querySelector('[data-layer=scans]').click()")
    assert in_sight(page, ".scan") == 0


@needs_browser
def test_it_is_dark_where_the_person_likes_it_dark(report, chromium):
    def ground(dark):
        colour = chromium.open(report.as_uri(), dark=dark).run(
            "getComputedStyle(document.body).backgroundColor"
        )
        return sum(map(int, re.findall(r"\d+", colour)))

    assert ground(True) < 150 < 600 < ground(False)


@needs_browser
def test_the_browser_tells_when_a_page_complains(chromium, tmp_path):
    wrong = tmp_path / "wrong.html"
    wrong.write_text('<img src="missing.png"><script>console.error("no"); missing()</script>')
    said = "\n".join(chromium.open(wrong.as_uri()).complaints)
    assert "no" in said and "ReferenceError" in said and "request of" in said


def test_the_key_names_each_kind_of_opening_that_is_drawn_as_it_is_drawn(tmp_path):
    files = report_making.files(tmp_path)
    kinds = np.array(["door", "gap", "glass"], object)
    openings = floorplan_making.openings() | {"type": kinds}
    tables.write_table(files["openings"], schemas.OPENINGS, openings)
    text = report_making.written(tmp_path, files).read_text()
    key = text.partition('<p class="key">')[2].partition("</p>")[0]
    named = re.findall(r'swatch (door|gap|glass|passage|window)"></span>([^<]*)', key)
    assert [(kind, words.strip()) for kind, words in named] == [
        ("door", "door"),
        ("glass", "glass pane"),
        ("gap", "unknown gap"),
    ]
    style = (report_making.PAGE / "page.css").read_text()
    kinds = "door|gap|glass|passage|window"
    rules = re.findall(rf"\.swatch\.(?:{kinds}) {{([^}}]*)", style)
    assert len(set(rules)) == 5
