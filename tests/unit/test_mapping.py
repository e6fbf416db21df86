"""A drive round a block of rooms: candidates to one map, and what links them."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from helpers.default_settings import SETTINGS
from scanplan.geometry import se3
from scanplan.lab.evaluation import pose_errors
from scanplan.project.stage_settings import select_section
from scanplan.registration import batches, mapping, results, sequential
from scanplan.registration.icp import IcpResult
from scanplan.registration.registration_settings import registration_settings
from scanplan.stage import workers
from scanplan.store import scan_cache, schemas, tables

N = 60


def pose(x, y, yaw_deg):
    return se3.pose_matrix([x, y, 0.4], Rotation.from_euler("z", yaw_deg, degrees=True).as_quat())


def block(rng, n=9000):
    """Points on floor and walls of corridors around a block, with niches that differ by place."""
    walls = [((-6, -5), (6, -5)), ((6, -5), (6, 5)), ((6, 5), (-6, 5)), ((-6, 5), (-6, -5))]
    walls += [((-4, -3), (4, -3)), ((4, -3), (4, 3)), ((4, 3), (-4, 3)), ((-4, 3), (-4, -3))]
    for x, y in rng.permutation(
        [(-5.5, -2), (-2, -4.7), (3, -4.7), (5.5, 1), (1, 4.5), (-5.5, 3), (-1, 3.4)]
    ):
        walls += [
            ((x, y), (x + 0.4, y)),
            ((x + 0.4, y), (x + 0.4, y + 0.3)),
            ((x, y), (x, y + 0.3)),
        ]
    ends = np.array(walls, float)
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    which, share = rng.choice(len(ends), n, p=length / length.sum()), rng.uniform(size=(n, 1))
    wall = np.column_stack(
        [ends[which, 0] * (1 - share) + ends[which, 1] * share, rng.uniform(0, 2.4, n)]
    )
    floor = np.column_stack(
        [rng.uniform(-6, 6, n // 3), rng.uniform(-5, 5, n // 3), np.zeros(n // 3)]
    )
    return np.concatenate([wall, floor])


@pytest.fixture(scope="module")
def drive():
    """Scans of what is within 5 m, this side of the block; a localiser's poses; true poses."""
    rng = np.random.default_rng(2)
    along = np.linspace(0, 1.25, N) % 1 * 4
    corners = np.array([(-5, -4), (5, -4), (5, 4), (-5, 4), (-5, -4)])
    leg = along.astype(int)
    xy = corners[leg] + (along - leg)[:, None] * (corners[leg + 1] - corners[leg])
    true = np.array([pose(*p, 90 * side) for p, side in zip(xy, leg, strict=True)])
    scans = []
    for number, world_from_sensor in enumerate(true):
        points = block(np.random.default_rng(100 + number)) + rng.normal(0, 0.01, (12000, 3))
        seen = points[np.linalg.norm(points[:, :2] - world_from_sensor[:2, 3], axis=1) < 5]
        scans.append(se3.transform_points(se3.invert_pose(world_from_sensor), seen))
    drift = np.cumsum(rng.normal(0, 0.01, (N, 2)), axis=0)
    priors = true.copy()
    priors[:, :2, 3] += drift - drift.mean(axis=0) + rng.normal(0, 0.03, (N, 2))
    return scans, priors, true


def register(drive, folder, threads=1, **changes):
    scans, priors, _ = drive
    section = select_section(SETTINGS, "registration")
    graph = section["graph"] | changes.pop("graph", {})
    settings = registration_settings(section | {"batch_size": 20} | changes | {"graph": graph})
    found = (SimpleNamespace(xyz_m=xyz_m) for xyz_m in scans)
    survey = mapping.CandidateScans(np.arange(N) * 5, priors, planar=False)
    with (
        scan_cache.open_scan_cache(folder / "a") as raw,
        scan_cache.open_scan_cache(folder / "b") as thinned,
        workers.open_pool(threads) as run,
    ):
        cut = batches.cut_survey(N, settings)
        caches = mapping.CandidateCaches(raw, thinned)
        judged, edges = mapping.register_candidates(survey, cut, found, caches, run, settings)
        in_sequence = mapping.SequentialMap(survey, np.arange(N), judged, edges, thinned)
        return mapping.optimise_map(in_sequence, run, settings)


@pytest.fixture(scope="module")
def mapped(drive, tmp_path_factory):
    return register(drive, tmp_path_factory.mktemp("mapped"))


def errors_m(judged, true):
    pose_of = np.array([verdict.world_from_sensor for verdict in judged])
    motion = pose_errors.fit_alignment(pose_of[:, :3, 3], true[:, :3, 3])
    return pose_errors.pose_errors(motion @ pose_of, true)


def test_the_map_is_better_than_the_localiser_and_than_the_chain(drive, mapped, tmp_path):
    judged, result = mapped
    chain, _ = register(drive, tmp_path, graph={"optimise": False})
    true = drive[2]
    assert all(verdict.kept for verdict in judged)
    assert [v.reason for v in judged] == ["anchor"] + ["kept"] * (N - 1)
    prior_m = np.median(errors_m([SimpleNamespace(world_from_sensor=p) for p in drive[1]], true)[0])
    distance_m, angle_deg = errors_m(judged, true)
    assert prior_m > 0.03
    assert np.median(distance_m) < 0.01 and np.median(angle_deg) < 0.1
    assert np.median(errors_m(chain, true)[0]) > 1.5 * np.median(distance_m)
    kinds = {edge.kind for edge in result.edges}
    assert kinds == {"sequence", "loop"}
    assert max(e.source - e.target for e in result.edges) > 5 * 30


def test_cores_change_nothing(drive, mapped, tmp_path):
    (one, links), (two, same) = mapped, register(drive, tmp_path, threads=2)
    np.testing.assert_array_equal(
        [v.world_from_sensor for v in one], [v.world_from_sensor for v in two]
    )
    np.testing.assert_array_equal(links.residual, same.residual)


def test_links_make_a_table(drive, mapped, tmp_path):
    result = mapped[1]
    tables.write_table(
        tmp_path / "edges.parquet", schemas.EDGES, results.constraint_columns(result)
    )
    edges = tables.read_table(tmp_path / "edges.parquet", schemas.EDGES)
    assert set(edges["kind"]) == {"sequence", "loop"} and edges["inlier"].all()
    assert np.median(edges["residual_m"]) < 0.01 and np.median(edges["fitness"]) > 0.5
    true = drive[2]
    motion = se3.pose_matrix(
        *(np.column_stack([edges[c] for c in names]) for names in (schemas.XYZ, schemas.QUAT))
    )
    truth = se3.invert_pose(true[edges["target"] // 5]) @ true[edges["source"] // 5]
    assert np.median(np.linalg.norm((motion - truth)[:, :3, 3], axis=1)) < 0.01
    told = results.summarise_constraints(result)
    assert "sequence (0 outliers)" in told
    assert re.search(r" \d\.\d mm an axis", told)
    unknown = replace(result, covariance=np.full_like(result.covariance, np.nan))
    assert " mm an axis" not in results.summarise_constraints(unknown)


def test_a_link_of_no_pairs_has_no_residual(mapped):
    links = mapped[1]
    fit = IcpResult(np.eye(4), np.zeros((6, 6)), n_unobservable=6, sound=False)
    without = replace(links, edges=[replace(links.edges[0], fit=fit), *links.edges[1:]])
    residual_m = results.constraint_columns(without)["residual_m"]
    assert residual_m[0] == 0
    np.testing.assert_array_equal(
        residual_m[1:], results.constraint_columns(links)["residual_m"][1:]
    )


def test_no_links_make_an_empty_table(tmp_path):
    tables.write_table(
        tmp_path / "edges.parquet",
        schemas.EDGES,
        results.constraint_columns(None),
        allow_empty=True,
    )
    assert (
        len(
            tables.read_table(tmp_path / "edges.parquet", schemas.EDGES, allow_empty=True)["source"]
        )
        == 0
    )
    assert results.summarise_constraints(None).startswith("no constraints: ")


def test_a_jump_of_the_localiser_by_two_metres_loses_no_region(drive, mapped, tmp_path):
    """It stays away for a third of the drive: scans are rejected until an anchor, then again."""
    scans, priors, true = drive
    jumped = np.array(priors)
    jumped[25:45] = pose(1.6, 1.2, 0) @ jumped[25:45]
    jumped[25:45, 2, 3] -= 0.4
    judged, _ = register((scans, jumped, true), tmp_path)
    reasons = [verdict.reason for verdict in judged]
    assert reasons.count("anchor") == 3 and reasons.count("kept") > 45
    kept_there = [verdict.kept for verdict in judged[25:45]]
    assert sum(kept_there) > 10


@pytest.mark.parametrize("bad", [15, 17, 19])
def test_a_scan_out_of_place_before_a_border_costs_only_itself(drive, tmp_path, bad):
    scans, priors, true = drive
    disturbed = np.array(priors)
    disturbed[bad] = pose(1.2, 0.7, 0) @ disturbed[bad] @ se3.invert_pose(pose(0, 0, -35))
    judged, result = register((scans, disturbed, true), tmp_path)
    assert [i for i, verdict in enumerate(judged) if verdict.reason != "kept"] == [0, bad]
    over = [e for e in result.edges if e.kind == "sequence" and e.source >= 100 > e.target]
    assert len(over) >= 3


def test_a_lost_localisers_scans_are_dropped_where_nothing_confirms_them(drive, tmp_path):
    scans, priors, true = drive
    lost = np.array(priors)
    lost[21:29, :2, 3] = [(20 + 10 * (5 * i % 8), -30) for i in range(8)]
    for graph in ({}, {"optimise": False}):
        judged, result = register((scans, lost, true), tmp_path, graph=graph)
        assert {verdict.reason for verdict in judged[21:29]} == {"unconfirmed"}
        assert [i for i, verdict in enumerate(judged) if not verdict.kept] == list(range(21, 29))
        np.testing.assert_array_equal(judged[25].world_from_sensor, lost[25])
        ends = {end // 5 for edge in result.edges for end in (edge.source, edge.target)}
        assert ends == {*range(21), *range(29, N)}


def test_links_are_told_without_optimisation_too(drive, tmp_path):
    judged, result = register(drive, tmp_path, graph={"optimise": False})
    assert {edge.kind for edge in result.edges} == {"sequence"} and (result.weight == 1).all()
    assert {edge.source for edge in result.edges} == set(range(5, 5 * N, 5))
    edge, residual = result.edges[7], result.residual[7]
    place = [judged[end // 5].world_from_sensor for end in (edge.target, edge.source)]
    off = se3.invert_pose(edge.fit.target_from_source) @ se3.invert_pose(place[0]) @ place[1]
    np.testing.assert_allclose(np.linalg.norm(residual[:3]), np.linalg.norm(off[:3, 3]), rtol=0.05)


def test_a_new_start_is_linked_to_what_was_before(drive, tmp_path):
    """No scan can pass the gate, and every rejection is a new start."""
    judged, result = register(drive, tmp_path, n_previous=1, anchor_after=1, min_prior_fitness=1.01)
    assert {verdict.reason for verdict in judged} == {"anchor"}
    assert {e.source for e in result.edges if e.kind == "sequence"} >= set(range(5, 200, 5))


def test_no_candidate_that_is_kept_gives_no_links(drive, tmp_path):
    judged, result = register(drive, tmp_path, min_points=10**6)
    assert result is None and {verdict.reason for verdict in judged} == {"too_few_points"}


def test_poses_taken_as_given_are_not_moved(drive, tmp_path):
    judged, result = register(drive, tmp_path, icp_method="none")
    assert result is None
    np.testing.assert_array_equal([verdict.world_from_sensor for verdict in judged], drive[1])


def anchors(places):
    """Anchors along x, `None` where there is no pose."""
    results_of_places = []
    for x in places:
        pose = np.eye(4)
        pose[0, 3] = np.nan if x is None else x
        reason = "pose_gap" if x is None else "anchor"
        results_of_places.append(sequential.ScanResult(x is not None, reason, pose))
    return results_of_places


def unconfirmed(places, constrained_rows, apart_m=5.0):
    return np.flatnonzero(
        mapping.find_unconfirmed(
            anchors(places), np.isin(range(len(places)), constrained_rows), apart_m
        )
    )


def test_an_anchor_among_linked_scans_is_unconfirmed_wherever_it_is():
    assert unconfirmed([0, 1, 2, 50, 3, 4], [0, 1, 2, 4, 5]).tolist() == [3]


def test_a_stretch_of_its_own_is_kept_where_nothing_else_is_near():
    assert unconfirmed([0, 1, 2, None, 50, None, 3, 4], [0, 1, 2, 6, 7]).tolist() == []
    assert unconfirmed([0, 1, 2, None, 4, None, 3, 4], [0, 1, 2, 6, 7]).tolist() == [4]


def test_without_any_link_all_are_kept():
    assert unconfirmed([0, 1, None, 2], []).tolist() == []
    assert unconfirmed([0], []).tolist() == []
    assert unconfirmed([], []).tolist() == []


def test_scans_that_are_far_apart_need_not_confirm_each_other():
    assert unconfirmed([0, 8, 16, 24], [0, 1]).tolist() == []
    assert unconfirmed([0, 8, 16, 24], [0, 1], apart_m=10.0).tolist() == [2, 3]


def test_a_dropped_anchor_has_its_reason_and_the_localisers_pose():
    placed = replace(anchors([1.0])[0], covariance=np.eye(3))
    dropped = mapping.drop_anchor(placed, np.eye(4))
    assert np.isnan(dropped.covariance).all()
    assert not dropped.kept and dropped.reason == "unconfirmed"
    assert dropped.world_from_sensor[0, 3] == 0
