import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from reference import hull_selection
from scanplan.selection import area_greedy, hulls
from scanplan.store import schemas

CORNERS = np.array([(0, 0), (2, 0), (2, 1), (0, 1)], float)
SETTINGS = {"n_clusters": 4, "sample_size": 100, "radius": "least_distance", "seed": 3}
ALL = {"radius": "none", "seed": 0}


def geometries(rows):
    return shapely.from_wkb(rows["geometry"])


def scan(xy_m):
    return np.column_stack([xy_m, np.full(len(xy_m), 1.5)])


def room(n=4000, seed=0):
    """Points on the walls of a 6 m x 4 m room, 1 cm noise."""
    rng = np.random.default_rng(seed)
    along, side = rng.random(n), rng.integers(4, size=n)
    start = np.array([(0, 0), (6, 0), (6, 4), (0, 4)])[side]
    end = np.array([(6, 0), (6, 4), (0, 4), (0, 0)])[side]
    return start + (end - start) * along[:, None] + rng.normal(0, 0.01, (n, 2))


def test_one_cluster_is_the_hull_of_all_points():
    rows = hulls.make_cluster_hulls(
        7, scan(np.vstack([CORNERS, [(1, 0.5)]])), n_clusters=1, sample_size=10, **ALL
    )
    assert {name: rows[name].tolist() for name in ("scan_id", "cluster", "n_points")} == {
        "scan_id": [7],
        "cluster": [0],
        "n_points": [5],
    }
    assert rows["area_m2"][0] == 2.0
    assert geometries(rows)[0].equals(shapely.box(0, 0, 2, 1))


def test_two_squares_apart_are_two_hulls():
    xy_m = np.vstack([CORNERS, CORNERS + np.array([50, 0])])
    rows = hulls.make_cluster_hulls(0, scan(xy_m), n_clusters=2, sample_size=8, **ALL)
    assert rows["area_m2"].tolist() == [2.0, 2.0]
    assert shapely.union_all(geometries(rows)).equals(
        shapely.box(0, 0, 2, 1) | shapely.box(50, 0, 52, 1)
    )


@pytest.mark.parametrize("radius", hulls.RADII)
def test_same_hulls_as_algorithm_2_where_clusters_are_clear(radius):
    rng = np.random.default_rng(5)
    xy_m = np.vstack([rng.normal((10 * i, 7 * (i % 2)), 0.5, (60, 2)) for i in range(5)])
    # 15 m from the nearest centre, where the nearest two centres are 12.2 m apart
    xy_m = np.vstack([xy_m, [(40, -15)]])
    expected = hull_selection.cluster_and_hull([xy_m], 5, radius)[0]
    rows = hulls.make_cluster_hulls(0, xy_m, n_clusters=5, sample_size=400, radius=radius, seed=0)
    shapes = geometries(rows)[rows["cluster"] != hulls.OUTLIERS]
    assert {g.normalize().wkb for g in shapes} == {g.normalize().wkb for g in expected}
    assert (len(shapes) < len(rows["cluster"])) == (radius != "none")


def test_covers_about_what_algorithm_2_does_on_a_room():
    expected = sum(g.area for g in hull_selection.cluster_and_hull([room()], 8, "none")[0])
    found = [
        hulls.make_cluster_hulls(i, room(), n_clusters=8, sample_size=300, **ALL)["area_m2"].sum()
        for i in range(10)
    ]
    assert np.mean(found) == pytest.approx(expected, rel=0.25)
    assert np.mean(found) < 0.6 * 24


def test_depends_on_seed_and_scan_alone():
    rows = hulls.make_cluster_hulls(4, room(), **SETTINGS)
    again = hulls.make_cluster_hulls(4, room(), **SETTINGS)
    assert all((rows[name] == again[name]).all() for name in rows)
    others = [
        hulls.make_cluster_hulls(5, room(), **SETTINGS),
        hulls.make_cluster_hulls(4, room(), **{**SETTINGS, "seed": 4}),
    ]
    assert all(
        (len(o["area_m2"]) != len(rows["area_m2"])) or (o["area_m2"] != rows["area_m2"]).any()
        for o in others
    )


@pytest.mark.parametrize(
    ("xy_m", "kinds"),
    [
        ([(1, 2)], ["Point"]),
        ([(1, 2)] * 5, ["Point"]),
        ([(0, 0), (3, 0)], ["Point", "Point"]),
        ([(0, 0), (0.1, 0), (9, 0), (9.1, 0)], ["LineString", "LineString"]),
        ([(0, 0), (1, 1), (2, 2)], ["LineString", "Point"]),
    ],
)
def test_degenerate_clusters_stay_without_area(xy_m, kinds):
    rows = hulls.make_cluster_hulls(0, np.array(xy_m, float), n_clusters=2, sample_size=10, **ALL)
    assert sorted(g.geom_type for g in geometries(rows)) == kinds
    assert rows["area_m2"].tolist() == [0.0] * len(kinds)
    assert rows["n_points"].sum() == len(xy_m)
    _, polygons = hulls.scan_polygons(rows)
    assert polygons[0].is_empty


def test_more_clusters_than_points_gives_one_each():
    rows = hulls.make_cluster_hulls(0, scan(CORNERS), n_clusters=10, sample_size=100, **ALL)
    assert rows["n_points"].tolist() == [1, 1, 1, 1]
    assert shapely.union_all(geometries(rows)).convex_hull.equals(shapely.box(0, 0, 2, 1))


scans_of_points = hnp.arrays(
    float, st.tuples(st.integers(1, 60), st.just(2)), elements=st.floats(-50, 50, width=32)
)


@settings(max_examples=150, deadline=None)
@given(scans_of_points, st.integers(1, 12), st.integers(1, 40), st.sampled_from(hulls.RADII))
def test_every_point_is_in_its_hull_and_the_whole_is_the_hull_of_all(
    xy_m, n_clusters, sample_size, radius
):
    rows = hulls.make_cluster_hulls(
        0, xy_m, n_clusters=n_clusters, sample_size=sample_size, radius=radius, seed=1
    )
    shapes, is_cluster = geometries(rows), rows["cluster"] != hulls.OUTLIERS
    assert rows["n_points"].sum() == len(xy_m)
    assert is_cluster.sum() <= n_clusters and (~is_cluster).sum() <= (radius != "none")
    assert rows["cluster"][is_cluster].tolist() == list(range(is_cluster.sum()))
    assert (rows["n_points"] > 0).all()
    points = shapely.points(xy_m)
    assert np.all([shapely.dwithin(shapes, p, 1e-12).any() for p in points])
    whole = shapely.multipoints(xy_m).convex_hull
    assert (
        shapely.geometrycollections(shapes)
        .convex_hull.normalize()
        .equals_exact(whole.normalize(), 0)
    )
    area_m2 = hulls.scan_polygons(rows)[1][0].area
    assert area_m2 <= whole.area * (1 + 1e-9) + 1e-12
    assert area_m2 <= rows["area_m2"][is_cluster].sum() + 1e-9
    assert hulls.scan_full_hulls(rows)[1][0].area == pytest.approx(whole.area)


@settings(max_examples=60, deadline=None)
@given(st.lists(scans_of_points, min_size=1, max_size=6), st.integers(1, 5))
def test_the_order_without_outliers_is_that_of_algorithm_1(scans, n_clusters):
    columns = hulls.concatenate_hulls(
        [
            hulls.make_cluster_hulls(i, xy_m, **{**SETTINGS, "n_clusters": n_clusters})
            for i, xy_m in enumerate(scans)
        ]
    )
    _, polygons = hulls.scan_polygons(columns)
    order, covered_m2 = hull_selection.hull_selection(list(polygons))
    found = area_greedy.order_by_area(polygons)
    assert found.order.tolist() == order
    assert found.covered == pytest.approx(covered_m2, abs=1e-6)


@pytest.mark.parametrize(
    ("radius", "n_points"),
    [("none", [2, 2, 3]), ("nearest_centre", [1, 2, 2, 2]), ("least_distance", [3, 2, 2])],
)
def test_how_far_a_cluster_reaches(radius, n_points, monkeypatch):
    # centres at 0, 4 and 20: the nearest others are 4, 4 and 16 m away; of the third cluster's
    # points, two are 2 m and one 17 m from it
    centres = np.array([(0, 0), (4, 0), (20, 0)], float)
    xy_m = np.array([(0, 0), (1, 0), (4, 0), (5, 0), (20, 2), (20, -2), (37, 0)], float)
    if radius == "least_distance":
        xy_m[4:6, 1] *= 2.5
    monkeypatch.setattr(hulls, "_find_centres", lambda *_: centres - xy_m.mean(axis=0))
    rows = hulls.make_cluster_hulls(0, xy_m, n_clusters=3, sample_size=9, radius=radius, seed=0)
    assert rows["n_points"].tolist() == n_points


def test_far_from_the_origin_the_clusters_are_the_same():
    # a power of two and a grid that float64 holds at both places, so that only the method could
    # differ
    snapped = np.round(room() * 1024) / 1024
    near = hulls.make_cluster_hulls(0, snapped, **SETTINGS)
    far = hulls.make_cluster_hulls(0, snapped + 2.0**20, **SETTINGS)
    assert far["n_points"].tolist() == near["n_points"].tolist()
    assert far["area_m2"] == pytest.approx(near["area_m2"], abs=1e-6)


def test_rows_do_not_depend_on_the_scans_done_before():
    scans = {i: room(500, seed=i) for i in (3, 8, 9, 40)}
    alone = [hulls.make_cluster_hulls(i, scans[i], **SETTINGS) for i in scans]
    backwards = [hulls.make_cluster_hulls(i, scans[i], **SETTINGS) for i in reversed(scans)][::-1]
    whole, again = hulls.concatenate_hulls(alone), hulls.concatenate_hulls(backwards)
    assert all((whole[name] == again[name]).all() for name in whole)


@pytest.mark.parametrize(
    "xy_m", [[(1, 2)], [(1, 2)] * 5, [(0, 0), (3, 3)], [(i, 2 * i) for i in range(9)]]
)
def test_too_few_points_or_a_line_cover_nothing(xy_m):
    rows = hulls.make_cluster_hulls(0, np.array(xy_m, float), **SETTINGS)
    assert rows["n_points"].sum() == len(xy_m)
    assert (rows["area_m2"] == 0).all() and not shapely.is_empty(geometries(rows)).any()
    assert hulls.scan_polygons(rows)[1][0].is_empty


@pytest.mark.parametrize(
    "xyz_m",
    [
        np.zeros((0, 3)),
        np.zeros(3),
        np.zeros((4, 4)),
        [(0, np.nan, 0)],
        [(np.inf, 0, 0), (0, 0, 0)],
    ],
)
def test_refuses_what_is_no_scan(xyz_m):
    with pytest.raises(ValueError, match=r"scan"):
        hulls.make_cluster_hulls(0, xyz_m, **SETTINGS)


@pytest.mark.parametrize(
    "wrong",
    [
        {"n_clusters": 0},
        {"n_clusters": 40_000},
        {"sample_size": 0},
        {"seed": -1},
        {"radius": "far"},
    ],
)
def test_refuses_settings_out_of_range(wrong):
    with pytest.raises(ValueError):
        hulls.make_cluster_hulls(0, CORNERS, **{**SETTINGS, **wrong})


def table_of(*scans):
    """Columns of a table of hulls, from (scan_id, [geometry, ...])."""
    rows = [(i, c, 3, g.area, g.wkb) for i, shapes in scans for c, g in enumerate(shapes)]
    names = list(schemas.HULLS.columns)
    return {
        n: np.array([r[j] for r in rows], object if n == "geometry" else None)
        for j, n in enumerate(names)
    }


def test_polygons_and_full_hulls_of_scans():
    left, right = shapely.box(0, 0, 1, 1), shapely.box(3, 0, 4, 1)
    overlap, line = shapely.box(0.5, 0, 1.5, 1), shapely.LineString([(0, 0), (0, 9)])
    columns = table_of((2, [left, right]), (5, [left, overlap]), (9, [line]), (11, [line, left]))
    scan_ids, polygons = hulls.scan_polygons(columns)
    assert scan_ids.tolist() == [2, 5, 9, 11]
    assert [p.area for p in polygons] == [2.0, 1.5, 0.0, 1.0]
    scan_ids, full = hulls.scan_full_hulls(columns)
    assert scan_ids.tolist() == [2, 5, 9, 11]
    assert [p.area for p in full] == [4.0, 1.5, 0.0, 5.0]
    assert full[2].is_empty


@pytest.mark.parametrize("shift_m", [0.0, 1e6])
@pytest.mark.parametrize("shape", ["disc", "triangle", "one place", "line", "grid"])
def test_leaving_out_inner_points_leaves_the_hull(shape, shift_m):
    rng = np.random.default_rng(4)
    xy_m = {
        "disc": rng.normal(size=(3000, 2)),
        "triangle": np.array([(0, 0), (8, 0), (0, 8)]).T @ rng.dirichlet((1, 1, 1), 900).T,
        "one place": np.ones((2, 60)),
        "line": np.outer((1, 2), np.arange(70.0)),
        "grid": np.indices((12, 12)).reshape(2, -1).astype(float),
    }[shape]
    xy_m = np.asarray(xy_m if xy_m.shape[1] == 2 else xy_m.T) + shift_m
    outer = hulls._outer(xy_m)
    assert shapely.convex_hull(shapely.linestrings(outer)).equals(
        shapely.convex_hull(shapely.multipoints(xy_m))
    )
    assert shape not in ("disc", "triangle") or len(outer) < 0.6 * len(xy_m)
