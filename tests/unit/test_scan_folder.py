import numpy as np
import pytest

from helpers import bag_making
from helpers.cloud_files import write_binary_ply, write_compressed_pcd, write_pcd, write_ply
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges, scan_folder
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.clouds import RangeLimits
from scanplan.recordings.survey import Reading, open_survey
from scanplan.store import tum

LIMITS = {"min_range_m": 0.1, "max_range_m": 50.0}
POINTS = bag_making.room_points(40)


def folder(tmp_path, names, poses):
    """A scan folder whose i-th named cloud is moved by i cm; returns its files."""
    for i, name in enumerate(names):
        write = write_ply if name.endswith("ply") else write_pcd
        write(tmp_path / "scans" / name, POINTS + np.float32(i / 100))
    (tmp_path / "poses.tum").write_text(poses)
    return [str(tmp_path / "poses.tum"), *sorted(str(tmp_path / "scans" / name) for name in names)]


TWO = (
    "# t tx ty tz qx qy qz qw\n1700000000.000000001 0 0 0 0 0 0 1\n"
    "1700000001.000000001 1 2 0 0 0 0 -1  # end\n\n"
)


def test_stamps_in_names_are_interpolated_to_the_nanosecond(tmp_path):
    files = folder(tmp_path, ["1700000000.500000001.pcd", "1700000000.000000001.ply"], TWO)
    with open_survey(files, Reading(**LIMITS)) as survey:
        assert survey.stamps().tolist() == [1_700_000_000_000_000_001, 1_700_000_000_500_000_001]
        pose, _, covered = frame_edges.chain_poses(
            survey.pose_edges(), survey.stamps(), max_gap_s=1
        )
        np.testing.assert_allclose(pose[:, :3, 3], [[0, 0, 0], [0.5, 1, 0]], atol=1e-9)
        assert covered.all()
        assert not survey.planar
        scans = list(survey.scans([1, 0]))
    assert [(s.scan_id, s.t_ns) for s in scans] == list(enumerate(survey.stamps()))
    np.testing.assert_allclose(scans[0].xyz_m, POINTS + np.float32(0.01), atol=1e-6)
    np.testing.assert_allclose(scans[1].xyz_m, POINTS, atol=1e-6)


def test_stamps_in_nanoseconds(tmp_path):
    files = folder(tmp_path, ["1700000000500000001.pcd"], TWO)
    with open_survey(files, Reading(**LIMITS)) as survey:
        assert survey.stamps().tolist() == [1_700_000_000_500_000_001]


def test_other_names_are_taken_in_natural_order(tmp_path):
    names = ["s10.pcd", "s2.pcd", "s1.pcd"]
    poses = "\n".join(f"{t} {t} 0 0 0 0 0 1" for t in (1, 2, 5.5))
    with open_survey(folder(tmp_path, names, poses), Reading(**LIMITS)) as survey:
        assert survey.stamps().tolist() == [10**9, 2 * 10**9, 5_500_000_000]
        shifts = [float((scan.xyz_m - POINTS)[0, 0]) for scan in survey.scans(range(3))]
        pose, gap_s, _ = frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), max_gap_s=0)
    np.testing.assert_allclose(shifts, [0.02, 0.01, 0.0], atol=1e-6)
    assert pose[:, 0, 3].tolist() == [1, 2, 5.5]
    assert gap_s.tolist() == [0, 0, 0]


def test_a_mount_and_bad_poses(tmp_path):
    poses = TWO + "1700000002 0 0 0 0 0 0 0\n1700000003 nan 0 0 0 0 0 1\n"
    files = folder(tmp_path, ["1700000000.000000001.pcd"], poses)
    with open_survey(files, Reading(base_from_sensor=[1, 0, 0, 0, 0, 90], **LIMITS)) as survey:
        edges = survey.pose_edges()
        pose, _, _ = frame_edges.chain_poses(edges, survey.stamps(), max_gap_s=1)
    assert len(edges[0].t_ns) == 2
    np.testing.assert_allclose(pose[0] @ [1, 0, 0, 1], [1, 1, 0, 1], atol=1e-12)


def test_times_and_ranges(tmp_path):
    points, times = [[1, 0, 0], [np.nan, 0, 0], [0, 99, 0], [0, 1, 0]], [0.1, 0.2, 30.0, 0.15]
    path = write_pcd(tmp_path / "scans" / "1.0.pcd", points, ("time", times))
    (tmp_path / "poses.tum").write_text("1 0 0 0 0 0 0 1\n")
    with open_survey([str(tmp_path / "poses.tum"), str(path)], Reading(**LIMITS)) as survey:
        (scan,) = survey.scans([0])
    assert (scan.xyz_m.tolist(), scan.n_dropped) == ([[1, 0, 0], [0, 1, 0]], 2)
    np.testing.assert_allclose(scan.time_s, [0.1, 0.15], atol=1e-7)


def test_flat_clouds_are_planar(tmp_path):
    files = [
        str(tmp_path / "poses.tum"),
        str(write_pcd(tmp_path / "scans" / "1.pcd", POINTS * (1, 1, 0))),
    ]
    (tmp_path / "poses.tum").write_text("1 0 0 0 0 0 0 1\n")
    with open_survey(files, Reading(**LIMITS)) as survey:
        assert survey.planar


def test_an_empty_cloud_has_no_points(tmp_path):
    files = [
        str(tmp_path / "poses.tum"),
        str(write_ply(tmp_path / "scans" / "1.ply", np.empty((0, 3)))),
    ]
    (tmp_path / "poses.tum").write_text("1 0 0 0 0 0 0 1\n")
    with open_survey(files, Reading(**LIMITS)) as survey:
        assert [len(scan.xyz_m) for scan in survey.scans([0])] == [0]


@pytest.mark.parametrize(
    "damage",
    [
        lambda p: p.write_bytes(p.read_bytes()[:-100]),
        lambda p: p.write_bytes(p.read_bytes()[:60]),
        lambda p: p.write_text("nothing of the kind"),
        lambda p: p.write_bytes(p.read_bytes().replace(b"POINTS 40", b"POINTS 99999999")),
    ],
)
def test_damaged_clouds(tmp_path, damage):
    files = folder(tmp_path, ["1700000000.5.pcd"], TWO)
    damage(tmp_path / "scans" / "1700000000.5.pcd")
    with (
        open_survey(files, Reading(**LIMITS)) as survey,
        pytest.raises(StageError, match=r"0.5.pcd: damaged"),
    ):
        list(survey.scans([0]))


@pytest.mark.parametrize(
    ("names", "poses", "told"),
    [
        (["a.pcd"], TWO, "2 poses for 1 clouds"),
        (["a.pcd", "b.pcd"], "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "do not increase"),
        (["a.pcd"], "1 0 0 0 0 0 1\n", "line 1 has 7 numbers"),
        (["a.pcd"], "# x\n1 0 0 zero 0 0 0 1\n", "line 2 is not"),
        (["a.pcd"], "inf 0 0 0 0 0 0 1\n", "line 1"),
        (["a.pcd"], "1e300 0 0 0 0 0 0 1\n", "line 1"),
        (["a.pcd"], "# nothing\n", "no usable pose"),
        (["a.pcd"], "1 0 0 0 0 0 0 0\n", "no usable pose"),
    ],
)
def test_poses_that_do_not_fit(tmp_path, names, poses, told):
    files = folder(tmp_path, names, poses)
    with pytest.raises(StageError, match=told), open_survey(files, Reading(**LIMITS)):
        pass


def test_asking_for_a_scan_that_is_not_there(tmp_path):
    survey = scan_folder.ScanFolder(
        folder(tmp_path, ["1.0.pcd"], TWO), CloudReading(RangeLimits(**LIMITS))
    )
    with pytest.raises(ValueError, match="asked for"):
        list(survey.scans([1]))


def scans_of(folder):
    (folder / "poses.tum").write_text("100 0 0 0 0 0 0 1\n")
    files = dataset_files.find_files(folder)
    with open_survey(files, Reading(**LIMITS)) as survey:
        return [scan.xyz_m for scan in survey.scans([0])]


@pytest.mark.parametrize("order", ["little", "big"])
def test_a_binary_ply_comes_whole_or_is_refused(tmp_path, order):
    path = write_binary_ply(tmp_path / "scans/a.ply", POINTS, order=order)
    np.testing.assert_allclose(scans_of(tmp_path)[0], POINTS, atol=1e-6)
    # 40 points of 25 bytes
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(StageError, match=r"a.ply: damaged: .* 1000 bytes, 999 are there"):
        scans_of(tmp_path)


def test_a_ply_of_mixed_coordinates_is_refused(tmp_path):
    write_binary_ply(tmp_path / "scans/a.ply", POINTS, x="float")
    with refused(file="a.ply", value=("double", "float")):
        scans_of(tmp_path)


def test_a_ply_of_text_that_is_cut_short_is_refused(tmp_path):
    path = write_ply(tmp_path / "scans/a.ply", POINTS)
    assert len(scans_of(tmp_path)[0]) == 40
    path.write_text("\n".join(path.read_text().splitlines()[:-2]))
    with pytest.raises(StageError, match=r"a.ply: damaged: .* 120 numbers, 114 are there"):
        scans_of(tmp_path)


def test_a_ply_without_a_header_is_refused(tmp_path):
    (tmp_path / "scans").mkdir()
    (tmp_path / "scans/a.ply").write_bytes(b"\xff\xfe no header")
    with pytest.raises(StageError, match=r"a.ply: damaged: its header"):
        scans_of(tmp_path)


@pytest.mark.parametrize("n_poses", [2, 3])
@pytest.mark.parametrize("names", [("1.5.ply", "2.5.pcd"), ("1500000000000000.ply", "2.5.ply")])
def test_a_cloud_without_a_stamp_beside_others_with_one_is_named(tmp_path, names, n_poses):
    poses = "".join(f"{t}.5 0 0 0 0 0 0 1\n" for t in range(1, n_poses + 1))
    files = folder(tmp_path, [*names, "map.ply"], poses)
    # as many poses as clouds or not: the i-th cloud by its name is not the i-th
    with refused(file="map.ply", value="2 stamps", remedy="move it"), open_survey(files, Reading()):
        pass


def test_a_name_that_looks_like_a_stamp_among_others_that_do_not_is_chance(tmp_path):
    poses = "\n".join(f"{t} {t} 0 0 0 0 0 1" for t in (1, 2, 5.5))
    files = folder(tmp_path, ["s1.pcd", "s2.pcd", "2.5.pcd"], poses)
    with open_survey(files, Reading(**LIMITS)) as survey:
        assert survey.stamps().tolist() == [10**9, 2 * 10**9, 5_500_000_000]


def test_names_of_more_digits_than_a_stamp_has_are_refused(tmp_path):
    write_ply(tmp_path / f"scans/{'1' * 200}.ply", POINTS)
    with refused(value="no stamp"):
        scans_of(tmp_path)


@pytest.mark.parametrize("stamp", ["1e99999999", "nan", "1e19"])
def test_stamps_that_no_clock_shows_are_refused(tmp_path, stamp):
    write_ply(tmp_path / "scans/a.ply", POINTS)
    (tmp_path / "poses.tum").write_text(f"{stamp} 0 0 0 0 0 0 1\n")
    with pytest.raises(StageError, match=r"poses.tum: line 1 "):
        tum.read_tum(tmp_path / "poses.tum")


def test_poses_may_begin_with_a_mark_of_their_coding(tmp_path):
    (tmp_path / "poses.tum").write_text("100 1 2 3 0 0 0 1\n", encoding="utf-8-sig")
    t_ns, rows = tum.read_tum(tmp_path / "poses.tum")
    assert t_ns.tolist() == [100 * 10**9] and rows[0, :3].tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    ("n_points", "unpacked", "said"),
    [
        # a point has 12 bytes
        (150_000_000, 1_800_000_000, "unpack to 1800000000, above 536870912"),
        (10, 2**32 - 1, "unpack to 4294967295, above 536870912"),
        (1000, 120, "points need 12000 bytes, its binary_compressed data have 120"),
    ],
)
def test_a_cloud_that_unpacks_to_too_much_is_refused_before_it_is_read(
    tmp_path, monkeypatch, n_points, unpacked, said
):
    monkeypatch.setattr(scan_folder, "_read_by_open3d", None)
    files = folder(tmp_path, ["1700000000.5.pcd"], TWO)
    write_compressed_pcd(tmp_path / "scans/1700000000.5.pcd", n_points, unpacked, bytes(1000))
    with open_survey(files, Reading(**LIMITS)) as survey, pytest.raises(StageError, match=said):
        list(survey.scans([0]))
