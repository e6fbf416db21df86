"""The thesis's two extractors, in a corner of two walls and in the toy room."""

from functools import partial

import numpy as np
import pytest

from helpers import extracting, toy_rooms
from reference import cluster_ransac as literal_clusters
from reference import ransac as literal
from scanplan.extraction import thesis_ransac
from scanplan.geometry import consensus

BOTH = ("thesis_cluster_ransac", "thesis_iterative_ransac")
iterate, cluster = (partial(extracting.extract, name) for name in reversed(BOTH))


def face(rng, n, *, x=None, y=None, z=None, pause=False):
    """Points of a plane of 4 m x 2 m; `pause` leaves its middle out."""
    along = rng.uniform(0, 4, n)
    if pause:
        along = np.where(np.abs(along - 2) < 1, 4 * (along > 2) + (2 - along) / 2, along)
    up = np.full(n, z) if z is not None else rng.uniform(0, 2, n)
    first = along if x is None else np.full(n, x)
    second = np.full(n, y) if y is not None else (along if x is not None else rng.uniform(0, 4, n))
    return np.column_stack([first, second, up]) + rng.normal(0, 0.01, (n, 3))


def test_every_upright_plane_is_one_wall_and_the_floor_none():
    rng = np.random.default_rng(1)
    points = np.concatenate([face(rng, 500, x=0.0), face(rng, 400, y=-1.0), face(rng, 600, z=-0.5)])
    found = iterate(points, (2, 2, 1), model="plane", max_trials=300)
    assert found.n_points.tolist() == pytest.approx([500, 400], abs=30)
    assert found.normal == pytest.approx(np.array([(1, 0), (0, 1)]), abs=0.03)


@pytest.mark.parametrize("extract", [iterate, cluster])
def test_a_wall_that_pauses_is_one(extract):
    points = face(np.random.default_rng(1), 3000, x=0.0, pause=True)
    found = extract(points, (2, 2, 1), model="plane")
    assert len(found) == 1
    assert np.sort([found.start_m[0, 1], found.end_m[0, 1]]) == pytest.approx([0, 4], abs=0.05)
    # without the sensor's noise, its points scatter by 1 cm
    assert found.rmse_m[0] == pytest.approx(0.01, abs=0.001)
    assert found.z_range_m[0] == pytest.approx([0.04, 1.96], abs=0.05)


def test_lines_in_space_give_a_wall_several_candidates():
    points = face(np.random.default_rng(1), 2000, x=0.0)
    found = iterate(points, (2, 2, 1), max_trials=100)
    assert len(found) > 5
    assert np.abs(found.start_m[:, 0]).max() < 0.06 and np.abs(found.end_m[:, 0]).max() < 0.06


def test_a_plumb_line_is_no_wall():
    pole = np.column_stack([np.full(300, 2.0), np.full(300, 1.0), np.linspace(0, 2, 300)])
    assert len(iterate(pole, (0, 0, 1))) == 0


@pytest.mark.parametrize("name", BOTH)
@pytest.mark.parametrize("planar", [False, True])
def test_too_few_points_are_no_wall(name, planar):
    points = face(np.random.default_rng(1), 29, x=0.0, z=0.0 if planar else None)
    few = points[:5] if planar else points
    for these in (few, few[:1], few[:0], np.ones((20, 3))):
        assert len(extracting.extract(name, these, (2, 2, 0), planar=planar)) == 0


@pytest.mark.parametrize("name", BOTH)
@pytest.mark.parametrize("planar", [False, True])
def test_every_wall_of_the_room_is_found(name, planar):
    points = toy_rooms.laser() if planar else toy_rooms.vlp16()
    found = extracting.extract(name, points, planar=planar, model="plane")
    for normal, offset_m in [((0, 1), 0), ((0, -1), -4), ((1, 0), 0), ((-1, 0), -6)]:
        ends_m = np.stack([found.start_m, found.end_m]) @ normal - offset_m
        assert (np.abs(ends_m).max(axis=0) < 0.05).any(), normal
    shuffled = np.random.default_rng(0).permutation(points)
    again = extracting.extract(name, shuffled, planar=planar, model="plane")
    assert (extracting.values(found) == extracting.values(again)).all()


@pytest.mark.parametrize(("model", "size"), [("line", 2), ("plane", 3)])
def test_repeated_as_the_literal_algorithm_by_the_same_samples(model, size):
    points = toy_rooms.vlp16(columns=90) - toy_rooms.SENSOR
    least = 15 if model == "line" else 60
    settings = thesis_ransac.ThesisIterativeSettings(
        inlier_m=0.05, min_points=least, min_points_planar=6, seed=1, max_tilt_deg=15.0,
        model=model, max_trials=40,
    )  # fmt: skip
    rng = np.random.default_rng([1, 3])
    models = literal.repeated(
        points,
        model=model,
        inlier_m=0.05,
        min_consensus=least,
        draw_samples=lambda n: consensus.draw_samples(n, size, 40, rng),
    )
    steepest = {"line": np.cos, "plane": np.sin}[model](np.deg2rad(15))
    expected = [len(points_of) for _, axis, points_of in models if abs(axis[2]) <= steepest]
    rows = thesis_ransac.extract_repeatedly(3, points, points, settings)
    assert [row.n_points for row in rows] == expected
    assert len(expected) >= 3


@pytest.mark.parametrize("projection", ["normal", "axis"])
def test_the_same_walls_as_the_literal_method(projection):
    xyz_m = toy_rooms.vlp16(segments=toy_rooms.ROOM[:3], columns=90)
    is_wall = (xyz_m[:, 2] > 0.05) & (xyz_m[:, 2] < toy_rooms.HEIGHT_M - 0.05)
    xyz_m = xyz_m[is_wall & (xyz_m[:, 0] < 6.1)]
    rng = np.random.default_rng(1)
    relative_m = xyz_m - toy_rooms.SENSOR
    expected = literal_clusters.walls(
        [(p, normal, p) for p, normal in literal_clusters.upright(relative_m, 5.0, 15.0)],
        projection=projection,
        model="plane",
        bandwidth_m=0.5,
        inlier_m=0.05,
        min_points=60,
        draw_samples=lambda n: literal.draw(n, 3, 50, rng),
    )
    given = {"reach_deg": 5.0, "bandwidth_m": 0.5, "min_points": 60}
    found = cluster(xyz_m, model="plane", projection=projection, **given)
    assert len(found) == len(expected) == 3
    for centre, axis, points_of in expected:
        offset_m = (found.start_m - toy_rooms.SENSOR[:2] - centre[:2]) @ axis[:2]
        parallel = np.abs(found.normal @ axis[:2]) > 0.999
        (same,) = np.nonzero(parallel & (np.abs(offset_m) < 0.02))
        assert len(same) == 1
        # neighbourhoods are cells here, balls there: other points have a normal
        assert 0.7 < found.n_points[same[0]] / len(points_of) < 1.5


def test_projections_on_paper():
    # a wall x + y = 2, seen at (2, 0) and (0, 2), and one that is along the y axis
    xy_m = np.array([(2.0, 0.0), (0.0, 2.0), (3.0, 5.0)])
    slanted = np.array([1, 1]) / np.sqrt(2)
    facing = np.array([slanted, slanted, (-1.0, 0.0)])
    along = thesis_ransac.project_on_normals(xy_m, facing, "normal")
    assert along == pytest.approx(np.array([(1, 1), (1, 1), (3, 0)]))
    # equal components: the first axis
    onto_axis = thesis_ransac.project_on_normals(xy_m, facing, "axis")
    assert onto_axis == pytest.approx(np.array([(2, 0), (0, 0), (3, 0)]))
    turned = thesis_ransac.project_on_normals(xy_m, facing[:, ::-1] * (0.6, 0.8), "axis")
    assert turned == pytest.approx(np.array([(0, 0), (0, 2), (0, 5)]))
