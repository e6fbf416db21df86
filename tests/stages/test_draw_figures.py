from xml.etree import ElementTree

import numpy as np
import pytest
import shapely

from draw_area import draw_area
from draw_scans import draw_scans
from draw_walls import draw_walls
from helpers import face_making
from helpers.wall_making import BARE, walls
from scanplan.errors import StageError
from scanplan.store import schemas, tables


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
        | dict.fromkeys(("prior_fitness", "refined_fitness", "rmse_m"), ones)
        | pose,
    )
    for method in ("cluster_hull", "random"):
        measures = ("gain_m2", "covered_m2", "bound_m2", "gain", "covered", "bound")
        columns = dict.fromkeys(measures, np.array([5.0, 9.0]))
        known = {"rank": [1, 2], "scan_id": [4, 0], "n_points": [500, 500]}
        tables.write_table(tmp_path / f"{method}.parquet", schemas.SELECTION, known | columns)
    merged = face_making.merge(walls([(0, 0, 6, 0), (6, 4, 0, 4)]), BARE)
    tables.write_table(tmp_path / "faces.parquet", schemas.FACES, merged)
    return tmp_path


def drawn_twice(draw, output):
    draw(output)
    first = output.read_bytes()
    draw(output)
    assert output.read_bytes() == first
    ElementTree.fromstring(first)
    return first.decode()


def test_draw_scans(results):
    inputs = [results / f"{name}.parquet" for name in ("scans", "registration", "cluster_hull")]
    text = drawn_twice(
        lambda o: draw_scans(*inputs, o, n_scans=1, area_share=None), results / "scans.svg"
    )
    assert "position of a scan (2)" in text
    assert "numbered by rank (1)" in text


def test_draw_walls(results):
    inputs = [
        results / f"{name}.parquet" for name in ("scans", "faces", "registration", "cluster_hull")
    ]
    text = drawn_twice(
        lambda o: draw_walls(*inputs, o, n_scans=None, area_share=None), results / "walls.svg"
    )
    assert "wall face (2)" in text
    assert "position of a selected scan (2)" in text


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


def test_tables_of_different_runs_are_refused(results):
    registration = tables.read_table(results / "registration.parquet", schemas.REGISTRATION)
    registration["kept"] = np.array([False, False, True])
    tables.write_table(results / "registration.parquet", schemas.REGISTRATION, registration)
    inputs = [results / f"{name}.parquet" for name in ("scans", "registration", "cluster_hull")]
    with pytest.raises(StageError, match="scan 0 "):
        draw_scans(*inputs, results / "scans.svg", n_scans=None, area_share=None)
    assert not (results / "scans.svg").exists()
