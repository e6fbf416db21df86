"""Pose graphs that can be solved on paper, and against Open3D on the same input."""

import numpy as np
import pytest

from helpers.pose_chains import chain, pose
from scanplan.geometry import se3, twists
from scanplan.registration import pose_graph


def ring(n):
    """Poses on a circle, looking along it."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.array([pose(5 * np.cos(a), 5 * np.sin(a), np.degrees(a) + 90) for a in angle])


def weak(n, value=1.0):
    return np.repeat(value * np.eye(6)[None], n, axis=0)


@pytest.mark.parametrize("planar", [False, True])
def test_exact_measurements_give_the_true_poses(planar):
    true = ring(24)
    rng = np.random.default_rng(1)
    twist = rng.normal(0, 0.1, (24, 6)) * ([1, 1, 0, 0, 0, 1] if planar else [1] * 6)
    found = pose_graph.solve_pose_graph(
        true @ twists.twist_to_motion(twist),
        chain(true, extra=[(23, 0)]),
        pose_graph.KnownPoses(true, weak(24)),
        planar=planar,
    )
    np.testing.assert_allclose(found.world_from_scan, true, atol=1e-6)
    np.testing.assert_allclose(found.weight, 1, atol=1e-6)
    np.testing.assert_allclose(found.residual, 0, atol=1e-6)


def test_two_measurements_are_weighed_by_their_information():
    """A link of sigma 0.1 at 1.0 m and a prior of sigma 0.2 at 1.1 m.

    (100 * 1.0 + 25 * 1.1) / 125 = 1.02.
    """
    links = pose_graph.MotionConstraints(
        np.array([1]), np.array([0]), pose(1.0, 0, 0)[None], np.diag([100.0] * 6)[None]
    )
    priors = np.array([pose(0, 0, 0), pose(1.1, 0, 0)])
    information = np.array([1e9 * np.eye(6), 25 * np.eye(6)])
    found = pose_graph.solve_pose_graph(
        priors, links, pose_graph.KnownPoses(priors, information), planar=False, kernel=1e6
    )
    np.testing.assert_allclose(found.world_from_scan[1], pose(1.02, 0, 0), atol=1e-6)
    np.testing.assert_allclose(found.residual[0], [0.02, 0, 0, 0, 0, 0], atol=1e-6)


def test_a_direction_without_information_is_the_priors():
    information = np.diag([0, 1e6, 1e6, 1e6, 1e6, 1e6])
    links = pose_graph.MotionConstraints(
        np.array([1]), np.array([0]), pose(1.0, 0.5, 0)[None], information[None]
    )
    priors = np.array([pose(0, 0, 0), pose(1.3, 0.2, 0)])
    found = pose_graph.solve_pose_graph(
        priors,
        links,
        pose_graph.KnownPoses(priors, np.array([1e9 * np.eye(6), np.eye(6)])),
        planar=False,
    )
    np.testing.assert_allclose(found.world_from_scan[1, :2, 3], [1.3, 0.5], atol=1e-5)


def test_a_closed_loop_takes_the_drift_out():
    true = ring(60)
    links = chain(true, noise=0.01, seed=3)
    start = [true[0]]
    for motion in links.target_from_source:
        start.append(start[-1] @ motion)
    start = np.array(start)
    information = weak(60, 1e-6)
    information[0] = 1e8 * np.eye(6)
    known = pose_graph.KnownPoses(true, information)
    open_ended = pose_graph.solve_pose_graph(start, links, known, planar=False)
    looped = chain(true, noise=0.01, seed=3, extra=[(i + 30, i) for i in range(0, 30, 3)])
    looped.target_from_source[59:] = (
        se3.invert_pose(true[looped.target[59:]]) @ true[looped.source[59:]]
    )
    closed = pose_graph.solve_pose_graph(start, looped, known, planar=False)

    def error_m(found):
        return np.linalg.norm((found.world_from_scan - true)[:, :3, 3], axis=1).mean()

    assert error_m(open_ended) > 4 * error_m(closed)


def test_a_false_loop_and_a_jump_of_the_localiser_are_disbelieved():
    true = ring(40)
    links = chain(true, noise=0.005, extra=[(39, 0), (20, 3)])
    links.target_from_source[-1] = pose(0.5, 0.0, 40)
    priors = true.copy()
    priors[10:13] = pose(2.0, 0, 0) @ priors[10:13]
    found = pose_graph.solve_pose_graph(
        priors, links, pose_graph.KnownPoses(priors, weak(40, 100.0)), planar=False
    )
    assert found.weight[-1] < 0.01 and (found.weight[:-1] > 0.25).all()
    assert (found.prior_weight[10:13] < 0.1).all() and (found.prior_weight[13:] > 0.5).all()
    assert np.linalg.norm((found.world_from_scan - true)[:, :3, 3], axis=1).max() < 0.05


@pytest.mark.parametrize("planar", [False, True])
def test_one_false_constraint_does_not_turn_a_stretch_away_from_all_else(planar):
    """Of four scans at the start two surer constraints say 0.6 m and 8 degrees more than others.

    Beyond them are three constraints and four priors that say otherwise; elsewhere the localiser
    jumps by 2 m, where nothing but it is false.
    """
    true = np.array([pose(x, 0, 0) for x in range(40)])
    false = [(4, 3), (4, 2)]
    across = [(i, i - k) for k in (2, 3) for i in range(k, 40) if (i, i - k) not in false]
    links = chain(true, extra=[*across, false[1]])
    is_false = np.isin(links.source, 4) & np.isin(links.target, [2, 3])
    assert is_false.sum() == 2
    links.target_from_source[is_false] = pose(0, 0.6, 8) @ links.target_from_source[is_false]
    links.information[is_false] *= 1e3
    priors = true.copy()
    priors[20:23] = pose(0, 2.0, 0) @ priors[20:23]
    found = pose_graph.solve_pose_graph(
        true, links, pose_graph.KnownPoses(priors, weak(40, 100.0)), planar=planar
    )
    assert np.linalg.norm((found.world_from_scan - true)[:, :3, 3], axis=1).max() < 0.05
    assert (found.weight[is_false] < 0.05).all() and (found.weight[~is_false] > 0.5).all()
    assert (found.prior_weight[20:23] < 0.05).all() and (found.prior_weight[:20] > 0.5).all()


def test_the_same_answer_as_open3d():
    import open3d as o3d

    true = ring(16)
    links = chain(true, noise=0.02, seed=5, extra=[(15, 0), (8, 2)])
    start = np.array([true[0], *(true[1:] @ twists.twist_to_motion([0.05, 0, 0, 0, 0, 0.02]))])
    information = weak(16, 1e-9)
    information[0] = 1e12 * np.eye(6)
    ours = pose_graph.solve_pose_graph(
        start, links, pose_graph.KnownPoses(start, information), planar=False, kernel=1e6
    ).world_from_scan
    registration = o3d.pipelines.registration
    graph = registration.PoseGraph()
    graph.nodes.extend(registration.PoseGraphNode(p) for p in start)
    # its twists have the turn first
    order = [3, 4, 5, 0, 1, 2]
    graph.edges.extend(
        registration.PoseGraphEdge(int(s), int(t), m, i[np.ix_(order, order)], uncertain=False)
        for s, t, m, i in zip(
            links.source, links.target, links.target_from_source, links.information, strict=True
        )
    )
    options = registration.GlobalOptimizationOption(
        max_correspondence_distance=1.0, reference_node=0
    )
    registration.global_optimization(
        graph,
        registration.GlobalOptimizationLevenbergMarquardt(),
        registration.GlobalOptimizationConvergenceCriteria(),
        options,
    )
    theirs = np.array([node.pose for node in graph.nodes])
    theirs = start[0] @ se3.invert_pose(theirs[0]) @ theirs
    np.testing.assert_allclose(ours, theirs, atol=2e-3)
    assert np.abs(ours - start).max() > 0.02


def test_factors_serve_for_the_steps_after_them(monkeypatch):
    """Steps with old factors lead where steps with factors of their own do."""
    true = ring(60)
    rng = np.random.default_rng(2)
    pairs = [(row, other) for row in range(3, 60, 2) for other in rng.integers(0, row - 1, 3)]
    links = chain(true, noise=0.005, seed=3, extra=pairs)
    false = slice(60, None, 17)
    links.target_from_source[false] = links.target_from_source[false] @ pose(1.0, 0.5, 20)
    start = true @ twists.twist_to_motion(rng.normal(0, 0.1, (60, 6)))
    calls = []

    def count(function):
        return lambda *given, **more: calls.append(function) or function(*given, **more)

    def solve():
        calls.clear()
        found = pose_graph.solve_pose_graph(
            start, links, pose_graph.KnownPoses(true, weak(60)), planar=False
        )
        return found, calls.count(factor)

    factor = pose_graph.splu
    monkeypatch.setattr(pose_graph, "splu", count(factor))
    found, n_factors = solve()
    monkeypatch.setattr(pose_graph, "cg", lambda *_, **__: (None, 1))
    exact, n_exact = solve()
    assert n_factors <= n_exact / 2
    np.testing.assert_allclose(found.world_from_scan, exact.world_from_scan, atol=1e-5)
    np.testing.assert_allclose(found.weight[false], 0, atol=1e-2)
