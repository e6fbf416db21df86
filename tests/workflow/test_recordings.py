"""The workflow on real recordings, kept beside the project."""

import json

import numpy as np
import pyarrow.parquet as pq
import pytest
import shapely

from helpers.project_copy import Project
from scanplan.store import schemas, tables

pytestmark = [pytest.mark.workflow, pytest.mark.recordings]


@pytest.fixture(scope="module")
def project(project_root, recordings_dir, tmp_path_factory):
    """Make the plan of a recording, and what tells the same one in ROS 2 from it."""
    project = Project(project_root, tmp_path_factory.mktemp("recordings"))
    both = [str(recordings_dir / name) for name in ("jackal_ros1", "jackal_ros2")]
    made = project.run("--config", f"dataset={json.dumps(both[:1])}")
    assert made.returncode == 0, made.stdout + made.stderr
    # all later stages read nothing but what these tables hold
    wanted = [f"results/jackal_ros2/{table}.parquet" for table in ("scans", "registration")]
    same = project.run(*wanted, "--config", f"dataset={json.dumps(both)}")
    assert same.returncode == 0, same.stdout + same.stderr
    return project


def plan(project, name):
    features = json.loads((project.folder / f"results/{name}/plan/plan.geojson").read_text())[
        "features"
    ]
    return [
        shapely.LineString(f["geometry"]["coordinates"])
        for f in features
        if f["properties"]["kind"] == "face"
    ]


def test_ros1_and_ros2_give_the_same_scans_and_poses_to_make_a_plan_of(project):
    folders = [project.folder / f"results/jackal_ros{n}" for n in (1, 2)]
    scans = [pq.read_table(folder / "scans.parquet") for folder in folders]
    assert scans[0].equals(scans[1])
    registered = [
        tables.read_table(folder / "registration.parquet", schemas.REGISTRATION)
        for folder in folders
    ]
    for name, values in registered[0].items():
        np.testing.assert_array_equal(values, registered[1][name])


def test_the_arena_has_its_six_walls_once_each(project):
    """The arena is an L: six walls whose ends meet in pairs, none beside another."""
    walls = plan(project, "jackal_ros1")
    assert len(walls) == 6 and min(w.length for w in walls) > 1.5
    ends = shapely.points(np.concatenate([np.array(w.coords) for w in walls]))
    assert (shapely.distance(ends[:, None], ends[None]) < 0.05).sum(axis=1).tolist() == [2] * 12
    for a, first in enumerate(walls):
        for second in walls[a + 1 :]:
            assert first.buffer(0.3, cap_style="flat").intersection(second).length < 0.5


def test_returns_lie_on_the_walls(project):
    folder = project.folder / "results/jackal_ros1"
    points = np.concatenate(
        [xyz_m for _, xyz_m in tables.ScanStore(folder / "scans.parquet").scans()]
    )
    distance_m = shapely.distance(
        shapely.points(points[:, :2]), shapely.union_all(plan(project, "jackal_ros1"))
    )
    assert np.median(distance_m) < 0.03


# scenes7_room shows one furnished side of a room: next to nothing of its walls
LEAST_FACES = {"intel": 5, "mac_first_floor": 5, "scenes7_room": 1, "vlp16_room": 5}


@pytest.fixture(scope="module")
def others(project_root, recordings_dir, tmp_path_factory):
    """Make the plans of all other recordings in one run."""
    project = Project(project_root, tmp_path_factory.mktemp("others"))
    folders = [str(recordings_dir / name) for name in LEAST_FACES]
    made = project.run("--config", f"dataset={json.dumps(folders)}")
    assert made.returncode == 0, made.stdout + made.stderr
    return project


@pytest.mark.parametrize("name", LEAST_FACES)
def test_every_recording_ends_with_a_plan(others, name):
    assert len(plan(others, name)) >= LEAST_FACES[name]
    assert (others.folder / f"results/{name}/report.html").exists()
