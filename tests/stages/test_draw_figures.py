from xml.etree import ElementTree

import numpy as np
import pytest
import shapely

from draw_figures import draw_figures
from helpers import face_making, floorplan_making
from helpers.wall_making import BARE, walls
from scanplan.errors import StageError
from scanplan.store import schemas, tables
from thesis.stages.draw_area import draw_area


@pytest.fixture
def results(tmp_path):
    """Two kept scans (0, 4) and a dropped one (2) in a room of 6 m x 4 m."""
    rng = np.random.default_rng(1)
    with tables.open_scan_writer(tmp_path / "scans.parquet", planar=False) as write:
        for scan_id in (0, 4):
            write(
                scan_id,
                np.column_stack(
                    [rng.uniform(0, 6, 500), rng.choice([0, 4], 500), rng.uniform(0, 2, 500)]
                ),
            )
    pose = dict(
        zip(
            (*schemas.XYZ, *schemas.QUAT),
            ([1, 2, 3], [2, 2, 2], *np.zeros((4, 3)), np.ones(3)),
            strict=True,
        )
    )
    ones = np.ones(3)
    tables.write_table(
        tmp_path / "registration.parquet",
        schemas.REGISTRATION,
        {
            "scan_id": [0, 2, 4],
            "t_ns": [0, 1, 2],
            "kept": [True, False, True],
            "reason": ["kept", "fit", "kept"],
        }
        | dict.fromkeys(("prior_fitness", "refined_fitness", "rmse_m", *schemas.COVARIANCE), ones)
        | pose,
    )
    for method in ("cluster_hull", "random"):
        measures = ("gain_m2", "covered_m2", "bound_m2", "gain", "covered", "bound")
        columns = dict.fromkeys(measures, np.array([5.0, 9.0]))
        known = {"rank": [1, 2], "scan_id": [4, 0], "n_points": [500, 500]}
        tables.write_table(tmp_path / f"{method}.parquet", schemas.SELECTION, known | columns)
    merged = face_making.merge(walls([(0, 0, 6, 0), (6, 4, 0, 4)]), BARE)
    tables.write_table(tmp_path / "faces.parquet", schemas.FACES, merged)
    notes = {"floor_z_m": "0.0", "ceiling_z_m": "2.0"}
    tables.write_table(
        tmp_path / "free.parquet", schemas.FREE, floorplan_making.free(), notes=notes
    )
    write_audit(tmp_path)
    write_validation(tmp_path)
    return tmp_path


def write_audit(folder):
    """One link between the kept scans, and the map's thickness by two kinds of poses."""
    spread = {key: [0.031, 0.012] for key in ("sigma_m", "quarter_below_m", "quarter_above_m")}
    crispness = {"poses": ["localiser", "registered"], "n_places": [9, 9], **spread}
    tables.write_table(folder / "crispness.parquet", schemas.CRISPNESS, crispness)
    link = {"source": [4], "target": [0], "kind": ["sequence"], "inlier": [True]}
    others = set(schemas.EDGES.columns) - set(link)
    link |= {name: [0] if name == "unobservable" else [0.01] for name in others}
    tables.write_table(folder / "edges.parquet", schemas.EDGES, link)


def write_validation(folder):
    """No ray tests the plan; one face is judged, and the whole."""
    columns = {"kind": ["face", "plan_length", "plan_rays"], "number": [1, 0, 0]}
    ends_m = dict(zip(("x0_m", "y0_m", "x1_m", "y1_m"), (0.0, 0.0, 6.0, 0.0), strict=True))
    columns |= {name: [end_m, np.nan, np.nan] for name, end_m in ends_m.items()}
    shares = {"share", "share_low", "share_high"}
    columns |= {name: [np.nan] * 3 for name in shares}
    others = set(schemas.VALIDATION.columns) - set(columns)
    columns |= {name: [0] * 3 for name in others}
    notes = {"n_left_out": "0", "n_scans": "0", "tolerance_m": "0.05", "absent": "none is left"}
    tables.write_table(folder / "elements.parquet", schemas.VALIDATION, columns, notes=notes)
    none = {name: [] for name in schemas.VALIDATION_RAYS.columns}
    tables.write_table(folder / "rays.parquet", schemas.VALIDATION_RAYS, none, allow_empty=True)


def draw(results, folder, n_scans=1):
    """Draw all figures of some results; return their texts by name."""
    folder.mkdir()
    names = ("scans", "registration", "edges", "crispness", "faces", "free", "elements", "rays")
    made = {name: results / f"{name}.parquet" for name in names}
    made["selection"] = results / "cluster_hull.parquet"
    figures = ("registration", "scans", "walls", "validation", "deviation")
    outputs = {name: folder / f"{name}.svg" for name in figures}
    draw_figures(made, outputs, n_scans=n_scans, area_share=None)
    return {name: path.read_text() for name, path in outputs.items()}


def drawn_twice(draw, output):
    draw(output)
    first = output.read_bytes()
    draw(output)
    assert output.read_bytes() == first
    ElementTree.fromstring(first)
    return first.decode()


@pytest.mark.wording
def test_each_figure_states_what_it_shows(results, tmp_path):
    drawn = draw(results, tmp_path / "once")
    for text in drawn.values():
        ElementTree.fromstring(text)
    assert "2 of 3 candidates kept" in drawn["registration"]
    assert "31 mm localiser, 12 mm registered" in drawn["registration"]
    assert "link to a neighbour (1)" in drawn["registration"]
    assert "position of a scan (2)" in drawn["scans"]
    assert "numbered by rank (1)" in drawn["scans"]
    assert "wall face (2)" in drawn["walls"]
    assert "position of a selected scan (1)" in drawn["walls"]
    assert "none is left" in drawn["validation"]


def test_figures_are_the_same_bytes_again(results, tmp_path):
    assert draw(results, tmp_path / "once") == draw(results, tmp_path / "again")


@pytest.mark.wording
def test_all_scans_may_be_selected(results, tmp_path):
    drawn = draw(results, tmp_path / "all", n_scans=None)
    assert "numbered by rank (2)" in drawn["scans"]
    assert "position of a selected scan (2)" in drawn["walls"]


def write_hulls(path):
    columns = {
        "scan_id": [0, 4],
        "cluster": [0, 0],
        "n_points": [500, 500],
        "area_m2": [1.0, 3.0],
        "geometry": shapely.to_wkb([shapely.box(0, 0, 1, 1), shapely.box(2, 0, 5, 1)]),
    }
    tables.write_table(path, schemas.HULLS, columns)
    return path


def test_draw_area(results):
    hulls = write_hulls(results / "hulls.parquet")
    unmeasured = {name: [np.nan, np.nan] for name in ("gain_m2", "covered_m2", "bound_m2")}
    by_walls = {"rank": [1, 2], "scan_id": [4, 0], "n_points": [500, 500], **unmeasured}
    by_walls |= {name: [7.0, 8.0] for name in ("gain", "covered", "bound")}
    tables.write_table(results / "wall_length.parquet", schemas.SELECTION, by_walls)
    methods = ("cluster_hull", "random", "wall_length")
    inputs = [results / f"{name}.parquet" for name in methods]
    text = drawn_twice(lambda o: draw_area(inputs, hulls, o), results / "area.svg")
    for label in ("greedy by cluster hulls", "random", "greedy by wall length"):
        assert f"{label}: 99 % with 2" in text


def test_tables_of_different_runs_are_refused(results, tmp_path):
    registration = tables.read_table(results / "registration.parquet", schemas.REGISTRATION)
    registration["kept"] = np.array([False, False, True])
    tables.write_table(results / "registration.parquet", schemas.REGISTRATION, registration)
    with pytest.raises(StageError, match="scan 0 "):
        draw(results, tmp_path / "drawn", n_scans=None)
    assert not list((tmp_path / "drawn").iterdir())
