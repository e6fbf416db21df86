"""Clouds in drivers' own messages, recorded, are those of the common ones."""

import numpy as np
import pytest

from helpers import bag_making
from scanplan.errors import StageError
from scanplan.project import dataset_files
from scanplan.recordings.survey import Reading, open_survey

LIMITS = {"min_range_m": 0.1, "max_range_m": 50.0}
T_NS = bag_making.START_NS
POINTS = bag_making.room_points(200).astype(np.float32)
SINCE_S = np.linspace(0, 0.099, len(POINTS))
RANGES = np.where(np.arange(360) % 7 == 0, np.nan, 2 + np.arange(360) / 360)


def read(folder, kind, make):
    """Return the first scan of a recording of clouds, and whether it is planar."""
    maker = bag_making.Maker(kind)
    entries = [("/clouds", T_NS + i * 10**8, make(maker, T_NS + i * 10**8)) for i in range(3)]
    entries += [("/amcl_pose", T_NS + i, maker.amcl(T_NS + i, (0, 0, 0))) for i in (0, 10**9)]
    maker.write(folder / "run", entries)
    with open_survey(dataset_files.find_files(folder), Reading(**LIMITS)) as survey:
        (scan,) = survey.scans([0])
        return scan, survey.planar


@pytest.mark.parametrize("kind", ["ros1", "mcap", "sqlite3_bare"])
@pytest.mark.parametrize("package", ["livox_ros_driver", "livox_ros_driver2"])
def test_livox_points_have_their_times(tmp_path, kind, package):
    shown = np.vstack([POINTS, np.zeros((1, 3))])
    offset_ns = np.append(SINCE_S * 1e9, 0)
    scan, planar = read(
        tmp_path, kind, lambda maker, t_ns: maker.livox(t_ns, shown, offset_ns, package)
    )
    np.testing.assert_array_equal(scan.xyz_m, POINTS)
    np.testing.assert_allclose(scan.time_s, SINCE_S, atol=1e-8)
    assert (scan.n_dropped, planar) == (1, False)


@pytest.mark.parametrize("kind", ["ros1", "mcap"])
def test_a_point_cloud_of_old_has_points_and_a_channel_of_times(tmp_path, kind):
    scan, planar = read(tmp_path, kind, lambda maker, t_ns: maker.old_cloud(t_ns, POINTS, SINCE_S))
    np.testing.assert_array_equal(scan.xyz_m, POINTS)
    np.testing.assert_allclose(scan.time_s, SINCE_S, atol=1e-7)
    assert not planar


@pytest.mark.parametrize("kind", ["ros1", "mcap"])
def test_first_echoes_are_the_ranges_of_a_laser_scan(tmp_path, kind):
    of_echoes, planar = read(
        tmp_path / "a", kind, lambda maker, t_ns: maker.multi_echo(t_ns, RANGES)
    )
    of_ranges, _ = read(tmp_path / "b", kind, lambda maker, t_ns: maker.laser(t_ns, RANGES))
    np.testing.assert_allclose(of_echoes.xyz_m, of_ranges.xyz_m, atol=1e-6)
    assert planar and len(of_echoes.xyz_m) == np.isfinite(RANGES).sum()


def test_a_common_cloud_goes_before_a_drivers_own(tmp_path):
    maker = bag_making.Maker("ros1")
    entries = [
        ("/livox/lidar", T_NS, maker.livox(T_NS, POINTS[:5], SINCE_S[:5])),
        ("/points", T_NS, maker.cloud(T_NS, POINTS)),
        ("/amcl_pose", T_NS, maker.amcl(T_NS, (0, 0, 0))),
    ]
    maker.write(tmp_path / "run", entries)
    files = dataset_files.find_files(tmp_path)
    with open_survey(files, Reading(**LIMITS)) as survey:
        assert len(next(iter(survey.scans([0]))).xyz_m) == len(POINTS)
    with open_survey(files, Reading(cloud_topic="/livox/lidar", **LIMITS)) as survey:
        assert len(next(iter(survey.scans([0]))).xyz_m) == 5


def test_of_packets_the_node_is_named_that_makes_clouds_of_them():
    from scanplan.recordings import topics

    found = [topics.Topic("/packets", "velodyne_msgs/msg/VelodyneScan", 5)]
    with pytest.raises(StageError, match="velodyne_pointcloud"):
        topics.choose_cloud_topic(found, None, "run.bag")


def no_return(ranges):
    """Return how many beams of a scan up to 10 m came back."""
    from scanplan.recordings.messages import read_laser_scan

    scan = bag_making.laser_scan(ranges, range_min=0.1, range_max=10.0)
    return int(np.isfinite(read_laser_scan(scan)[0][:, 0]).sum())


NEAR = np.linspace(2, 9.8, 100)


@pytest.mark.parametrize("code", [0.0, np.inf, np.nan, 10.0, 9.999, 11.0, -1.0])
def test_codes_for_no_return_are_none(code):
    assert no_return(np.concatenate([NEAR, np.full(50, code)])) == 100


def test_noise_about_the_longest_range_is_none():
    noise = np.random.default_rng(0).normal(10.0, 0.01, 60)
    assert no_return(np.concatenate([NEAR, noise])) == 100


def test_a_wall_near_the_longest_range_is_one_beside_beams_of_a_code():
    assert no_return(np.concatenate([NEAR, np.full(30, 9.97), np.full(30, 10.0)])) == 130
    assert no_return(np.concatenate([NEAR, np.full(30, 9.97), np.full(30, np.inf)])) == 130
    assert no_return(np.concatenate([NEAR, np.linspace(9.9, 9.9995, 100)])) == 200
