"""Clouds without rays: storeys by height, and what places on a floor see of them."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from helpers import cloud_files, e57_making, ptx_making, refusals
from helpers.las_making import write_las
from scanplan.project import dataset_entries, dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.merged import merged_cloud, point_files
from scanplan.recordings.motion import pose_kind
from scanplan.recordings.survey import Reading, open_survey

LIMITS = {"min_range_m": 0.1, "max_range_m": 50.0}
STEP_M = 0.025


def plane(*spans):
    """Points of a rectangle, or a line, between two corners: a span (from, to) for each axis."""
    axes = [np.arange(low, high + STEP_M / 2, STEP_M) for low, high in spans]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def room(x=(0, 4), y=(0, 3), z=(0, 2.5)):
    """A room: floor, ceiling and four walls."""
    sides = [(x, y, (level, level)) for level in z]
    sides += [((side, side), y, z) for side in x] + [(x, (side, side), z) for side in y]
    return np.concatenate([plane(*side) for side in sides])


ROOM = room()
PARTITION = np.concatenate([plane((x, x), (0, 3), (0, 2.5)) for x in (2, 2.1)])
UPPER = room(x=(0, 3), z=(2.8, 5.3))


def write(folder, xyz_m, suffix=".ply"):
    if suffix in (".las", ".laz"):
        return write_las(folder / f"a{suffix}", xyz_m, np.zeros(len(xyz_m)))
    if suffix == ".e57":
        return e57_making.write_e57(folder / "a.e57", [np.eye(4)], [xyz_m])
    return cloud_files.write_by_open3d(folder / f"a{suffix}", xyz_m)


def read(place, **settings):
    """Return where a cloud is looked at from (n, 3), what is seen there in the map, and sentences.

    The two are in the coordinates that poses have.
    """
    with open_survey(dataset_files.find_files(place), Reading(**(LIMITS | settings))) as survey:
        t_ns = survey.stamps()
        assert (survey.pose_kind, survey.planar) == (pose_kind.STATIONS, False)
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=1)
        scans = list(survey.scans(range(len(t_ns))))
        told = survey.describe_rays()
    return (
        pose[:, :3, 3],
        [s.xyz_m + p[:3, 3] for s, p in zip(scans, pose, strict=True)],
        told,
    )


def test_places_stand_over_the_floor_and_see_no_farther_than_walls(tmp_path):
    places, seen, told = read(write(tmp_path, np.concatenate([ROOM, PARTITION])))
    assert len(told) == 1 and f"{len(places)} places" in told[0]
    np.testing.assert_allclose(places[:, 2], 1.4, atol=0.1)
    is_west = places[:, 0] < 2
    assert 2 <= is_west.sum() <= len(places) - 2
    for (x_m, y_m, _), xyz_m in zip(places, seen, strict=True):
        assert min(abs(x_m - 2.05) - 0.05, x_m, 4 - x_m, y_m, 3 - y_m) >= 0.25 - STEP_M
        # through the gaps of its points no ray passes a wall
        assert ((xyz_m[:, 0] < 2.03) if x_m < 2 else (xyz_m[:, 0] > 2.07)).all()
        assert len(np.unique(xyz_m.round(3), axis=0)) == len(xyz_m) > 2000


def test_what_is_seen_are_points_of_the_cloud(tmp_path):
    _, seen, _ = read(write(tmp_path, ROOM))
    of_cloud = set(map(tuple, (ROOM * 1000).round().astype(int).tolist()))
    assert set(map(tuple, (np.concatenate(seen) * 1000).round().astype(int).tolist())) <= of_cloud


def test_a_table_is_no_floor_and_nobody_stands_below_a_shelf(tmp_path):
    table = plane((0, 2), (0, 3), (0.75, 0.75))
    shelf = plane((2, 2.5), (0, 3), (1.6, 1.6))
    hall = room(x=(0, 7))
    places, _, _ = read(write(tmp_path, np.concatenate([hall, table, shelf])))
    assert (places[:, 0] >= 2.5 + 0.25 - STEP_M).all()
    np.testing.assert_allclose(places[:, 2], 1.4, atol=0.1)


def test_without_a_ceiling_floor_is_what_lies_below(tmp_path):
    places, _, told = read(write(tmp_path, ROOM[ROOM[:, 2] < 2.5 - 1e-6]))
    assert len(told) == 1
    np.testing.assert_allclose(places[:, 2], 1.4, atol=0.1)


@pytest.mark.parametrize(("asked", "floor_m", "width_m"), [(None, 0, 4), (0, 0, 4), (1, 2.8, 3)])
def test_of_two_storeys_one_is_seen_and_both_are_told(tmp_path, asked, floor_m, width_m):
    path = write(tmp_path, np.concatenate([UPPER, ROOM]), ".las")
    places, seen, told = read(path, storey=asked)
    assert "2 storeys" in told[1] and "advanced.input.storey" in told[1]
    assert f"storey {asked or 0}" in told[1] and "1 with its floor at z 2.8 m" in told[1]
    xyz_m = np.concatenate(seen)
    np.testing.assert_allclose(places[:, 2], floor_m + 1.4, atol=0.1)
    np.testing.assert_allclose(np.ptp(xyz_m, axis=0), [width_m, 3, 2.5], atol=0.01)
    np.testing.assert_allclose(xyz_m[:, 2].min(), floor_m, atol=0.01)


def test_a_storey_that_is_not_there_ends_in_a_line(tmp_path):
    path = write(tmp_path, np.concatenate([UPPER, ROOM]))
    assert "2 storeys" in refusals.refusal(partial(read, storey=2), path)


def test_far_coordinates_are_moved_by_whole_hundreds_of_metres(tmp_path, caplog):
    near, _, _ = read(write(tmp_path / "near", ROOM, ".las"))
    far = ROOM + np.array([500_000, 5_400_000, 300])
    places, seen, _ = read(write(tmp_path / "far", far, ".las"))
    assert "x 500000, y 5400000" in caplog.text
    np.testing.assert_allclose(places, near + np.array([0, 0, 300]), atol=1e-6)
    np.testing.assert_allclose(np.concatenate(seen).max(axis=0), (4, 3, 302.5), atol=2e-3)


def test_points_that_are_no_places_and_strays_are_left_out_and_counted(tmp_path, caplog):
    places, _, _ = read(write(tmp_path / "a", ROOM))
    bad = [(np.nan, 1, 1), (np.inf, 1, 1), (1e300, 0, 0), (7e5, 0, 0)]
    with caplog.at_level("INFO"):
        spoilt, _, _ = read(write(tmp_path / "b", np.concatenate([bad, ROOM])))
    assert f"{len(ROOM) + 4:,} points, 4 of which" in caplog.text
    np.testing.assert_allclose(spoilt, places)


def test_a_stray_far_above_takes_no_memory(tmp_path, monkeypatch):
    from scipy import ndimage

    sizes = []
    transform = ndimage.distance_transform_cdt
    monkeypatch.setattr(
        ndimage, "distance_transform_cdt", lambda *a: sizes.append(a[0].size) or transform(*a)
    )
    places, _, _ = read(write(tmp_path, np.concatenate([ROOM, [(1.0, 1.0, 14_000.0)]])))
    assert len(places) >= 3 and max(sizes) < 10_000


def test_little_memory_makes_cubes_larger(tmp_path, monkeypatch, caplog):
    path = write(tmp_path, ROOM)
    monkeypatch.setattr(merged_cloud, "_MOST_CUBES", 30_000)
    with caplog.at_level("INFO"):
        _, seen, _ = read(path)
    assert "cubes of 6 cm" in caplog.text
    assert all(len(xyz_m) > 1000 for xyz_m in seen)


@pytest.mark.parametrize("suffix", dataset_entries.MERGED_SUFFIXES)
def test_every_format_of_merged_clouds_has_a_reader(suffix):
    assert len(point_files.list_sources([Path(f"flat{suffix}")])) == 1


@pytest.mark.parametrize("suffix", [".las", ".laz", ".LAZ", ".ply", ".pcd"])
def test_the_points_of_every_format_come_as_they_are(tmp_path, suffix):
    path = write(tmp_path, ROOM, suffix.lower()).rename(tmp_path / f"b{suffix}")
    (source,) = point_files.list_sources([path])
    np.testing.assert_allclose(np.concatenate(list(source())), ROOM, atol=1e-6)


TABLES = {
    "text.ply": cloud_files.write_ply,
    "big.ply": partial(cloud_files.write_binary_ply, order="big", x="float"),
    "little.ply": cloud_files.write_binary_ply,
    "rows.pcd": cloud_files.write_pcd,
    "named.pcd": lambda path, xyz_m: cloud_files.write_pcd(path, xyz_m, ("_", xyz_m[:, 0])),
    "packed.pcd": partial(cloud_files.write_by_open3d, packed=True),
}


def write_text_pcd(path, xyz_m):
    lines = "\n".join(f"7 {x:.6f} {y:.6f} {z:.6f}" for x, y, z in xyz_m.tolist())
    path.write_text(
        "VERSION 0.7\nFIELDS i x y z\nSIZE 4 4 4 4\nTYPE U F F F\nCOUNT 1 1 1 1\n"
        f"WIDTH {len(xyz_m)}\nHEIGHT 1\nPOINTS {len(xyz_m)}\nDATA ascii\n{lines}\n"
    )


TABLES["text.pcd"] = write_text_pcd


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("block", [7, 2**18])
def test_tables_of_every_form_are_read_block_by_block(tmp_path, monkeypatch, name, block):
    monkeypatch.setattr("scanplan.recordings.table_points._BLOCK", block)
    TABLES[name](tmp_path / name, ROOM[:40])
    (source,) = point_files.list_sources([tmp_path / name])
    np.testing.assert_allclose(np.concatenate(list(source())), ROOM[:40], atol=1e-6)


def scan_parts():
    """The room and its partition as two scans that were put into one frame, without poses."""
    cloud = np.concatenate([ROOM, PARTITION]) - np.array([-6, 1.5, 1.2])
    return cloud[::2], cloud[1::2]


@pytest.mark.parametrize("suffix", [".e57", ".ptx"])
@pytest.mark.parametrize("n_scans", [1, 2])
def test_scans_of_stations_files_that_are_merged_are_a_cloud(tmp_path, suffix, n_scans):
    parts = [np.concatenate(scan_parts())] if n_scans == 1 else scan_parts()
    writer = e57_making.write_e57 if suffix == ".e57" else ptx_making.write_ptx
    path = writer(tmp_path / f"a{suffix}", [np.eye(4)] * n_scans, parts)
    places, seen, told = read(path)
    assert "no rays" in told[0]
    np.testing.assert_allclose(places[:, 2], 1.4 - 1.2, atol=0.1)
    assert all((np.abs(xyz_m - (8, 0, 0)).max(axis=0) < (2.1, 1.6, 1.4)).all() for xyz_m in seen)


def test_a_trajectory_beside_makes_them_a_drive(tmp_path):
    write_las(tmp_path / "a.las", ROOM, np.zeros(len(ROOM)))
    cloud_files.write_ply(tmp_path / "b.ply", ROOM[:10])
    (tmp_path / "trajectory.txt").write_text("0 0 0 0\n1 1 0 0\n")
    files = dataset_files.find_files(tmp_path)
    assert dataset_files.is_las_drive(files) and not dataset_files.is_merged_cloud(files)
    assert [file.rpartition("/")[2] for file in files] == ["a.las", "trajectory.txt"]


refusal = partial(refusals.refusal, read)


@pytest.mark.parametrize("suffix", [".las", ".laz", ".ply", ".pcd", ".e57"])
@pytest.mark.parametrize("share", [0.02, 0.5, 0.99])
def test_a_cut_off_file_ends_in_a_line(tmp_path, suffix, share):
    path = write(tmp_path, ROOM, suffix)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    refusal(path)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("text.ply", b"vertex 40", b"vertex 900000000000"),
        ("text.ply", b"vertex 40", b"vertex -40"),
        ("text.ply", b"vertex 40", b"vertex many"),
        ("text.ply", b"float x", b"float q"),
        ("text.ply", b"float x", b"list uchar int x"),
        ("text.ply", b"property float x", b"property float128 x"),
        ("text.ply", b"\n0.0 0.0 0.0", b"\n0.0 hello 0.0"),
        ("little.ply", b"vertex 40", b"vertex 900000000000"),
        ("little.ply", b"element vertex", b"element face 3\nproperty int i\nelement vertex"),
        ("rows.pcd", b"POINTS 40", b"POINTS 900000000000"),
        ("rows.pcd", b"POINTS 40", b"POINTS -40"),
        ("rows.pcd", b"FIELDS x y z", b"FIELDS x y q"),
        ("rows.pcd", b"TYPE F F F", b"TYPE F F O"),
        ("rows.pcd", b"SIZE 4 4 4", b"SIZE 4 3 4"),
        ("text.pcd", b"POINTS 40", b"POINTS 900000000000"),
        ("text.pcd", b"\n7 0.0", b"\n7 zero"),
        ("packed.pcd", b"DATA binary_compressed\n", b"DATA binary_compressed\n\xff\xff\xff\xff"),
    ],
)
def test_a_table_that_cannot_be_ends_in_a_line(tmp_path, name, old, new):
    path = tmp_path / name
    TABLES[name](path, ROOM[:40])
    data = path.read_bytes()
    assert old in data
    path.write_bytes(data.replace(old, new, 1))
    refusal(path)


@pytest.mark.parametrize(
    ("xyz_m", "named"),
    [
        (ROOM[:3], "no floor"),
        (np.full((50, 3), np.nan), "none of its 50 points"),
        (plane((0, 40), (0, 0), (0, 2.5)), "no floor"),
        (plane((0, 40), (0, 3), (0, 0)), "no floor"),
        (ROOM[:, [2, 0, 1]] * 0.3, "no floor"),
        (ROOM * 1000, "no floor"),
        (room(x=(0, 20), y=(0, 0.45)), "0 places"),
        (ROOM[np.random.default_rng(1).random(len(ROOM)) < 0.01], "no floor|closed surfaces"),
    ],
)
def test_a_cloud_that_shows_no_floor_ends_in_a_line(tmp_path, xyz_m, named):
    line = refusal(write(tmp_path, xyz_m))
    assert any(part in line for part in named.split("|"))


def test_a_ceiling_as_high_as_one_in_feet_is_told(tmp_path):
    write(tmp_path, ROOM / 0.3048)
    _, _, told = read(tmp_path)
    assert len(told) == 2
    # 8.2 feet, to a cube of 0.1
    assert "8.2 m above" in told[1] and "advanced.input.cloud_unit: ft" in told[1]
    places, _, told = read(tmp_path, cloud_unit="ft")
    assert len(told) == 1 and np.ptp(places[:, 0]) < 4


@pytest.mark.parametrize("factor", [100.0, 1000.0])
def test_points_too_far_apart_to_be_in_metres_are_refused_with_the_key(tmp_path, factor):
    write(tmp_path, factor * ROOM)
    assert "advanced.input.cloud_unit" in refusal(tmp_path)
