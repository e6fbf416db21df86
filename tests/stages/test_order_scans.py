import logging

import numpy as np
import pytest
import shapely

import order_scans
from scanplan.errors import StageError
from scanplan.selection import methods, orderings, stopping
from scanplan.store import schemas, tables


def write_hulls(path, shapes):
    columns = {
        "scan_id": np.arange(len(shapes)) * 5,
        "cluster": np.zeros(len(shapes), int),
        "n_points": np.full(len(shapes), 9),
        "area_m2": shapely.area(shapes),
        "geometry": shapely.to_wkb(np.array(shapes)),
    }
    tables.write_table(path, schemas.HULLS, columns)
    return path


@pytest.fixture
def hulls(tmp_path):
    return write_hulls(
        tmp_path / "hulls.parquet", [shapely.box(i, 0, i + 2 + i % 3, 1) for i in range(12)]
    )


def write_others(folder, method, n):
    """Write the tables that a method needs, of n scans."""
    ids, zeros = np.arange(n) * 5, np.zeros(n)
    columns = {
        "visibility": (
            schemas.VISIBILITY,
            {"area_m2": zeros + 2, "geometry": shapely.to_wkb(shapely.box(ids, 0, ids + 2, 1))},
        ),
        "observations": (
            schemas.OBSERVATIONS,
            {
                "facing": zeros.astype(int),
                "along": ids // 7,
                "across": zeros.astype(int),
                "length_m": zeros + 0.2,
                "axes_deg": zeros.astype(int),
            },
        ),
        "registration": (
            schemas.REGISTRATION,
            {"t_ns": ids, "kept": zeros == 0, "reason": ["kept"] * n}
            | dict.fromkeys(
                ("prior_fitness", "refined_fitness", "rmse_m", "qx", "qy", "qz", "y_m", "z_m"),
                zeros,
            )
            | dict.fromkeys(schemas.COVARIANCE, zeros)
            | {"qw": zeros + 1, "x_m": ids.astype(float)},
        ),
    }
    written = {table: folder / f"{table}.parquet" for table in methods.METHODS[method].tables}
    for table, path in written.items():
        schema, values = columns[table]
        tables.write_table(path, schema, {"scan_id": ids, **values})
    return written


def write_scans(path, *, planar=False):
    with tables.open_scan_writer(path, planar=planar) as write:
        for scan_id in range(0, 60, 5):
            write(scan_id, np.zeros((9, 3)))
    return path


@pytest.mark.parametrize("method", orderings.METHODS)
def test_an_order_of_all_scans(hulls, tmp_path, caplog, method):
    caplog.set_level(logging.INFO)
    scans = write_scans(tmp_path / "scans.parquet")
    output = tmp_path / "selection" / f"{method}.parquet"
    others = write_others(tmp_path, method, 12)
    options = {"method": method, "hulls": hulls, "seed": 1, "others": others}
    order_scans.order_scans(scans, output, **options)
    selection = tables.read_table(output, schemas.SELECTION)
    assert sorted(selection["scan_id"]) == list(range(0, 60, 5))
    assert selection["covered_m2"][-1] == pytest.approx(15)
    assert (selection["bound_m2"] >= selection["covered_m2"]).all()
    covered = {"visibility": "24.0 m2", "wall_length": "1.6 m"}.get(method, "15.0 m2")
    assert f"order_scans: {method}, 12 scans, {covered}; 99% at " in caplog.text
    again = tmp_path / "again.parquet"
    order_scans.order_scans(scans, again, **options)
    assert again.read_bytes() == output.read_bytes()


@pytest.mark.parametrize(("planar", "count"), [(False, 12), (True, 11)])
def test_fewer_scans_of_a_planar_survey_are_chosen_by_themselves(tmp_path, planar, count):
    """Eleven boxes show 0.92 of what twelve show, ten show 0.84."""
    boxes = [shapely.box(x, 0, x + 1, 1) for x in range(12)]
    hulls = write_hulls(tmp_path / "hulls.parquet", boxes)
    scans = write_scans(tmp_path / "scans.parquet", planar=planar)
    order_scans.order_scans(scans, tmp_path / "order", method="cluster_hull", hulls=hulls)
    assert stopping.read_choice(tmp_path / "order", area_share="auto")[1] == count


@pytest.mark.parametrize("method", ["wall_length", "visibility"])
def test_an_order_by_something_else_needs_no_hulls(hulls, tmp_path, method):
    scans = write_scans(tmp_path / "scans.parquet")
    paths = [tmp_path / "without.parquet", tmp_path / "with.parquet"]
    options = {"method": method, "others": write_others(tmp_path, method, 12)}
    for path, table in zip(paths, (None, hulls), strict=True):
        order_scans.order_scans(scans, path, hulls=table, **options)
    alone, measured = (tables.read_table(path, schemas.SELECTION) for path in paths)
    for name in ("scan_id", "n_points", "gain", "covered", "bound"):
        assert (alone[name] == measured[name]).all()
    for name in ("gain_m2", "covered_m2", "bound_m2"):
        assert np.isnan(alone[name]).all() and np.isfinite(measured[name]).all()


def test_scans_that_cover_nothing_are_refused(tmp_path):
    hulls = write_hulls(
        tmp_path / "hulls.parquet", [shapely.LineString([(0, 0), (1, i)]) for i in range(3)]
    )
    with pytest.raises(StageError, match="3 scans cover 0 m2"):
        order_scans.order_scans(
            write_scans(tmp_path / "scans.parquet"),
            tmp_path / "selection.parquet",
            method="cluster_hull",
            hulls=hulls,
        )
    assert not (tmp_path / "selection.parquet").exists()
