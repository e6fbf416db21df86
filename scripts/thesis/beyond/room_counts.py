"""How many scans a floor needs by its number of rooms, on floors drawn at random."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from scanplan.extraction import segments
from scanplan.geometry import se3
from scanplan.lab.buildings.building import Building
from scanplan.lab.evaluation import face_cells, length_metrics, visible_faces, wall_findings
from scanplan.lab.evaluation.wall_findings import JUDGED, WITHIN_M
from scanplan.lab.simulation import survey_setup, survey_truth, sweeps
from scanplan.lab.simulation.sweeps import SimulatedSurvey
from scanplan.selection import baselines, objectives, wall_cells
from scanplan.selection.survey_scans import SurveyScans
from scanplan.selection.wall_cells import WallCellSettings
from scanplan.types import BoolArray, Columns, FloatArray, IntArray, Settings
from thesis.beyond import generated_floor
from thesis.beyond.measurements import Measurement
from thesis.beyond.wall_search import WallSearch
from thesis.comparison import oracle

NEEDED, RECORDED = "scans to 95 % of the walls", "scans recorded"


def count_first(found: BoolArray, length_m: FloatArray, order: IntArray, *, share: float) -> int:
    """Return how many of the first scans find a share of what all find.

    Parameters
    ----------
    found : (n, c) bool
        Which cells of the true walls each scan finds.
    length_m : (c,) float
    order : (n,) int
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
) -> list[Measurement]:
    """Simulate the survey of a floor drawn at random, and count the scans that find its walls.

    Every scan is where it truly is, as in the thesis's survey of rooms.

    Parameters
    ----------
    n_rooms, seed : int
        See `generated_floor.draw_floor`.
    simulation : dict
        Settings of `survey_setup.prepare_survey` and, as `site`, of `prepare_site`.

    Returns
    -------
    list of Measurement
        `level` is the number of rooms, `item` the seed.
    """
    site, survey = prepare_floor(n_rooms, seed, simulation)
    _, poses = survey_setup.true_poses(survey)
    walls, observed = look_at_scans(survey, poses, search, cells)
    faces = survey_truth.select_faces(site.truth)
    true_cells = face_cells.cut_faces(faces.inner_m)
    view = visible_faces.SensorView(survey.sensor.max_range_m, survey.sensor.field_rad)
    is_visible = visible_faces.cells_seen_by_any(true_cells, faces.outer_m, poses, view)
    lines_m = length_metrics.table_lines_m(walls)
    runs = wall_findings.find_cells(true_cells, lines_m, WITHIN_M[JUDGED])
    shape = (len(poses), len(is_visible))
    found = wall_findings.cells_found_by_scan(runs, walls["scan_id"], shape) & is_visible
    scans = SurveyScans(np.arange(len(poses)), {"observations": observed})
    orders = {
        "oracle": oracle.order_by_truth(found, true_cells.length_m).order,
        "wall_length": objectives.cover_wall_length(scans).greedy().order,
        "distance": baselines.order_farthest_first(poses[:, :2, 3]),
        "every_nth": baselines.order_every_nth(scans),
    }
    rows = [Measurement("all scans", n_rooms, seed, RECORDED, len(poses))]
    for method, order in orders.items():
        needed = count_first(found, true_cells.length_m, order, share=0.95)
        rows.append(Measurement(method, n_rooms, seed, NEEDED, needed))
    return rows


def prepare_floor(
    n_rooms: int, seed: int, simulation: Settings
) -> tuple[Building, SimulatedSurvey]:
    """Return a floor drawn at random, and a survey of it that is yet to be simulated."""
    site = survey_setup.prepare_site(
        generated_floor.draw_floor(n_rooms, seed),
        Path("generated.geojson"),
        simulation,
        seed=seed,
    )
    return site, survey_setup.prepare_survey(site, simulation, seed=seed)


def look_at_scans(
    survey: SimulatedSurvey, poses: FloatArray, search: WallSearch, cells: WallCellSettings
) -> tuple[Columns, Columns]:
    """Simulate scans, and return the walls that each has and the wall that each shows.

    Scans are numbered from 0; none is kept, as those of a large floor would fill the memory.

    Parameters
    ----------
    poses : (n, 4, 4) float
        The sensor's at its scans.

    Returns
    -------
    walls, observed : dict of str to array
        The columns of `schemas.WALLS` and of `schemas.OBSERVATIONS`.
    """
    walls = []
    observed = []
    for scan_id, (xyz_m, pose) in enumerate(zip(_scan_points(survey, poses), poses, strict=True)):
        sensor_m = pose[:3, 3]
        walls.append(search.find(scan_id, xyz_m, sensor_m))
        observed.append(
            wall_cells.observe_wall_cells(
                scan_id,
                xyz_m,
                sensor_xyz_m=sensor_m,
                planar=search.planar,
                settings=cells,
                axes_deg=0,  # its floors lie along the axes
            )
        )
    ids = np.arange(len(poses))
    return segments.segment_columns(ids, walls), wall_cells.observation_columns(ids, observed)


def _scan_points(survey: SimulatedSurvey, poses: FloatArray) -> Iterator[FloatArray]:
    """Yield the points (n, 3) of every scan in the map."""
    for scan, pose in zip(sweeps.simulate_scans(survey), poses, strict=True):
        xyz_m = (survey.sensor.direction * scan.range_m[..., None]).reshape(-1, 3)
        yield se3.transform_points(pose, xyz_m[np.isfinite(xyz_m).all(axis=1)])
