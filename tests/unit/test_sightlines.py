import numpy as np
import pytest

from scanplan.rays import scan_view, sightlines

AZIMUTH_DEG = np.arange(-180, 180, 0.5)


def scan(elevations_deg, range_m):
    """Return a view of rays of given elevations, each ending at `range_m(azimuth_rad, slope)`, horizontally."""
    azimuth, slope = np.meshgrid(np.deg2rad(AZIMUTH_DEG), np.tan(np.deg2rad(elevations_deg)))
    azimuth, slope = azimuth.ravel(), slope.ravel()
    reach = range_m(azimuth, slope)
    points = np.column_stack([np.cos(azimuth) * reach, np.sin(azimuth) * reach, slope * reach])
    return scan_view.sort_by_azimuth(points[np.isfinite(reach)])


def plane(distance_m, azimuth):
    """Return the horizontal range to the plane x = distance, far away behind."""
    with np.errstate(divide="ignore"):
        return np.where(np.cos(azimuth) > 1e-3, distance_m / np.cos(azimuth), 1e3)


START, END = np.array([2.0, -1.0]), np.array([2.0, 1.0])


def test_rays_that_all_end_on_a_face():
    seen = sightlines.observe_face(
        scan(range(-10, 11, 2), lambda a, s: np.minimum(plane(2, a), 5)), START, END, -0.35, 0.35
    )
    assert (seen.over, seen.through) == (0, 0)
    assert seen.missing == pytest.approx(0, abs=0.1)
    # 10 degrees over 2.2 m, above a floor at -0.35 - (5 - 2) tan(10): the lowest returns, at 5 m
    assert seen.top_m == pytest.approx(np.tan(np.deg2rad(10)) * (2.2 + 5), abs=0.05)


def test_rays_that_pass_over_an_edge():
    """A face 0.2 m above the sensor at 2 m: rays of 6 degrees and more pass over it to 5 m."""

    def reach(azimuth, slope):
        near = plane(2, azimuth)
        return np.where(slope * near <= 0.2, np.minimum(near, 5), 5.0)

    seen = sightlines.observe_face(scan(range(-10, 11, 2), reach), START, END, -0.35, 0.2)
    assert seen.over == pytest.approx(1)
    assert seen.through == 0


def test_rays_that_pass_through():
    """Every other column of rays goes through to 5 m."""

    def reach(azimuth, slope):
        gap = np.round(np.rad2deg(azimuth) * 2).astype(int) % 2 == 0
        return np.where(gap, 5.0, np.minimum(plane(2, azimuth), 5))

    seen = sightlines.observe_face(scan(range(-10, 11, 2), reach), START, END, -0.35, 0.35)
    assert seen.through == pytest.approx(1, abs=0.1)


def test_returns_that_are_missing():
    """Of a pane two of three rays do not come back; of all other directions all do."""

    def reach(azimuth, slope):
        lost = (np.abs(np.tan(azimuth)) < 0.5) & (np.cos(azimuth) > 0)
        lost &= np.round(np.rad2deg(azimuth) * 2).astype(int) % 3 > 0
        return np.where(lost, np.nan, np.minimum(plane(2, azimuth), 5))

    seen = sightlines.observe_face(scan(range(-10, 11, 2), reach), START, END, -0.35, 0.35)
    assert seen.missing == pytest.approx(2 / 3, abs=0.12)


def test_a_face_across_the_cut_of_the_azimuth():
    view = scan(range(-10, 11, 2), lambda a, s: np.minimum(plane(2, np.pi - a), 5))
    behind = sightlines.observe_face(view, -START, -END, -0.35, 0.35)
    ahead = scan(range(-10, 11, 2), lambda a, s: np.minimum(plane(2, a), 5))
    assert behind.top_m == pytest.approx(
        sightlines.observe_face(ahead, START, END, -0.35, 0.35).top_m, abs=0.02
    )
    assert (behind.over, behind.through) == (0, 0)


def test_nothing_on_the_face():
    view = scan(range(-10, 11, 2), lambda a, s: np.full(len(a), 5.0))
    assert sightlines.observe_face(view, START, END, -0.3, 0.3) == sightlines.FaceSight(0, 0, 0, 0)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_views_of_next_to_nothing(n):
    view = scan_view.sort_by_azimuth(np.array([(2.0, 0, 0.1 * i) for i in range(n)]))
    seen = sightlines.observe_face(view, START, END, 0, 0.2)
    assert np.isfinite([seen.top_m, seen.over, seen.through, seen.missing]).all()
