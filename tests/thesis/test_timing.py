import time

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import toy_rooms
from helpers.default_settings import SETTINGS
from helpers.wall_making import observed
from reference import hull_selection as reference
from scanplan.extraction.extractors import Extractor, WallFinder
from scanplan.extraction.segments import SegmentLimits
from scanplan.plan.faces.merging import MergeSettings
from scanplan.project import stage_settings
from scanplan.selection import hulls
from scanplan.store import tables
from thesis import timing


def test_rows_are_spread_evenly():
    assert timing.spread_rows(np.arange(9), 3).tolist() == [0, 4, 8]
    assert timing.spread_rows([5, 6], 4).tolist() == [5, 6]


def built(n):
    rng = np.random.default_rng(0)
    parts = [
        hulls.make_cluster_hulls(
            i, rng.normal((i, 0), 1, (50, 2)), n_clusters=2, sample_size=20, radius="none", seed=0
        )
        for i in range(n)
    ]
    return hulls.concatenate_hulls(parts)


def test_the_order_is_timed_for_every_number_of_scans():
    rows = list(timing.time_selection(built(6), [2, 6]))
    found = [(row["task"], row["size"], row["found"]) for row in rows]
    tasks = ("order_scans", "order_scans_literally")
    assert found == [(task, n, n) for n in (2, 6) for task in tasks]
    assert all(row["seconds"] > 0 for row in rows)


@given(st.lists(st.tuples(*[st.integers(0, 6)] * 2, st.integers(1, 3)), min_size=1, max_size=7))
def test_algorithm_1_as_written_gives_the_order_of_the_reference(corners):
    # sides of unequal fractions: no two gains are the same by chance
    polygons = np.array(
        [shapely.box(x, y, x + w + i / 97, y + w + i / 89) for i, (x, y, w) in enumerate(corners)]
    )
    order = timing.order_literally(polygons)
    literal, covered_m2 = reference.hull_selection(list(polygons))
    union_m2 = [shapely.union_all(polygons[order[: k + 1]]).area for k in range(len(order))]
    np.testing.assert_allclose(union_m2, covered_m2, rtol=1e-9)
    assert sorted(order) == sorted(literal)


def test_merging_is_timed_for_all_scans_and_parts_of_them():
    walls = observed([(0, 0, 6, 0), (6, 0, 6, 4)], np.random.default_rng(5), n_scans=8)
    settings = MergeSettings(**stage_settings.select_merging(SETTINGS))
    rows = list(timing.time_merging(walls, settings))
    n = len(walls["scan_id"])
    assert [row["size"] for row in rows] == [n, n // 2, n // 4, n // 8]
    assert all(row["seconds"] > 0 and row["found"] >= 0 for row in rows)


def test_choosing_the_subset_is_timed_where_there_is_a_choice():
    rows = list(timing.time_selection(built(17), [15, 17]))
    found = [(row["task"], row["size"], row["found"]) for row in rows]
    both = ("order_scans", "order_scans_literally")
    assert [row for row in found if row[0] in both] == [(t, n, n) for n in (15, 17) for t in both]
    assert [row for row in found if row[0] not in both] == [("choose_scans", 17, 15)]


def test_a_part_of_the_points_is_kept_in_their_order():
    points = np.arange(30.0).reshape(10, 3)
    half = timing.thin_points(points, 2, 4)
    assert len(half) == 5 and (np.diff(half[:, 0]) > 0).all() and np.isin(half, points).all()
    assert (timing.thin_points(points, 1, 4) == points).all() and len(
        timing.thin_points(points, 99, 4)
    ) == 1
    assert (timing.thin_points(points, 2, 4) == half).all()


class Busy:
    """Finds one wall; every other call is disturbed."""

    def __init__(self):
        self.calls = 0

    def extract(self, scan_id, points, scan, settings):
        self.calls += 1
        until = time.process_time() + (0.05 if self.calls % 2 else 0.001)
        while time.process_time() < until:
            pass
        return [(1, 0, 2, 0, 0, 1, len(points), 0, 0, 1)]


def test_a_disturbed_call_does_not_count(tmp_path, monkeypatch):
    with tables.open_scan_writer(tmp_path / "scans.parquet", planar=False) as write:
        for scan_id in (0, 3):
            write(scan_id, np.ones((5, 3)))
    at = {"sensor_xyz_m": np.zeros(3)}
    monkeypatch.setattr(timing.per_registered_scan, "sensor_keywords", lambda *_: {0: at, 3: at})
    store = tables.ScanStore(tmp_path / "scans.parquet")
    limits = SegmentLimits(**toy_rooms.LIMITS)
    busy = WallFinder(Extractor(SegmentLimits, Busy().extract), limits, planar=False)
    rows = list(timing.time_extractor("busy", busy, store, [0, 3], "registration.parquet"))
    assert [(row["item"], row["size"], row["found"]) for row in rows] == [(0, 5, 1), (3, 5, 1)]
    assert all(0.001 <= row["seconds"] < 0.04 for row in rows)


def test_hulls_are_timed_for_every_number_of_clusters(tmp_path):
    rng = np.random.default_rng(1)
    with tables.open_scan_writer(tmp_path / "scans.parquet", planar=False) as write:
        for scan_id in (0, 3, 9):
            write(scan_id, rng.normal(0, 1, (60, 3)))
    store = tables.ScanStore(tmp_path / "scans.parquet")
    rows = list(
        timing.time_clusters(
            "build_hulls", store, [0, 9], [1, 4], sample_size=30, radius="none", seed=0
        )
    )
    assert [(row["size"], row["found"]) for row in rows] == [(1, 2), (4, 2)]
