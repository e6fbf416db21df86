"""Recordings without a localiser's poses, from the bag to the plan: odometry, and clouds alone."""

import shutil

import pytest
from rosbags.rosbag1 import Reader, Writer

from helpers.project_copy import TINY, Project
from scanplan.recordings.motion import pose_kind
from scanplan.store import schemas, tables

pytestmark = pytest.mark.workflow

# wheels that drift by as much as those of a rover do: 1 % of the way, 5 degrees in 100 m
DRIFTING = """
  localiser: {present: false}
  odometry: {scale_share: 0.01, drift_deg_per_m: 0.05}
"""


@pytest.fixture(scope="module")
def project(project_root, tmp_path_factory):
    """The tiny office driven through with odometry alone, and its plan with all that is told."""
    project = Project(project_root, tmp_path_factory.mktemp("odometry"))
    settings = (project.folder / TINY).read_text() + DRIFTING
    (project.folder / "drifting.yaml").write_text(settings)
    project.made = project.run("--configfile", "drifting.yaml")
    assert project.made.returncode == 0, project.made.stdout + project.made.stderr
    return project


def pose_kind_of(project, name):
    path = project.folder / f"results/{name}/poses.parquet"
    return tables.read_note(path, schemas.POSES, pose_kind.NOTE)


def shares(project, name):
    """Measures of a plan after one rigid motion: its frame is its own."""
    path = project.folder / f"results/{name}/evaluation/plan.parquet"
    plan = tables.read_table(path, schemas.PLAN_EVALUATION)
    row = plan["frame"].tolist().index("aligned")
    return {column: plan[column][row] for column in plan}


def test_a_drive_with_odometry_alone_ends_with_its_plan(project):
    assert pose_kind_of(project, "demo") == pose_kind.ODOMETRY
    log = (project.folder / "logs/demo/interpolate_poses.log").read_text()
    assert "the poses are odometry, which drifts" in log and "(found by topic and frame)" in log
    found = shares(project, "demo")
    assert found["visible_completeness_010m"] > 0.95 and found["correctness_010m"] > 0.95
    assert found["n_rooms_found"] == found["n_rooms_true"]
    told = (project.folder / "results/demo/summary.txt").read_text()
    assert "odometry alone" not in told and "folded" not in told
    assert (project.folder / "results/demo/report.html").exists()


def test_clouds_without_any_pose_end_with_the_same_walls(project):
    pytest.importorskip("kiss_icp", reason="KISS-ICP is not installed (make kiss-icp)")
    folder = project.folder / "clouds"
    folder.mkdir()
    survey = project.folder / "results/demo/survey"
    for name in ("truth.geojson", "truth_poses.tum"):
        shutil.copy(survey / name, folder / name)
    with Reader(survey / "survey.bag") as reader, Writer(folder / "clouds.bag") as writer:
        kept = [c for c in reader.connections if c.topic in ("/velodyne_points", "/tf_static")]
        copies = {
            c.id: writer.add_connection(c.topic, c.msgtype, msgdef=c.msgdef.data, md5sum=c.digest)
            for c in kept
        }
        for connection, t_ns, raw in reader.messages(kept):
            writer.write(copies[connection.id], t_ns, raw)
    evaluated = "results/clouds/evaluation/plan.parquet"
    made = project.run(evaluated, "--config", "dataset=clouds")
    assert made.returncode == 0, made.stdout + made.stderr
    assert pose_kind_of(project, "clouds") == pose_kind.ESTIMATED
    found, with_odometry = shares(project, "clouds"), shares(project, "demo")
    assert found["f1_010m"] > with_odometry["f1_010m"] - 0.02
