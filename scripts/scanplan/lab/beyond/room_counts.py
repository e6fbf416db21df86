"""How many scans a floor needs by its number of rooms, on floors drawn at random."""

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from scanplan.geometry import se3
from scanplan.lab.beyond import generated_floor
from scanplan.lab.beyond.measurements import Measurement
from scanplan.lab.beyond.wall_search import WallSearch
from scanplan.lab.buildings.truth import format_features
from scanplan.lab.evaluation import oracle, truth_file, wall_findings
from scanplan.lab.evaluation.survey_findings import SurveyTruth, match_walls
from scanplan.lab.evaluation.wall_findings import JUDGED
from scanplan.lab.simulation import survey_setup, sweeps
from scanplan.selection import baselines, objectives, wall_cells
from scanplan.selection.survey_scans import SurveyScans
from scanplan.selection.wall_cells import WallCellSettings
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import BoolArray, FloatArray, IntArray, Settings

NEEDED, RECORDED = "scans to 95 % of the walls", "scans recorded"


def count_first(found: BoolArray, length_m: FloatArray, order: IntArray, *, share: float) -> int:
    """Return how many of the first scans find a share of what all find.

    Parameters
    ----------
    found : (n, c) bool
        Which cells of the true walls each scan finds.
    length_m : (c,) float
    order : (n,) int
    share : float
    """
    first = np.where(found.any(axis=0), found[order].argmax(axis=0), len(order))
    found_m = np.bincount(first, length_m, minlength=len(order) + 1)[: len(order)].cumsum()
    return int(np.searchsorted(found_m, share * found_m[-1])) + 1


def measure_floor(
    n_rooms: int,
    seed: int,
    simulation: Settings,
    search: WallSearch,
    cells: WallCellSettings,
    *,
    bitmap_cell_m: float,
) -> list[Measurement]:
    """Simulate the survey of a floor drawn at random, and count the scans that find its walls.

    Every scan is where it truly is, as in the thesis's survey of rooms.

    Parameters
    ----------
    n_rooms, seed : int
        See `generated_floor.draw_floor`.
    simulation : dict
        Settings of `survey_setup.prepare_survey` and, as `site`, of `prepare_site`.
    search : wall_search.WallSearch
    cells : wall_cells.WallCellSettings
    bitmap_cell_m : float

    Returns
    -------
    list of Measurement
        `level` is the number of rooms, `item` the seed.
    """
    survey, scans = simulate_floor(n_rooms, seed, simulation)
    known = survey.registered
    sensors_m = known.map_from_sensor[:, :3, 3]
    columns = search.find_all(survey, enumerate(scans))
    findings = match_walls(survey, columns, bitmap_cell_m)
    shape = survey.visible.seen.shape
    found = wall_findings.cells_found_by_scan(findings.found[JUDGED], findings.scan, shape)
    found &= survey.visible.visible
    observed = [
        wall_cells.observe_wall_cells(
            scan_id, xyz_m, sensor_xyz_m=sensor_m, planar=search.planar, settings=cells
        )
        for scan_id, (xyz_m, sensor_m) in enumerate(zip(scans, sensors_m, strict=True))
    ]
    seen = wall_cells.observation_columns(known.scan_ids, observed)
    survey_scans = SurveyScans(known.scan_ids, {"observations": seen})
    length_m = survey.visible.cells.length_m
    orders = {
        "oracle": oracle.order_by_truth(found, length_m).order,
        "wall_length": objectives.cover_wall_length(survey_scans).greedy().order,
        "distance": baselines.order_farthest_first(sensors_m[:, :2]),
        "every_nth": baselines.order_every_nth(survey_scans),
    }
    rows = [Measurement("all scans", n_rooms, seed, RECORDED, len(scans))]
    for method, order in orders.items():
        needed = count_first(found, length_m, order, share=0.95)
        rows.append(Measurement(method, n_rooms, seed, NEEDED, needed))
    return rows


def simulate_floor(
    n_rooms: int, seed: int, simulation: Mapping[str, Any]
) -> tuple[SurveyTruth, list[FloatArray]]:
    """Return a survey of a floor drawn at random, and the points (n, 3) of its scans in the map."""
    settings = {**simulation}
    site = survey_setup.prepare_site(
        generated_floor.draw_floor(n_rooms, seed),
        Path("generated.geojson"),
        settings["mount"],
        seed=seed,
        **settings["site"],
    )
    parts = ("mount", "sensor", "errors", "drive", "people")
    own = {name: settings[name] for name in parts}
    survey = survey_setup.prepare_survey(site, seed=seed, **own)
    t_ns, poses = survey_setup.true_poses(survey)
    scans = []
    for scan, pose in zip(sweeps.simulate_scans(survey), poses, strict=True):
        xyz_m = (survey.sensor.direction * scan.range_m[..., None]).reshape(-1, 3)
        scans.append(se3.transform_points(pose, xyz_m[np.isfinite(xyz_m).all(axis=1)]))
    features, view = survey_setup.survey_truth(site, survey)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "truth.geojson")
        path.write_text(format_features(features, sensor=view), encoding="utf-8")
        faces = truth_file.read_true_faces(path)
        sight = truth_file.read_sensor_view(path, max_range_m=survey.sensor.max_range_m)
    visible = wall_findings.observe_truth(faces, poses, poses, sight=sight)
    registered = RegisteredScans(np.arange(len(poses), dtype=np.int32), t_ns, poses)
    return SurveyTruth(registered, poses, faces, visible), scans
