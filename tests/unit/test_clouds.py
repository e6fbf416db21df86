import numpy as np
import pytest

from scanplan import clouds

T_NS = 1_700_000_000_250_000_000


def test_range_and_finite_mask_goes_over_points_and_times():
    xyz_m = np.array([[1, 0, 0], [np.nan, 0, 0], [0, 0.05, 0], [0, 3, 0], [0, 0, np.inf], [0, 0, 2], [0, 0, 0]])
    scan = clouds.within_range(3, T_NS, xyz_m, np.arange(7) / 10, min_range_m=0.1, max_range_m=2.0)
    np.testing.assert_array_equal(scan.xyz_m, [[1, 0, 0], [0, 0, 2]])
    np.testing.assert_allclose(scan.time_s, [0, 0.5])
    assert (scan.scan_id, scan.t_ns, scan.n_dropped, scan.xyz_m.dtype) == (3, T_NS, 5, np.float32)


def test_all_points_dropped():
    scan = clouds.within_range(0, T_NS, np.full((4, 3), np.nan), None, min_range_m=0, max_range_m=9)
    assert (scan.xyz_m.shape, scan.time_s, scan.n_dropped) == ((0, 3), None, 4)


@pytest.mark.parametrize(
    ("raw", "seconds"),
    [
        (np.array([0, 50_000_000], np.uint32), [0, 0.05]),
        (np.array([-0.1, 0.0], np.float32), [-0.1, 0]),
        (np.array([T_NS, T_NS + 50_000_000], np.float64), [0, 0.05]),
        (np.array([T_NS / 1e9, T_NS / 1e9 + 0.05]), [0, 0.05]),
        (np.array([0.0, 0.0]), [0, 0]),
    ],
)
def test_time_conventions(raw, seconds):
    np.testing.assert_allclose(clouds.relative_time(raw, T_NS), seconds, atol=1e-6)


@pytest.mark.parametrize("raw", [[0, 1.5], [0, np.nan], [T_NS / 1e9 - 5, T_NS / 1e9]])
def test_implausible_times_are_none(raw):
    assert clouds.relative_time(np.array(raw), T_NS) is None


def test_no_times_of_no_points():
    assert clouds.relative_time(np.empty(0, np.float32), T_NS).shape == (0,)


def test_planes():
    rng = np.random.default_rng(0)
    flat = np.column_stack([rng.uniform(-30, 30, (200, 2)), np.full(200, 0.4)])
    assert clouds.lie_in_sweep_plane(flat)
    tilted = flat @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    assert clouds.lie_in_sweep_plane(tilted)
    tilted[7] += (0, 0.01, 0.02)
    assert not clouds.lie_in_sweep_plane(tilted)
    assert not clouds.lie_in_sweep_plane(flat[:2])


def test_a_wall_before_a_depth_camera_is_no_sweep_plane():
    rng = np.random.default_rng(0)
    assert not clouds.lie_in_sweep_plane(np.column_stack([rng.uniform(-2, 2, (200, 2)), np.full(200, 2.0)]))


def test_planar_only_if_the_first_scans_share_the_plane_and_no_more_is_read():
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], float)
    empty = np.empty((0, 3))
    assert clouds.are_planar([empty, flat, flat, empty])
    assert not clouds.are_planar([flat, np.add(flat, (0, 0, 1))])
    assert not clouds.are_planar([empty])
    source = iter([flat] * 7)
    assert clouds.are_planar(source)
    assert len(list(source)) == 2
