import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from helpers.default_settings import SETTINGS
from scanplan.lab.simulation.rover import planar_poses
from scanplan.project.stage_settings import select_section
from scanplan.registration import multiway
from scanplan.registration.graph_equations import MotionConstraints
from scanplan.registration.registration_settings import registration_settings
from scanplan.store import scan_cache


def test_a_floor_adds_to_the_covariance():
    rng = np.random.default_rng(0)
    roots = rng.normal(size=(5, 6, 6))
    covariance, floor = roots @ np.swapaxes(roots, 1, 2) + np.eye(6), np.diag([1, 2, 3, 4, 5, 6.0])
    found = multiway.add_covariance(np.linalg.inv(covariance), floor)
    np.testing.assert_allclose(found, np.linalg.inv(covariance + floor), rtol=1e-9, atol=1e-12)


def test_a_floor_gives_no_information_where_there_is_none():
    information = np.diag([0, 1e6, 1e6, 0, 1e6, 1e6])
    found = multiway.add_covariance(information[None], 1e-4 * np.eye(6))[0]
    np.testing.assert_allclose(
        np.diag(found), [0, *[1 / (1e-6 + 1e-4)] * 2, 0, *[1 / (1e-6 + 1e-4)] * 2], rtol=1e-9
    )


PLANAR_PAIRS = {
    **{"loop_radius_m": 0.5, "loop_apart": 2, "loop_step_planar_m": 0.5},
    **{"loops_per_scan_planar": 4, "loop_min_fitness": 0.25},
}


@pytest.fixture
def thinned(tmp_path):
    """Return a cache of as many equal clouds as are asked for."""
    with scan_cache.open_scan_cache(tmp_path / "thinned") as cache:

        def fill(n, points_m):
            for _ in range(n):
                cache.add(np.array(points_m, float))
            return cache

        yield fill


def kept(cache, *, planar):
    return multiway.KeptScans(np.arange(len(cache)), [], cache, planar)


def test_no_pair_is_linked_twice(thinned):
    """Across anchors a scan may have been registered against one far back: here the last one."""
    there_and_back = np.tile(np.eye(4), (20, 1, 1))
    there_and_back[:, 0, 3] = [*range(10), *range(9, -1, -1)]
    near = SimpleNamespace(**PLANAR_PAIRS)
    in_sequence = {(row, row - 1) for row in range(1, 20)}
    expected = [(row, 19 - row) for row in range(11, 20)]
    cache = thinned(20, [[0.2, 0.2, 0]])

    def choose(constrained):
        scans = kept(cache, planar=True)
        return multiway.choose_pairs(scans, there_and_back, constrained, near)

    assert choose(in_sequence) == expected
    assert choose(in_sequence | {(19, 0)}) == expected[:-1]


def test_half_circles_are_linked_by_what_they_show(thinned):
    """A corridor there and back, a scan a metre, each showing what is 2 and 4 m before it."""
    there_and_back = np.tile(np.eye(4), (40, 1, 1))
    there_and_back[:, 0, 3] = [*range(20), *range(19, -1, -1)]
    there_and_back[20:, :2, :2] = [[-1, 0], [0, -1]]
    near = SimpleNamespace(**PLANAR_PAIRS)
    cache = thinned(40, [[2, 1, 0], [4, -1, 0]])
    in_sequence = {(row, row - 1) for row in range(1, 40)}
    pairs = multiway.choose_pairs(kept(cache, planar=True), there_and_back, in_sequence, near)
    # seen from x on the way there, and from x + 6 on the way back
    assert pairs == [(39 - x, x - 6) for x in range(19, 5, -1)]


@pytest.mark.parametrize("share", [1.0, 0.01])
def test_odometry_ties_scans_that_a_localiser_places_otherwise(monkeypatch, share):
    """Two poses 1.3 m apart, off by 0.1 m, and a step of 1 m, off by 0.02: least squares."""
    monkeypatch.setattr(multiway, "align_visits", lambda *_, **__: [])
    monkeypatch.setattr(multiway.shared_errors, "measure_share", lambda *_: share)
    known = select_section(SETTINGS, "registration") | {"localiser_sigma_m": 0.1}
    settings = registration_settings(known)
    priors = planar_poses([[0, 0], [1.3, 0]], np.zeros(2))
    information = np.diag([0.02**-2] * 3 + [0.0] * 3)[None]
    step = planar_poses([[1, 0]], [0])
    steps = MotionConstraints(np.array([1]), np.array([0]), step, information)

    def place(odometry):
        graph = dataclasses.replace(settings.graph, kernel_sigmas=1e6)
        return multiway.optimise_poses(
            multiway.KeptScans(np.array([3, 8]), [], None, planar=True),
            priors,
            priors,
            None,
            dataclasses.replace(settings, graph=graph),
            odometry,
        )

    assert place(None).world_from_cloud[1, 0, 3] == pytest.approx(1.3)
    placed = place(steps)
    # each pose gives way by its part of 0.3 m
    x_m = 0.3 * 0.1**2 / share / (2 * 0.1**2 / share + 0.02**2)
    np.testing.assert_allclose(placed.world_from_cloud[:, 0, 3], [x_m, 1.3 - x_m], atol=1e-4)
    assert len(placed.edges) == len(placed.weight) == len(placed.residual) == 0


def test_pairs_of_a_place_are_aligned_in_one_job():
    """Ten visits to 30 places: each scan is in the job of its place, and each pair in one job."""
    poses = np.tile(np.eye(4), (300, 1, 1))
    poses[:, 0, 3] = np.tile(np.arange(30), 10) + 0.5
    pairs = [
        (later, earlier)
        for later in range(300)
        for earlier in range(later % 30, later, 30)
        if (later - earlier) // 30 <= 4
    ]
    cache = SimpleNamespace(part=lambda rows: rows)
    graph = SimpleNamespace(loop_min_fitness=0.5, loop_apart=6, loops_per_scan_planar=3)
    settings = SimpleNamespace(limits=None, graph=graph)
    scans = multiway.KeptScans(np.arange(300), [], cache, planar=True)
    jobs = list(multiway.alignment_jobs(pairs, scans, poses, settings))
    assert sorted(pair for job in jobs for pair in job[1]) == pairs
    assert sum(len(clouds.rows) for clouds, *_ in jobs) < 1.3 * 300
    for clouds, of_job, *_ in jobs:
        rows = sorted({row for pair in of_job for row in pair})
        assert clouds.part == clouds.rows == clouds.scan_ids.tolist() == rows
        np.testing.assert_array_equal(clouds.world_from_cloud, poses[rows])
    sources = [{source for source, _ in job[1]} for job in jobs]
    assert len(set.union(*sources)) == sum(map(len, sources))
    assert {job[-1].most for job in jobs} == {3}


@pytest.mark.parametrize(("planar", "n_pairs"), [(True, 5), (False, 4)])
def test_more_visits_are_tried_than_are_linked(thinned, planar, n_pairs):
    """Back and forth six times, a scan a metre: the last has five visits before it."""
    ways = np.tile(np.eye(4), (60, 1, 1))
    ways[:, 0, 3] = np.tile([*range(10), *range(9, -1, -1)], 3)
    limits = SimpleNamespace(
        **(PLANAR_PAIRS | {"loops_per_scan_planar": 2}), loops_per_scan=1, loop_step_m=0.5
    )
    in_sequence = {(row, row - 1) for row in range(1, 60)}
    cache = thinned(60, [[0.2, 0.2, 0]])
    pairs = multiway.choose_pairs(kept(cache, planar=planar), ways, in_sequence, limits)
    assert sum(source == 55 for source, _ in pairs) == n_pairs
