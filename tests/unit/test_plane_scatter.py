import numpy as np
import pytest

from scanplan.geometry import plane_scatter

OF_MAP = {"radius_m": 0.2, "most_places": 200, "seed": 1}


def walls(shift_m, noise_m=0.005, n=3000, planar=False, seed=0):
    """Two walls at right angles as 4 scans see them, each moved by a multiple of `shift_m`."""
    points, owners = [], []
    for scan_id in range(4):
        rng = np.random.default_rng([seed, scan_id])
        along, up = rng.uniform(0, 8, n), rng.uniform(0, 2, n)
        across = rng.normal(0, noise_m, n) + shift_m * (scan_id - 1.5)
        second = rng.random(n) < 0.5
        xyz_m = np.column_stack(
            [
                np.where(second, across, along),
                np.where(second, along, across),
                0 * up if planar else up,
            ]
        )
        points.append(xyz_m), owners.append(np.full(n, scan_id))
    return np.concatenate(points), np.concatenate(owners)


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("noise_m", [0.002, 0.01])
def test_of_scans_that_lie_on_each_other_the_noise_is_left(planar, noise_m):
    places = plane_scatter.measure_map_scatter(
        *walls(0.0, noise_m, planar=planar), planar=planar, **OF_MAP
    )
    assert np.isfinite(places.sigma_m).sum() > 60
    assert places.median_m == pytest.approx(noise_m, rel=0.1)


@pytest.mark.parametrize("planar", [False, True])
def test_scans_beside_each_other_make_walls_thick_by_their_spread(planar):
    places = plane_scatter.measure_map_scatter(*walls(0.02, planar=planar), planar=planar, **OF_MAP)
    # shifts of -3, -1, 1 and 3 cm
    assert places.median_m == pytest.approx(np.hypot(0.005, 0.01 * np.sqrt(5)), rel=0.1)


def test_a_place_by_hand():
    """Four scans, three points each, at z of 0, 1, 2, 3 cm.

    The sample deviation of three of each.
    """
    grid = np.array([[0, 0], [0.1, 0], [0, 0.1]])
    xyz_m = np.concatenate([np.column_stack([grid, np.full(3, 0.01 * i)]) for i in range(4)])
    places = plane_scatter.measure_scatter(
        xyz_m, np.repeat(range(4), 3), xyz_m[:1], planar=False, radius_m=0.12
    )
    assert places.sigma_m[0] == pytest.approx(0.01 * np.sqrt(3 * (2.25 + 0.25) * 2 / 11))


def test_places_with_few_points_or_few_scans_tell_nothing():
    square = np.array([[x, y, 0] for x in (-0.05, 0.05) for y in (-0.05, 0.05)])
    xyz_m = np.tile(square, (5, 1))
    for n_points, scan_ids in ((9, np.arange(9)), (20, np.arange(20) % 2)):
        places = plane_scatter.measure_scatter(
            xyz_m[:n_points], scan_ids[:n_points], xyz_m[:1], planar=False, radius_m=0.1
        )
        assert np.isnan(places.sigma_m).all() and np.isnan(places.median_m)
    places = plane_scatter.measure_scatter(
        xyz_m[:12], np.arange(12) % 3, np.zeros((1, 3)), planar=False, radius_m=0.1
    )
    assert places.sigma_m == pytest.approx([0.0], abs=1e-9)


@pytest.mark.parametrize("planar", [False, True])
def test_points_on_a_line_show_no_surface_in_space_but_one_in_the_plane(planar):
    along = np.linspace(-0.09, 0.09, 12)
    ring_m = np.column_stack([along, np.tile([-0.01, 0.01], 6), 0 * along])
    places = plane_scatter.measure_scatter(
        ring_m, np.arange(12) % 3, np.zeros((1, 3)), planar=planar, radius_m=0.1
    )
    assert np.isfinite(places.sigma_m[0]) == planar


def test_places_are_spread_evenly_however_dense_the_points():
    rng = np.random.default_rng(2)
    dense, sparse = rng.uniform(0, 1, (5000, 3)), rng.uniform(10, 11, (500, 3))
    xyz_m = np.concatenate([dense, sparse]) * (1, 1, 0)
    rows = plane_scatter.choose_places(xyz_m, planar=False, radius_m=0.2, most_places=1000, seed=1)
    centres = xyz_m[rows]
    assert len(centres) == 50 and (centres[:, 0] < 5).sum() == 25
    assert (
        len(plane_scatter.choose_places(xyz_m, planar=False, radius_m=0.2, most_places=20, seed=1))
        == 20
    )


def test_thinning_takes_as_much_of_each_and_the_same_every_time():
    scans = [(3, np.random.default_rng(0).normal(size=(100, 3))), (8, np.ones((5, 3)))]
    (xyz_m, owners), again = (
        plane_scatter.thin_randomly(scans, most_points=60, n_scans=2, seed=1) for _ in range(2)
    )
    assert np.bincount(owners).tolist() == [0, 0, 0, 30, 0, 0, 0, 0, 5]
    np.testing.assert_array_equal(xyz_m, again[0])
    # what is taken of a scan does not hang on the others
    np.testing.assert_array_equal(
        plane_scatter.thin_randomly(scans[:1], most_points=30, n_scans=1, seed=1)[0], xyz_m[:30]
    )


def test_columns():
    measured = {
        "b": plane_scatter.SurfaceScatter(np.zeros((4, 3)), np.array([1.0, 3, np.nan, 2])),
        "a": plane_scatter.SurfaceScatter(np.zeros((0, 3)), np.zeros(0)),
    }
    columns = plane_scatter.scatter_columns(measured)
    assert columns["poses"] == ["a", "b"] and columns["n_places"] == [0, 3]
    np.testing.assert_array_equal(columns["sigma_m"], [np.nan, 2])
    np.testing.assert_array_equal(columns["quarter_above_m"], [np.nan, 2.5])


def literal_sigma_m(xyz_m, scan_ids, centre_m, radius_m, axes):
    """One neighbourhood after the other, as the module's text has it."""
    is_near = np.linalg.norm(xyz_m[:, axes] - centre_m[axes], axis=1) <= radius_m
    points_m = xyz_m[is_near][:, axes]
    if len(points_m) < 10 or len(set(scan_ids[is_near].tolist())) < 3:
        return np.nan
    across_m2, *along_m2 = np.linalg.eigvalsh(np.cov(points_m.T))
    return np.nan if along_m2[0] < (radius_m / 4) ** 2 else np.sqrt(max(across_m2, 0.0))


@pytest.mark.parametrize("planar", [False, True])
def test_neighbourhoods_at_once_are_as_one_by_one(planar):
    xyz_m, scan_ids = walls(0.01, n=100 if planar else 400, planar=planar)
    centres_m = xyz_m[::7]
    found = plane_scatter.measure_scatter(xyz_m, scan_ids, centres_m, planar=planar, radius_m=0.2)
    axes = [0, 1] if planar else [0, 1, 2]
    literal = [literal_sigma_m(xyz_m, scan_ids, place, 0.2, axes) for place in centres_m]
    assert 0 < np.isnan(literal).sum() < len(literal)
    np.testing.assert_allclose(found.sigma_m, literal, rtol=1e-9)
