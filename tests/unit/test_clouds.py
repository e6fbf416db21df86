import numpy as np

from scanplan.recordings import clouds
from scanplan.recordings.motion.point_times import TimeConvention

T_NS = 1_700_000_000_250_000_000


def test_range_and_finite_mask_goes_over_points_and_times():
    xyz_m = np.array(
        [[1, 0, 0], [np.nan, 0, 0], [0, 0.05, 0], [0, 3, 0], [0, 0, np.inf], [0, 0, 2], [0, 0, 0]]
    )
    given = {"limits": clouds.RangeLimits(0.1, 2.0), "sweep_times": TimeConvention("s", "stamp")}
    scan = clouds.keep_in_range(3, T_NS, xyz_m, np.arange(7) / 20, **given)
    np.testing.assert_array_equal(scan.xyz_m, [[1, 0, 0], [0, 0, 2]])
    np.testing.assert_allclose(scan.time_s, [0, 0.25])
    assert (scan.scan_id, scan.t_ns, scan.n_dropped, scan.xyz_m.dtype) == (3, T_NS, 5, np.float32)


def test_scans_of_the_same_points_have_one_digest():
    rng = np.random.default_rng(3)
    one, other = rng.uniform(1, 5, (2, 100, 3))
    read = [
        clouds.keep_in_range(i, T_NS + i, xyz_m, None, clouds.RangeLimits(0.1, 20))
        for i, xyz_m in enumerate([one, other, one.astype(np.float32), one + 1e-6])
    ]
    digests = [scan.digest for scan in read]
    assert digests[0] == digests[2] and len(set(digests)) == 3


def test_all_points_dropped():
    nowhere_m = np.full((4, 3), np.nan)
    scan = clouds.keep_in_range(0, T_NS, nowhere_m, None, clouds.RangeLimits(0, 9))
    assert (scan.xyz_m.shape, scan.time_s, scan.n_dropped) == ((0, 3), None, 4)


def test_times_that_are_no_sweep_are_none():
    given = {"limits": clouds.RangeLimits(0.1, 2.0), "sweep_times": TimeConvention("s", "stamp")}
    xyz_m = np.ones((3, 3), np.float32)
    for raw in ([0, 0.4, 0.6], [0, np.nan, 0.1], [2.0, 2.1, 2.1]):
        assert clouds.keep_in_range(0, T_NS, xyz_m, np.array(raw), **given).time_s is None
    # a point that is dropped may carry any time
    xyz_m[1] = np.nan
    scan = clouds.keep_in_range(0, T_NS, xyz_m, np.array([0, np.nan, 0.1]), **given)
    np.testing.assert_allclose(scan.time_s, [0, 0.1])


def test_planes():
    rng = np.random.default_rng(0)
    flat = np.column_stack([rng.uniform(-30, 30, (200, 2)), np.full(200, 0.4)])
    assert clouds.is_sweep_plane(flat)
    tilted = flat @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    assert clouds.is_sweep_plane(tilted)
    tilted[7] += (0, 0.01, 0.02)
    assert not clouds.is_sweep_plane(tilted)
    assert not clouds.is_sweep_plane(flat[:2])


def test_a_wall_before_a_depth_camera_is_no_sweep_plane():
    rng = np.random.default_rng(0)
    assert not clouds.is_sweep_plane(
        np.column_stack([rng.uniform(-2, 2, (200, 2)), np.full(200, 2.0)])
    )


def test_planar_only_if_the_first_scans_share_the_plane_and_no_more_is_read():
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], float)
    empty = np.empty((0, 3))
    assert clouds.are_scans_planar([empty, flat, flat, empty])
    assert not clouds.are_scans_planar([flat, np.add(flat, (0, 0, 1))])
    assert not clouds.are_scans_planar([empty])
    source = iter([flat] * 7)
    assert clouds.are_scans_planar(source)
    assert len(list(source)) == 2


def test_points_in_range():
    xyz_m = np.array([(0, 0, 0), (1, 0, 0), (0, 3, 4), (9, 0, 0), (np.nan, 1, 0)])
    assert clouds.RangeLimits(1.0, 5.0).include(xyz_m).tolist() == [
        False,
        True,
        True,
        False,
        False,
    ]
