"""Deskewing of whole simulated surveys, held against the building they were driven in."""

import copy

import numpy as np
import open3d as o3d
import pytest

from helpers.default_settings import SETTINGS
from helpers.exact_sensor import EXACT
from interpolate_poses import interpolate_poses
from scanplan.geometry import se3
from scanplan.lab.buildings import drawing_file, extrusion
from scanplan.project import stage_settings
from scanplan.recordings.motion import trajectory
from scanplan.recordings.survey import Reading, open_survey
from scanplan.store import schemas, tables, tum
from simulate_survey import simulate_survey

VLP16 = {"model": "vlp16", "n_azimuth": 240, "sweep": True}
LASER = {"model": "laser", "n_azimuth": 270, "sweep": True}


@pytest.fixture(scope="module")
def settings():
    return SETTINGS


@pytest.fixture(scope="module")
def building(project_root):
    return project_root / "config/buildings/tiny_office.geojson"


@pytest.fixture(scope="module", params=[VLP16, LASER], ids=["vlp16", "laser"])
def survey(request, tmp_path_factory, settings, building):
    """A survey without noise of a moving sensor, and the stage's idea of how it moved."""
    folder = tmp_path_factory.mktemp("moving")
    simulate = copy.deepcopy(stage_settings.select_simulation(settings))
    simulate["sensor"] |= request.param
    simulate["errors"] |= EXACT
    files = [
        folder / f
        for f in ("survey.bag", "truth.geojson", "truth_poses.tum", "truth_trajectory.tum")
    ]
    simulate_survey(building, *files, **simulate)
    reading = stage_settings.select_topics(settings)
    interpolate_poses(
        [str(files[0])],
        folder / "poses.parquet",
        moved=folder / "motion.parquet",
        **settings["poses"],
        **reading,
    )
    return folder


def true_motion(folder):
    t_ns, rows = tum.read_tum(folder / "truth_trajectory.tum")
    return trajectory.SensorMotion(t_ns, rows[:, :3], rows[:, 3:], np.zeros(len(t_ns), np.int32))


def off_the_walls_m(folder, building, way, **reading):
    """Distance of every point to the building, the scans placed by their true poses."""
    _, rows = tum.read_tum(folder / "truth_poses.tum")
    poses = se3.pose_matrix(rows[:, :3], rows[:, 3:])
    with open_survey([str(folder / "survey.bag")], Reading(**reading), motion=way) as survey:
        scans = list(survey.scans(range(1, len(poses) - 1)))
    placed = np.concatenate([se3.transform_points(poses[s.scan_id], s.xyz_m) for s in scans])
    mesh = extrusion.make_building_mesh(drawing_file.parse_drawing(building.read_bytes(), building))
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(mesh.vertices_m.astype(np.float32), mesh.triangles.astype(np.uint32))
    return scene.compute_distance(placed.astype(np.float32)).numpy()


def test_true_motion_restores_the_walls_to_two_millimetres(survey, building):
    skewed_m = off_the_walls_m(survey, building, None)
    assert np.percentile(skewed_m, 99) > 0.05
    assert off_the_walls_m(survey, building, true_motion(survey)).max() < 0.002


def test_recorded_odometry_takes_nearly_all_of_it_out(survey, building):
    way = trajectory.motion_from_columns(
        tables.read_table(survey / "motion.parquet", schemas.MOTION)
    )
    off_m = off_the_walls_m(survey, building, way)
    # the wheels of the simulated rover err by a percent
    assert np.median(off_m) < 0.002 and np.percentile(off_m, 99) < 0.02


def test_it_can_be_switched_off(survey, building):
    off_m = off_the_walls_m(survey, building, true_motion(survey), deskew=False)
    np.testing.assert_array_equal(off_m, off_the_walls_m(survey, building, None))
