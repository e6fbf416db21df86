"""The chosen scans as a recording of their own, read back by rosbags and by the stages."""

import json
from pathlib import Path

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from helpers import bag_making
from helpers.default_settings import SETTINGS
from interpolate_poses import interpolate_poses
from register_scans import register_scans
from scanplan.errors import StageError
from scanplan.exports import selected_bag
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.project.settings import merge_settings
from scanplan.project.stage_settings import select_section
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import pose_matrices
from write_selected_bag import write_selected_bag

N_SCANS = 8
STEP_NS = 100_000_000
CHOSEN = [2, 5, 6]
STOP = {"n_scans": len(CHOSEN)}


def seen_from(place, seed):
    """Points on the walls and the floor of a hall of 6 m by 4 m by 2.5 m."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(0, 1, (3000, 3)) * (6, 4, 2.5)
    side = rng.integers(0, 5, len(points))
    for s, (axis, value) in enumerate([(0, 0), (0, 6), (1, 0), (1, 4), (2, 0)]):
        points[side == s, axis] = value
    return (points - place).astype(np.float32)


def ranges_from(place):
    """Ranges of 720 level beams to the walls of the hall, those of `bag_making.laser_scan`."""
    scan = bag_making.laser_scan(np.zeros(720))
    angle = scan.angle_min + np.arange(720) * scan.angle_increment
    towards = np.column_stack([np.cos(angle), np.sin(angle)])
    with np.errstate(divide="ignore"):
        to_walls = np.where(towards > 0, (6, 4) - place[:2], -place[:2]) / towards
    return to_walls.min(axis=1)


def record(folder, kind, planar=False):
    """A drive of eight scans: AMCL's poses, odometry on /tf, extrinsics on /tf_static."""
    maker = bag_making.Maker(kind)
    entries = [("/tf_static", bag_making.START_NS - 1, maker.transforms(
        (bag_making.START_NS - 1, "base_link", "lidar", (0, 0, 0.5), (0, 0, 0, 1))
    ))]  # fmt: skip
    for i in range(-3, N_SCANS + 3):
        t_ns = bag_making.START_NS + i * STEP_NS
        place = np.array([1 + 0.1 * i, 2, 0])
        odom = (t_ns, "odom", "base_link", tuple(place - 1), (0, 0, 0, 1))
        entries.append(("/tf", t_ns, maker.transforms(odom)))
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, tuple(place))))
        if 0 <= i < N_SCANS and planar:
            scan = maker.laser(t_ns, ranges_from(place), frame="lidar")
            entries.append(("/scan", t_ns + 1, scan))
        elif 0 <= i < N_SCANS:
            cloud = maker.cloud(t_ns, seen_from(place + np.array([0, 0, 0.5]), i))
            entries.append(("/points", t_ns + 1, cloud))
    maker.write(folder / "run", entries)
    return dataset_files.find_files(folder)


def register(files, folder, settings):
    """Run the stages up to registration; return the scans' store and their results."""
    interpolate_poses(
        files,
        folder / "poses.parquet",
        moved=folder / "motion.parquet",
        **settings["poses"],
        **{k: v for k, v in settings["input"].items() if k != "deskew"},
    )
    outputs = [folder / f"{name}.parquet" for name in ("scans", "registration", "edges")]
    section = select_section(settings, "registration")
    register_scans(
        files, folder / "poses.parquet", *outputs, reading=settings["input"], settings=section
    )
    return tables.ScanStore(outputs[0]), tables.read_table(outputs[1], schemas.REGISTRATION)


def choose(folder):
    """Write an ordering whose first scans are the chosen ones, not in the order of recording."""
    order = [*reversed(CHOSEN), *(i for i in range(N_SCANS) if i not in CHOSEN)]
    zeros = dict.fromkeys(schemas.SELECTION.columns, np.zeros(N_SCANS))
    columns = zeros | {"rank": np.arange(1, N_SCANS + 1), "scan_id": np.array(order)}
    tables.write_table(folder / "selection.parquet", schemas.SELECTION, columns)
    return folder / "selection.parquet"


def survey(tmp_path, kind="ros1", planar=False):
    """Record, register and choose; return files, settings, the scans and their results."""
    settings = merge_settings(SETTINGS, {"poses": {"keep_every": 1}})
    files = record(tmp_path, kind, planar)
    return files, settings, *register(files, tmp_path, settings)


def write(tmp_path, files, settings, suffix):
    output = tmp_path / "chosen" / f"selected{suffix}"
    own_settings = tmp_path / "chosen" / f"selected{suffix}.yaml"
    write_selected_bag(
        files,
        choose(tmp_path),
        tmp_path / "registration.parquet",
        output,
        own_settings,
        reading=settings["input"],
        **STOP,
    )
    return output, json.loads(own_settings.read_text())


@pytest.mark.parametrize(
    ("kind", "suffix"),
    [("ros1", ".bag"), ("ros1", ".mcap"), ("mcap", ".mcap"), ("sqlite3", ".bag"), ("ros1", ".db3")],
)
def test_it_holds_the_chosen_clouds_as_recorded(tmp_path, kind, suffix):
    files, settings, _, _ = survey(tmp_path, kind)
    output, _ = write(tmp_path, files, settings, suffix)
    clouds = messages_of(files[0] if kind == "ros1" else tmp_path / "run", "/points")
    copied = messages_of(output, "/points")
    assert [t_ns for t_ns, _ in copied] == [clouds[i][0] for i in CHOSEN]
    for i, (_, cloud) in zip(CHOSEN, copied, strict=True):
        assert cloud.data.tobytes() == clouds[i][1].data.tobytes()
        assert cloud.header.frame_id == "lidar"


def messages_of(path, topic):
    """Read the messages of a topic with the standard types, without the recording's own."""
    store = get_typestore(Stores.ROS1_NOETIC if is_ros1(path) else Stores.ROS2_HUMBLE)
    with AnyReader([Path(path)], default_typestore=store) as reader:
        connections = [c for c in reader.connections if c.topic == topic]
        decode = store.deserialize_ros1 if is_ros1(path) else store.deserialize_cdr
        return [
            (t_ns, decode(raw, connection.msgtype))
            for connection, t_ns, raw in reader.messages(connections)
        ]


def is_ros1(path):
    return str(path).endswith(".bag")


def test_it_has_the_registered_poses_and_what_tells_the_motion(tmp_path):
    files, settings, _, registered = survey(tmp_path)
    output, _ = write(tmp_path, files, settings, ".bag")
    poses = messages_of(output, selected_bag.POSE_TOPIC)
    places = [(p.pose.position.x, p.pose.position.y, p.pose.position.z) for _, p in poses]
    # the poses are of the rover, half a metre below the sensor
    sensor_from_base = se3.pose_matrix([0, 0, -0.5], [0, 0, 0, 1])
    expected = (pose_matrices(registered)[CHOSEN] @ sensor_from_base)[:, :3, 3]
    np.testing.assert_allclose(places, expected, atol=1e-12)
    stamps = [p.header.stamp.sec * 10**9 + p.header.stamp.nanosec for _, p in poses]
    assert stamps == [bag_making.START_NS + i * STEP_NS for i in CHOSEN]
    assert {p.header.frame_id for _, p in poses} == {"map"}
    # a scan before and after each chosen one: of scans 2, 5 and 6 those of 1 to 3 and 4 to 7
    odometry = messages_of(output, "/amcl_pose")
    numbers = [(t_ns - bag_making.START_NS) // STEP_NS for t_ns, _ in odometry]
    assert numbers == [1, 2, 3, 4, 5, 6, 7]
    with AnyReader([output]) as reader:
        counts = {c.topic: c.msgcount for c in reader.connections}
    assert counts["/tf_static"] == 1 and counts["/tf"] == 7


@pytest.mark.parametrize("planar", [False, True])
def test_it_alone_gives_the_same_scans_in_the_same_places(tmp_path, planar):
    files, settings, store, registered = survey(tmp_path, planar=planar)
    output, own = write(tmp_path, files, settings, ".bag")
    folder = tmp_path / "again"
    folder.mkdir()
    again, found = register([str(output)], folder, merge_settings(settings, own))
    assert found["kept"].all() and len(again.scan_ids) == len(CHOSEN)
    assert again.planar == planar
    for name in (*schemas.XYZ, *schemas.QUAT):
        np.testing.assert_allclose(found[name], registered[name][CHOSEN], atol=1e-9)
    pairs = zip(store.scans(CHOSEN), again.scans(), strict=True)
    for (_, before_m), (_, after_m) in pairs:
        np.testing.assert_allclose(after_m, before_m, atol=1e-5)


def test_a_folder_of_scans_has_no_messages(tmp_path):
    import open3d

    _, settings, _, _ = survey(tmp_path)
    (tmp_path / "folder/scans").mkdir(parents=True)
    for i in range(N_SCANS):
        points = open3d.utility.Vector3dVector(seen_from((1, 2, 0.5), i).astype(float))
        cloud = open3d.geometry.PointCloud(points)
        open3d.io.write_point_cloud(str(tmp_path / f"folder/scans/{i}.ply"), cloud)
    lines = [f"{i} {1 + 0.1 * i} 2 0.5 0 0 0 1" for i in range(N_SCANS)]
    (tmp_path / "folder/poses.tum").write_text("\n".join(lines) + "\n")
    with pytest.raises(
        StageError, match=r"selected.bag: not written, as .*copy the files of the 3"
    ):
        write(tmp_path, dataset_files.find_files(tmp_path / "folder"), settings, ".bag")
    assert not (tmp_path / "chosen").exists()
