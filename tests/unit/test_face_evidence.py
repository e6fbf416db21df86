from types import SimpleNamespace

import numpy as np
import pytest

from helpers.observation_making import line_through
from helpers.ray_making import turned
from helpers.upright import returns
from scanplan.extraction import face_evidence, segments

AZIMUTH_DEG = np.arange(-180, 180, 0.5)


def scan(elevations_deg, range_m):
    """Return rays of elevations, each ending at `range_m(azimuth_rad, slope)`, level."""
    azimuth, slope = np.meshgrid(np.deg2rad(AZIMUTH_DEG), np.tan(np.deg2rad(elevations_deg)))
    azimuth, slope = azimuth.ravel(), slope.ravel()
    reach = range_m(azimuth, slope)
    points = np.column_stack([np.cos(azimuth) * reach, np.sin(azimuth) * reach, slope * reach])
    return segments.view_scan(points[np.isfinite(reach)], planar=False)


def plane(distance_m, azimuth):
    """Return the horizontal range to the plane x = distance, far away behind."""
    with np.errstate(divide="ignore"):
        return np.where(np.cos(azimuth) > 1e-3, distance_m / np.cos(azimuth), 1e3)


FACE = (2.0, -1.0, 2.0, 1.0)


def weigh(looked, low_m, high_m, ends=FACE):
    """Weigh a face between two heights relative to the sensor, which is to the left of its way."""
    heights_m = np.array([[low_m, high_m]]) - looked.floor_z_m
    return weigh_all(looked, [ends], heights_m)[0]


def weigh_all(looked, ends, heights_m):
    ends_m = np.array(ends, float).reshape(-1, 2, 2)
    normal = np.array([line_through(*face).normal for face in ends])
    found = face_evidence.weigh_faces(looked, ends_m, normal, heights_m)
    names = ("top_m", "over", "through", "missing")
    rows = zip(*(getattr(found, name).tolist() for name in names), strict=True)
    return [SimpleNamespace(**dict(zip(names, row, strict=True))) for row in rows]


def test_rays_that_all_end_on_a_face():
    seen = weigh(scan(range(-10, 11, 2), lambda a, s: np.minimum(plane(2, a), 5)), -0.35, 0.35)
    assert (seen.over, seen.through) == (0, 0)
    assert seen.missing == pytest.approx(0, abs=0.1)
    # 10 degrees over 2.2 m, above a floor at -0.35 - (5 - 2) tan(10): the lowest returns, at 5 m
    assert seen.top_m == pytest.approx(np.tan(np.deg2rad(10)) * (2.2 + 5), abs=0.05)


def test_rays_that_pass_over_an_edge():
    """A face 0.2 m above the sensor at 2 m: rays of 6 degrees and more pass over it to 5 m."""

    def reach(azimuth, slope):
        near = plane(2, azimuth)
        return np.where(slope * near <= 0.2, np.minimum(near, 5), 5.0)

    seen = weigh(scan(range(-10, 11, 2), reach), -0.35, 0.2)
    assert seen.over == pytest.approx(1)
    assert seen.through == 0


def test_rays_that_pass_through():
    """Every other column of rays goes through to 5 m."""

    def reach(azimuth, slope):
        gap = np.round(np.rad2deg(azimuth) * 2).astype(int) % 2 == 0
        return np.where(gap, 5.0, np.minimum(plane(2, azimuth), 5))

    seen = weigh(scan(range(-10, 11, 2), reach), -0.35, 0.35)
    assert seen.through == pytest.approx(1, abs=0.1)


def test_returns_that_are_missing():
    """Of a pane two of three rays do not come back; of all other directions all do."""

    def reach(azimuth, slope):
        lost = (np.abs(np.tan(azimuth)) < 0.5) & (np.cos(azimuth) > 0)
        lost &= np.round(np.rad2deg(azimuth) * 2).astype(int) % 3 > 0
        return np.where(lost, np.nan, np.minimum(plane(2, azimuth), 5))

    seen = weigh(scan(range(-10, 11, 2), reach), -0.35, 0.35)
    assert seen.missing == pytest.approx(2 / 3, abs=0.12)


def test_a_face_across_the_cut_of_the_azimuth():
    view = scan(range(-10, 11, 2), lambda a, s: np.minimum(plane(2, np.pi - a), 5))
    behind = weigh(view, -0.35, 0.35, (-2.0, 1.0, -2.0, -1.0))
    ahead = weigh(scan(range(-10, 11, 2), lambda a, s: np.minimum(plane(2, a), 5)), -0.35, 0.35)
    assert behind.top_m == pytest.approx(ahead.top_m, abs=0.02)
    assert (behind.over, behind.through) == (0, 0)


def test_at_grazing_incidence_what_is_behind_the_end_of_a_face_is_not_its_height():
    """A unit of 0.8 m height seen along from 0.4 m before it; beyond its end the side of a wall."""
    unit, side = (-3, 0.4, -1, 0.4, 0, 0.8), (-3, 0.4, -3, 1.4, 0, 2.6)
    looked = segments.view_scan(returns([unit, side]), planar=False)
    assert weigh(looked, -0.4, 0.4, (-1, 0.4, -3, 0.4)).top_m < 0.85


def test_nothing_on_the_face():
    view = scan(range(-10, 11, 2), lambda a, s: np.full(len(a), 5.0))
    seen = weigh(view, -0.3, 0.3)
    assert (seen.top_m, seen.over, seen.through) == (-np.inf, 0, 0)
    assert seen.missing == pytest.approx(0, abs=0.1)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_views_of_next_to_nothing(n):
    points = np.array([(2.0, 0, 0.1 * i) for i in range(n)])
    seen = weigh(segments.view_scan(points, planar=False), 0, 0.2)
    assert np.isfinite([seen.top_m, seen.over, seen.through, seen.missing]).all()


@pytest.mark.parametrize("seed", range(3))
def test_neither_order_nor_turn_of_the_points_matters(seed):
    points = returns([(4, -1, 4, 1, 0, 1.2), (6, -4, 6, 4, 0, 2.6)])
    rng = np.random.default_rng(seed)
    angle_rad = rng.uniform(-3, 3)
    (x0, y0), (x1, y1) = turned([(4.0, -1), (4, 1)], angle_rad)
    moved = turned(rng.permutation(points), angle_rad)
    here = weigh(segments.view_scan(points, planar=False), -0.4, 0.8, (4, -1, 4, 1))
    there = weigh(segments.view_scan(moved, planar=False), -0.4, 0.8, (x0, y0, x1, y1))
    assert (there.over, there.through) == (here.over, here.through) == (1, 0)
    assert there.top_m == pytest.approx(here.top_m)
    assert there.missing == pytest.approx(here.missing, abs=0.02)


@pytest.mark.parametrize(("deep_m", "leads_on"), [(3.0, True), (0.6, False)])
def test_a_door_leads_on_and_a_niche_does_not(deep_m, leads_on):
    """Between two pieces of a wall at 2 m rays end so far behind it."""

    def reach(azimuth, slope):
        gap = np.abs(2 * np.tan(azimuth)) < 0.5
        return np.where(gap, plane(2 + deep_m, azimuth), np.minimum(plane(2, azimuth), 5))

    looked, line = scan(range(-10, 11, 2), reach), line_through(2, -0.4, 2, 0.4)
    assert face_evidence.gap_leads_on(looked, line, (0.0, 0.8), 1.0) is leads_on
    # where no ray goes nothing is against a door
    assert face_evidence.gap_leads_on(looked, line_through(9, 9, 9, 9.8), (0.0, 0.8), 1.0)


def test_each_of_several_faces_is_weighed_by_itself():
    points = returns([(4, -1, 4, 1, 0, 1.2), (6, -4, 6, 4, 0, 2.6), (-3, 2, -5, 2, 0, 2.6)])
    looked = segments.view_scan(points, planar=False)
    faces = [(4, -1, 4, 1), (6, -4, 6, -2), (-3, 2, -5, 2), (0, 0, 1, 0)]
    heights_m = np.array([(0, 1.2), (0, 2.6), (0, 2.6), (0, 1)])
    together = weigh_all(looked, faces, heights_m)
    for number, face in enumerate(faces):
        (alone,) = weigh_all(looked, [face], heights_m[[number]])
        assert vars(together[number]) == pytest.approx(vars(alone))
    # the sensor is on the last one's line: nothing is seen of it
    assert together[3].top_m == -np.inf and together[3].missing == 0


def over(tops_m, free_tops_m):
    """Return how surely a face of columns of 10 cm ends."""
    rows = [np.array([tops], float) for tops in (tops_m, free_tops_m)]
    return face_evidence.over_shares(*rows, np.array([len(tops_m)])).tolist()[0]


NONE = -np.inf


def test_what_rays_pass_over_all_along_surely_ends():
    assert over([0.72] * 10, [1.2] * 10) == 1
    assert over([0.72] * 10, [NONE] * 10) == 0
    # where nothing ends at it there is no surface to pass over
    assert over([NONE] * 10, [1.2] * 10) == 0


def test_the_share_over_a_face_is_that_of_what_rays_cross_above_its_end():
    """Of ten columns three are 2 m high, six are passed over, and of one no more is known."""
    assert over([2.05] * 3 + [0.72] * 7, [NONE] * 3 + [1.2] * 6 + [NONE]) == pytest.approx(6 / 9)


def test_less_than_30_cm_passed_over_may_be_something_else():
    assert over([0.72] * 10, [1.2] * 2 + [NONE] * 8) == 0
    assert over([0.72] * 10, [1.2] * 3 + [NONE] * 7) == 1


def test_a_top_and_a_ray_closer_than_noise_do_not_part():
    assert over([0.79] * 10, [0.82] * 10) == 0
