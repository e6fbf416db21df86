"""One table of many datasets."""

import math

import numpy as np
import pytest
import shapely

from scanplan.report import overview
from scanplan.store import schemas, tables


def some(schema, n, **columns):
    """Return a table's columns, zero or empty where not given."""
    filled = {}
    for name, kind in schema.columns.items():
        empty = {"string": "", "binary": b""}.get(kind, 0)
        filled[name] = np.full(n, empty, object if kind in ("string", "binary") else kind)
    return filled | columns


def make_results(folder, predicted=0.75):
    kept = np.array([True, True, False])
    registration = some(schemas.REGISTRATION, 3, scan_id=np.arange(3, dtype=np.int32), kept=kept)
    tables.write_table(folder / "registration.parquet", schemas.REGISTRATION, registration)
    rooms = some(schemas.ROOMS, 2, room=np.array([1, 2], np.int32))
    rooms |= {"area_m2": np.array([10.0, 2.5]), "closed": np.array([True, False])}
    rooms["geometry"] = shapely.to_wkb(np.array([shapely.box(0, 0, 5, 2), shapely.box(5, 0, 6, 2)]))
    straight = dict.fromkeys(("arc_x_m", "arc_y_m", "arc_radius_m"), np.array([math.nan]))
    walls = some(schemas.PLAN_WALLS, 1, verify=np.array([True]), **straight)
    openings = some(schemas.OPENINGS, 3, opening=np.arange(3, dtype=np.int32))
    openings["type"] = np.array(["door", "window", "door"], object)
    rays = some(schemas.VALIDATION, 1, share=np.array([predicted]))
    numbers = [0, 1, 2, 1, 2, 0]
    rated = some(schemas.CONFIDENCE, 6, number=np.array(numbers, np.int32), p_true=np.ones(6))
    rated["table"] = np.array([*["openings"] * 3, *["rooms"] * 2, "walls"], object)
    rated["verify"] = np.array([False, False, True, False, True, True])
    plan = {
        "faces": (schemas.FACES, some(schemas.FACES, 1)),
        "free": (schemas.FREE, some(schemas.FREE, 0)),
        "rooms": (schemas.ROOMS, rooms),
        "walls": (schemas.PLAN_WALLS, walls),
        "openings": (schemas.OPENINGS, openings),
        "confidence": (schemas.CONFIDENCE, rated),
        "validation": (schemas.VALIDATION, rays),
    }
    for name, (schema, columns) in plan.items():
        notes = dict.fromkeys(("n_left_out", "n_scans", "tolerance_m", "absent"), "1")
        path = folder / "plan" / f"{name}.parquet"
        told = notes if name == "validation" else None
        tables.write_table(path, schema, columns, allow_empty=True, notes=told)
    for page in ("plan/plan.svg", "report.html"):
        (folder / page).touch()


def states_of(rows):
    return [row["state"] for row in rows]


def test_a_plan_a_fault_and_what_was_not_got_to(tmp_path):
    make_results(tmp_path / "results/first")
    times = tmp_path / "benchmarks/first/register_scans.tsv"
    times.parent.mkdir(parents=True)
    times.write_text("s\tmax_rss\n2.5\t100\n1.5\t-\n-\t-\n")
    faults = {"third": [], "second": ["register_scans: too few <scans>"], "first": []}
    run_times = {"third": [], "second": [], "first": [times]}
    rows = overview.gather_overview(tmp_path / "results", faults, run_times)
    assert [row["name"] for row in rows] == ["first", "second", "third"]
    assert states_of(rows) == [overview.MADE, overview.FAILED, overview.MISSING]
    first = rows[0]
    assert (first["area_m2"], first["rooms"], first["open_rooms"]) == (12.5, 2, 1)
    assert (first["doors"], first["windows"], first["passages"]) == (2, 1, 0)
    assert (first["chosen"], first["registered"], first["candidates"]) == (1, 2, 3)
    # the wall, a door, and the room that is not closed
    assert (first["verify"], first["predicted"], first["seconds"]) == (3, 0.75, 4.0)
    assert [math.isnan(row["area_m2"]) for row in rows] == [False, True, True]


def test_tables_of_an_interrupted_run_are_no_plan_to_look_at(tmp_path):
    make_results(tmp_path / "results/first")
    (tmp_path / "results/first/report.html").unlink()
    rows = overview.gather_overview(tmp_path / "results", {"first": []}, {"first": []})
    assert states_of(rows) == [overview.MISSING] and math.isnan(rows[0]["area_m2"])


@pytest.mark.wording
def test_the_page_says_all_and_takes_names_for_text(tmp_path, project_root):
    folder = project_root / "workflow/report/page"
    sources = {name: (folder / name).read_text() for name in ("overview.html.j2", "overview.css")}
    make_results(tmp_path / "results/first")
    faults = {"first": [], "second": ["register_scans: too few <scans>"]}
    rows = overview.gather_overview(tmp_path / "results", faults, dict.fromkeys(faults, ()))
    table, page = overview.write_overview(rows, tmp_path / "results", sources)
    text = page.read_text()
    assert 'href="first/report.html"' in text and "75.0%" in text
    assert "1 with a plan" in text and "1 failed" in text
    assert "too few &lt;scans&gt;" in text and 'href="second' not in text
    assert text.index("too few") < text.index('href="first/report.html"')
    columns = tables.read_table(table, schemas.OVERVIEW)
    for name, values in columns.items():
        np.testing.assert_array_equal(values, [row[name] for row in rows])


def test_what_is_not_known_is_left_blank(tmp_path, project_root):
    folder = project_root / "workflow/report/page"
    sources = {name: (folder / name).read_text() for name in ("overview.html.j2", "overview.css")}
    make_results(tmp_path / "results/first", predicted=np.nan)
    rows = overview.gather_overview(tmp_path / "results", {"first": []}, {"first": []})
    _, page = overview.write_overview(rows, tmp_path / "results", sources)
    assert '<td class="number"></td>' in page.read_text()


def test_nothing_at_all_is_a_page_too(tmp_path, project_root):
    folder = project_root / "workflow/report/page"
    sources = {name: (folder / name).read_text() for name in ("overview.html.j2", "overview.css")}
    rows = overview.gather_overview(tmp_path / "results", {"a": [], "b": []}, {"a": [], "b": []})
    _, page = overview.write_overview(rows, tmp_path / "results", sources)
    assert "2 no plan" in page.read_text()
