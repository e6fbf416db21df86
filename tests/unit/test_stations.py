import re
from functools import partial

import numpy as np
import pytest

from helpers import e57_making, ptx_making, refusals, small_flat
from helpers.e57_making import change_xml, write_e57
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.motion import pose_kind
from scanplan.recordings.survey import Reading, open_colours, open_survey

LIMITS = {"min_range_m": 0.1, "max_range_m": 50.0}
RNG = np.random.default_rng(2)
SPHERE = RNG.normal(size=(500, 3))
SPHERE *= 3 / np.linalg.norm(SPHERE, axis=1, keepdims=True)
POSES = np.tile(np.eye(4), (2, 1, 1))
POSES[1, :3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
POSES[1, :3, 3] = (4.0, -1.0, 0.25)
WITH_GAPS = np.where(np.arange(500)[:, None] % 10 == 0, np.nan, SPHERE)
WRITERS = {".e57": write_e57, ".ptx": ptx_making.write_ptx}


def survey_of(path, **settings):
    return open_survey(dataset_files.find_files(path), Reading(**(LIMITS | settings)))


def same_points(found, expected):
    """Whether two sets of points (n, 3) are the same to what files round to."""
    order = [np.lexsort(np.round(xyz, 2).T) for xyz in (found, expected)]
    np.testing.assert_allclose(found[order[0]], expected[order[1]], atol=1e-5)


@pytest.mark.parametrize("suffix", WRITERS)
def test_each_scan_is_a_station_with_its_pose(tmp_path, suffix):
    path = WRITERS[suffix](tmp_path / f"flat{suffix}", POSES, [WITH_GAPS, SPHERE])
    with survey_of(path) as survey:
        pose, _, covered = frame_edges.chain_poses(
            survey.pose_edges(), survey.stamps(), max_gap_s=2, max_speed_m_s=3
        )
        scans = list(survey.scans([0, 1]))
        assert (survey.pose_kind, survey.planar) == (pose_kind.STATIONS, False)
        assert survey.sweep_times is None
    assert covered.all()
    np.testing.assert_allclose(pose, POSES, atol=1e-9)
    same_points(scans[0].xyz_m, WITH_GAPS[np.isfinite(WITH_GAPS[:, 0])])
    same_points(scans[1].xyz_m, SPHERE)


def test_files_of_one_folder_are_one_survey(tmp_path):
    write_e57(tmp_path / "b.E57", POSES[1:], [SPHERE])
    ptx_making.write_ptx(tmp_path / "a.ptx", POSES[:1], [SPHERE])
    with survey_of(tmp_path) as survey:
        assert len(survey.stamps()) == 2
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), max_gap_s=1)
    np.testing.assert_allclose(pose, POSES, atol=1e-9)


def test_points_of_a_ptx_that_were_moved_to_the_world_are_moved_back(tmp_path):
    path = ptx_making.write_ptx(tmp_path / "a.ptx", POSES, [SPHERE, SPHERE], moved=True)
    with survey_of(path) as survey:
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), max_gap_s=1)
        (second,) = survey.scans([1])
    np.testing.assert_allclose(pose, POSES, atol=1e-6)
    same_points(second.xyz_m, SPHERE)


def test_angles_and_ranges_are_points(tmp_path):
    path = e57_making.write_spherical(
        tmp_path / "a.e57", [2.0, 2.0, 2.0], [0, np.pi / 2, 0], [0, 0, np.pi / 6]
    )
    with survey_of(path) as survey:
        (scan,) = survey.scans([0])
    same_points(scan.xyz_m, np.array([[2, 0, 0], [0, 2, 0], [3**0.5, 0, 1]]))


def test_far_coordinates_are_moved_by_whole_hundreds_of_metres(tmp_path, caplog):
    far = POSES.copy()
    far[:, :3, 3] += (500_010.0, 5_400_020.0, 300.0)
    with survey_of(write_e57(tmp_path / "a.e57", far, [SPHERE, SPHERE])) as survey:
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), max_gap_s=1)
    np.testing.assert_allclose(pose[:, :3, 3] - POSES[:, :3, 3], [[10, 20, 300]] * 2, atol=1e-6)
    assert "x 500000, y 5400000" in caplog.text


SIDES = np.where(SPHERE > 0, 255, 40).astype(int)


def read_coloured(path, **settings):
    """Return the points of the first station, and what their colours are."""
    files = dataset_files.find_files(path)
    with open_survey(files, Reading(**(LIMITS | settings))) as survey:
        (scan,) = survey.scans([0])
    with open_colours(files, Reading(**(LIMITS | settings))) as read_colours:
        return scan.xyz_m, None if read_colours is None else read_colours(0)


@pytest.mark.parametrize("suffix", WRITERS)
def test_the_points_that_are_kept_have_their_colours(tmp_path, suffix):
    near_and_far = WITH_GAPS * np.where(np.arange(500) % 3 == 0, 1.0, 0.5)[:, None]
    path = WRITERS[suffix](tmp_path / f"a{suffix}", POSES[:1], [near_and_far], SIDES)
    xyz_m, rgb = read_coloured(path, min_range_m=2.0)
    assert 100 < len(xyz_m) == len(rgb) < 250
    # of 8 bits as 16
    np.testing.assert_array_equal(rgb, np.where(xyz_m > 0, 65535, 40 * 257))


@pytest.mark.parametrize("suffix", WRITERS)
def test_without_colours_none_are_read(tmp_path, suffix):
    path = WRITERS[suffix](tmp_path / f"a{suffix}", POSES[:1], [SPHERE])
    assert read_coloured(path)[1] is None


def test_colours_lie_between_the_limits_that_a_scan_states(tmp_path):
    path = write_e57(tmp_path / "a.e57", POSES[:1], [SPHERE], SIDES)

    def state(xml):
        xml = re.sub(r"<(color\w+Maximum)( type=\S+)>255<", r"<\1\2>1023<", xml)
        return re.sub(r"<(color\w+Minimum)( type=\S+)/>", r"<\1\2>40</\1>", xml)

    change_xml(path, state)
    xyz_m, rgb = read_coloured(path)
    np.testing.assert_array_equal(rgb, np.where(xyz_m > 0, round(215 / 983 * 65535), 0))


def read_all(path):
    with survey_of(path) as survey:
        return [len(scan.xyz_m) for scan in survey.scans(range(len(survey.stamps())))]


refusal = partial(refusals.refusal, read_all)


def e57(folder, poses=POSES):
    return write_e57(folder / "a.e57", poses, [SPHERE] * len(poses))


@pytest.mark.parametrize("share", [0.02, 0.3, 0.7, 0.99])
def test_a_cut_off_e57_ends_in_a_line(tmp_path, share):
    path = e57(tmp_path)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    refusal(path)


def test_a_wrong_checksum_ends_in_a_line(tmp_path):
    path = e57(tmp_path)
    data = bytearray(path.read_bytes())
    data[200] ^= 1  # a point's
    path.write_bytes(data)
    assert "checksum" in refusal(path)


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('recordCount="500"', 'recordCount="900000000000"', "900000000000"),
        ('recordCount="500"', 'recordCount="600"', "scan 0"),
        ('recordCount="500"', 'recordCount="-1"', "scan 0"),
        ('recordCount="500"', 'recordCount="many"', "scan 0"),
        ("<cartesianX", "<cartesianX/><other", "no XML"),
        ("</e57Root>", "", "no XML"),
    ],
)
def test_a_description_that_cannot_be_ends_in_a_line(tmp_path, old, new, named):
    path = change_xml(e57(tmp_path), lambda text: text.replace(old, new, 1))
    assert named in refusal(path)


def test_a_scan_without_coordinates_ends_in_a_line(tmp_path):
    path = change_xml(e57(tmp_path), lambda text: text.replace("cartesianX", "cartesianQ"))
    assert "cartesianQ" in refusal(path)


def test_entities_that_grow_are_not_expanded(tmp_path):
    grow = "".join(f'<!ENTITY e{i + 1} "{f"&e{i};" * 100}">' for i in range(9))
    bomb = f'<!DOCTYPE e57Root [<!ENTITY e0 "ha">{grow}]>'

    def plant(text):
        head, sign, rest = text.partition("<e57Root")
        return head + bomb + sign + rest.replace("</e57Root>", "&e9;</e57Root>")

    assert "definitions" in refusal(change_xml(e57(tmp_path), plant))


@pytest.mark.parametrize("value", ["NaN", "1e999", "5", ""])
def test_a_pose_that_is_none_ends_in_a_line(tmp_path, value):
    bad = f'<w type="Float">{value}</w>'

    def spoil(text):
        begin = text.index("<w type")
        return text[:begin] + bad + text[text.index("\n", begin) :]

    path = change_xml(e57(tmp_path), spoil)
    named = "pose" if value != "5" else ""
    if value == "5":
        # a rotation of another length is the same rotation
        assert read_all(path) == [500, 500]
    else:
        assert named in refusal(path)


def test_scans_that_were_not_registered_end_in_a_line(tmp_path):
    assert "same pose" in refusal(e57(tmp_path, POSES[[0, 0]]))


def test_a_file_without_points_ends_in_a_line(tmp_path):
    path = write_e57(tmp_path / "a.e57", POSES[:0], [])
    assert "no scan" in refusal(path)


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("500\r\n1\r\n", "50\r\n1\r\n", "line 1"),
        ("500\r\n1\r\n", "900000000\r\n900000000\r\n", "810000000000000000"),
        ("500\r\n1\r\n", "nan\r\n1\r\n", "nan"),
        ("500\r\n1\r\n", "1001.5\r\n1\r\n", "1001.5"),
        ("0.500000\r\n", "0.5\r\nhello\r\n", "scan 1"),
        ("0 0 0 0.500000", "hello", "point"),
        ("1 0 0 0\r\n0 1", "nan 0 0 0\r\n0 1", "pose"),
        ("1 0 0 0\r\n0 1", "9 0 0 0\r\n0 1", "pose"),
    ],
)
def test_a_ptx_that_cannot_be_ends_in_a_line(tmp_path, old, new, named):
    path = ptx_making.write_ptx(tmp_path / "a.ptx", POSES, [WITH_GAPS, SPHERE])
    path.write_bytes(path.read_bytes().replace(old.encode(), new.encode(), 1))
    assert named in refusal(path)


def test_a_cut_off_ptx_ends_in_a_line(tmp_path):
    path = ptx_making.write_ptx(tmp_path / "a.ptx", POSES, [SPHERE, SPHERE])
    path.write_bytes(path.read_bytes()[:-2000])
    assert "scan 1" in refusal(path)


def test_one_merged_cloud_among_stations_ends_in_a_line(tmp_path):
    points = [
        se3.transform_points(pose, xyz)
        for pose, xyz in zip(
            small_flat.station_poses(), small_flat.station_points(1.0), strict=True
        )
    ]
    cloud = np.concatenate(points) - (2, 1, 1)
    path = write_e57(tmp_path / "a.e57", POSES, [cloud, SPHERE])
    assert "merged" in refusal(path)


@pytest.mark.recordings
def test_files_of_other_writers_are_read_or_end_in_a_line(recordings_dir):
    read = {
        "bunnyInt32.e57": 30571,
        "ColouredCubeFloat.e57": 7680,
        "ColourRepresentation.e57": 153,
        "pumpAVisualReferenceImage.e57": 155201,
        "translationWithoutRotation.e57": 4,
    }
    limits = {"min_range_m": 0.0}
    for path in sorted((recordings_dir / "e57").glob("*.e57")):
        if path.name in read:
            with survey_of(path, **limits) as survey:
                (scan,) = survey.scans([0])
            # thinned, and without the points in the scanner itself
            assert 0 < len(scan.xyz_m) <= read[path.name]
        else:
            refusal(path)
