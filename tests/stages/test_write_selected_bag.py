"""The chosen scans as a recording of their own, read back by rosbags and by the stages."""

import json

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from helpers import bag_making
from helpers.default_settings import SETTINGS
from helpers.hall_recording import N_SCANS, STEP_NS, messages_of, record, seen_from
from helpers.refusals import refused
from interpolate_poses import interpolate_poses
from register_scans import register_scans
from scanplan.exports import selected_bag
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.project.settings import merge_settings
from scanplan.project.stage_settings import select_section
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import pose_matrices
from write_selected_bag import write_selected_bag

CHOSEN = [2, 5, 6]
STOP = {"n_scans": len(CHOSEN)}


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
    with refused(file="selected.bag", value="the 3"):
        write(tmp_path, dataset_files.find_files(tmp_path / "folder"), settings, ".bag")
    assert not (tmp_path / "chosen").exists()
