from functools import partial

import numpy as np
import pytest

from helpers import refusals
from helpers.las_making import write_las, write_trajectory
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges, las_drive, trajectory_file
from scanplan.recordings.survey import Reading, open_survey

LIMITS = {"min_range_m": 0.1, "max_range_m": 50.0}
RNG = np.random.default_rng(3)
TIME_S = 1000.0025 + np.arange(400) * 0.005
"""Of 400 points; the sensor goes along x at a metre a second."""
POINTS = RNG.uniform(-5, 5, (400, 3)).round(3)
AT_S = 1000.0 + np.arange(-1, 4.0)
PLACES = np.column_stack([AT_S - 1000, 0 * AT_S, 0 * AT_S + 1.5])


def drive(folder, *, suffix=".laz", time_s=TIME_S, at_s=AT_S, rows=slice(None), name="txt"):
    write_las(folder / f"a{suffix}", POINTS[rows], time_s[rows])
    write_trajectory(folder / f"trajectory.{name}", at_s, PLACES)
    return folder


def read(folder):
    """Return the stamps of a drive, its poses, and the points of all its scans in the map."""
    with open_survey(dataset_files.find_files(folder), Reading(**LIMITS)) as survey:
        t_ns = survey.stamps()
        pose, _, covered = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=2)
        scans = list(survey.scans(range(len(t_ns))))
        assert covered.all() and not survey.planar
    return t_ns, pose, [s.xyz_m + p[:3, 3] for s, p in zip(scans, pose, strict=True)]


@pytest.mark.parametrize("suffix", [".las", ".laz", ".LAZ"])
def test_points_of_a_tenth_of_a_second_are_a_scan_from_where_the_sensor_was(tmp_path, suffix):
    t_ns, pose, seen = read(drive(tmp_path, suffix=suffix))
    np.testing.assert_array_equal(t_ns, (100_005 + 10 * np.arange(20)) * 10**7)
    np.testing.assert_allclose(pose[:, :3, 3], [(0.05 + i / 10, 0, 1.5) for i in range(20)])
    np.testing.assert_allclose(np.concatenate(seen), POINTS, atol=1e-5)
    assert [len(xyz) for xyz in seen] == [20] * 20


def test_the_order_of_points_and_files_does_not_matter(tmp_path):
    order = RNG.permutation(400)
    drive(tmp_path, rows=order[:150])
    write_las(tmp_path / "b.las", POINTS[order[150:]], TIME_S[order[150:]])
    _, _, seen = read(tmp_path)
    _, _, sorted_seen = read(drive(tmp_path / "sorted"))
    for found, expected in zip(seen, sorted_seen, strict=True):
        same = (np.lexsort(xyz.round(3).T) for xyz in (found, expected))
        np.testing.assert_allclose(found[next(same)], expected[next(same)], atol=1e-5)


def test_little_memory_reads_the_same_scans(tmp_path, monkeypatch):
    _, _, seen = read(drive(tmp_path))
    monkeypatch.setattr(las_drive, "_MOST_WAITING", 45)
    _, _, again = read(tmp_path)
    for found, expected in zip(again, seen, strict=True):
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize(
    ("of_points", "of_trajectory"),
    [
        *((0.0, 0.0), (-1e9, 0.0), (0.0, 5 * 604800.0), (5 * 604800.0 - 1e9, 0.0), (3e8, 3e8)),
        # Unix time: 3,657 days after its begin GPS's began, and 18 leap seconds are between them
        *((offset, 3657 * 86400.0 - 18.0) for offset in (0.0, -1e9, -5 * 604800.0)),
    ],
)
def test_gps_time_of_the_week_or_less_a_milliard_is_found(tmp_path, of_points, of_trajectory):
    t_ns, _, seen = read(drive(tmp_path, time_s=TIME_S + of_points, at_s=AT_S + of_trajectory))
    assert len(t_ns) in (20, 21)  # sums of large times are rounded
    np.testing.assert_allclose(np.concatenate(seen), POINTS, atol=1e-5)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tum", {"end": "0 0 0 1"}),
        ("csv", {"head": "time,x,y,z,roll,pitch,yaw", "end": "1 2 3", "comma": True}),
        ("txt", {"head": "% GPSTime Easting Northing Height Heading", "end": "90"}),
    ],
)
def test_trajectories_of_several_programs_are_read(tmp_path, name, words):
    write_las(tmp_path / "a.las", POINTS, TIME_S)
    write_trajectory(tmp_path / f"trajectory.{name}", AT_S, PLACES, **words)
    assert len(read(tmp_path)[0]) == 20


def test_columns_are_found_by_their_names(tmp_path):
    write_las(tmp_path / "a.las", POINTS, TIME_S)
    rows = [f"7,{z},{x},{y},{t}" for t, (x, y, z) in zip(AT_S, PLACES.tolist(), strict=True)]
    (tmp_path / "trajectory.csv").write_text("\n".join(["id,z,x,y,time", *rows]))
    np.testing.assert_allclose(read(tmp_path)[1][0, :3, 3], [0.05, 0, 1.5])


refusal = partial(refusals.refusal, read)


@pytest.mark.parametrize("suffix", [".las", ".laz"])
@pytest.mark.parametrize("share", [0.01, 0.05, 0.5, 0.95])
def test_a_cut_off_file_ends_in_a_line(tmp_path, suffix, share):
    path = drive(tmp_path, suffix=suffix) / f"a{suffix}"
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    assert path.name in refusal(tmp_path)


@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_a_gigantic_count_ends_in_a_line(tmp_path, suffix):
    path = drive(tmp_path, suffix=suffix) / f"a{suffix}"
    data = bytearray(path.read_bytes())
    data[247:255] = (10**15).to_bytes(8, "little")  # LAS 1.4: number of points
    path.write_bytes(data)
    assert path.name in refusal(tmp_path)


@pytest.mark.parametrize("suffix", [".las", ".laz"])
@pytest.mark.parametrize("n_records", [10**5, 2**32 - 1])
def test_records_that_are_not_there_are_not_read(tmp_path, suffix, n_records):
    """Each that is stated took a microsecond or more, 2 ** 32 of them hours."""
    path = drive(tmp_path, suffix=suffix) / f"a{suffix}"
    data = bytearray(path.read_bytes())
    data[100:104] = n_records.to_bytes(4, "little")
    path.write_bytes(data)
    assert f"states {n_records} records" in refusal(tmp_path)


def test_a_table_of_gigantic_length_ends_in_a_line(tmp_path):
    path = drive(tmp_path) / "a.laz"
    data = bytearray(path.read_bytes())
    begin = int.from_bytes(data[96:100], "little")
    place = int.from_bytes(data[begin : begin + 8], "little")
    data[place + 4 : place + 8] = (2**31).to_bytes(4, "little")
    path.write_bytes(data)
    assert "damaged" in refusal(tmp_path)


@pytest.mark.parametrize("spoilt", [np.nan, np.inf, 1e300, 5e8])
def test_points_of_another_time_end_in_a_line(tmp_path, spoilt):
    assert "0 of 400 points" in refusal(drive(tmp_path, time_s=np.full(400, spoilt)))


def test_points_without_time_end_in_a_line(tmp_path):
    write_las(tmp_path / "a.las", POINTS, TIME_S, point_format=2)
    write_trajectory(tmp_path / "trajectory.txt", AT_S, PLACES)
    assert "GPS time" in refusal(tmp_path)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("# t x y z\n", "0 times"),
        ("1000 0 0 0\n", "1 times"),
        ("1000 0 0 0\n1e12 0 0 0\n", "2 times"),
        ("1000 0 0 0\n1001 0 nought 0\n", "line 2"),
        ("1000 0 0 0\n1001 0\n", "line 2"),
        ("nan 0 0 0\n1001 nan 0 0\n", "0 times"),
        ("1000 0 0 0\n1001 1e9 0 0\n", "1e+09 m"),
        (f"1000 0 0 0\n1001 0 0 0{' 0' * 40_000}\n", "more than 65536 bytes"),
    ],
)
def test_a_trajectory_that_is_none_ends_in_a_line(tmp_path, text, named):
    (drive(tmp_path) / "trajectory.txt").write_text(text)
    assert named in refusal(tmp_path)


def test_a_trajectory_of_too_many_places_ends_in_a_line(tmp_path, monkeypatch):
    monkeypatch.setattr(trajectory_file, "_MOST_PLACES", len(AT_S) - 1)
    assert "more than 4 places" in refusal(drive(tmp_path))


def test_two_trajectories_end_in_a_line(tmp_path):
    write_trajectory(drive(tmp_path) / "trajectory.tum", AT_S, PLACES)
    assert "2 of trajectory.txt" in refusal(tmp_path)


def test_a_cloud_beside_bags_is_not_read(tmp_path):
    write_las(tmp_path / "cloud.laz", POINTS, TIME_S)
    (tmp_path / "run.bag").write_bytes(b"x")
    assert dataset_files.find_files(tmp_path) == [str(tmp_path / "run.bag")]
