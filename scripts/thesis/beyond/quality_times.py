"""How long it takes to a good plan, selection included.

Times are processor time of one process: reading and registration as their jobs took, the rest
measured here. What a method looks at is counted, and nothing else: of every scan what its order
goes by, then the walls of the chosen scans, then the plan. No method saves registration, which
every order here needs.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from scanplan.extraction import segments
from scanplan.lab.evaluation import plan_metrics, wall_metrics
from scanplan.plan import planning
from scanplan.rays import ray_set
from scanplan.selection import area_greedy, baselines, hulls, objectives, persistence, wall_cells
from scanplan.selection.survey_scans import SurveyScans
from scanplan.selection.wall_cells import WallCellSettings
from scanplan.store.tables import ScanStore
from scanplan.types import FloatArray, IntArray, Settings
from thesis.beyond.measurements import Measurement
from thesis.beyond.sensitivity import hull_scans
from thesis.beyond.wall_search import WallSearch
from thesis.comparison.survey_findings import SurveyTruth
from thesis.timing import time_call

ALL_SCANS = "all scans"
GOOD = 0.95
"""The F1 of the plan's faces, at 0.10 m, that is waited for."""
F1, SECONDS, SELECTING = "F1 of the plan", "seconds", "seconds of selection"


@dataclass
class TimedSurvey:
    """A survey whose walls are extracted once, and timed.

    Attributes
    ----------
    truth : survey_findings.SurveyTruth
    store : tables.ScanStore
    search : wall_search.WallSearch
    plan : dict
        What `planning.make_plan_settings` takes.
    bitmap_cell_m : float
    """

    truth: SurveyTruth
    store: ScanStore
    search: WallSearch
    plan: Settings
    bitmap_cell_m: float
    _walls: dict[int, tuple[float, segments.WallSegments]] = field(default_factory=dict)

    def measure_plan(self, rows: IntArray) -> tuple[float, float]:
        """Return the F1 of the plan of some scans (k,), and its seconds, walls included."""
        known = self.truth.registered
        rows = np.sort(rows)
        walls = [self._find_walls(int(row)) for row in rows]
        columns = segments.segment_columns(known.scan_ids[rows], [found for _, found in walls])
        seconds, plan = time_call(partial(self._make_plan, rows, columns))
        drawn = {"faces": plan.faces, "furniture": plan.furniture}
        faces_m = plan_metrics.moved_faces_m(drawn, np.eye(4))
        measured = wall_metrics.measure_plan_lines(faces_m, self.truth.visible, self.bitmap_cell_m)
        return float(measured["visible_f1_010m"]), seconds + sum(took for took, _ in walls)

    def _find_walls(self, row: int) -> tuple[float, segments.WallSegments]:
        if row not in self._walls:
            known = self.truth.registered
            scan_id = int(known.scan_ids[row])
            xyz_m = self.store.read(scan_id)
            sensor_m = known.map_from_sensor[row, :3, 3]
            self._walls[row] = time_call(partial(self.search.find, scan_id, xyz_m, sensor_m))
        return self._walls[row]

    def _make_plan(self, rows: IntArray, columns: Mapping[str, Any]) -> planning.Plan:
        known = self.truth.registered
        poses = known.map_from_sensor
        scan_ids = known.scan_ids[rows]
        sensors_m = dict(zip(scan_ids.tolist(), poses[rows, :3, 3], strict=True))
        scans = self.store.scans(scan_ids)
        rays = ray_set.gather_rays(scans, sensors_m, planar=self.store.planar)
        return planning.make_plan(
            planning.ChosenScans.of_registered(columns, rays, known, rows),
            poses[:, :2, 3],
            planning.make_plan_settings(self.plan),
        )


def time_orders(
    survey: TimedSurvey, cells: WallCellSettings, sampling: Settings
) -> dict[str, tuple[float, IntArray]]:
    """Time the orders that are compared, from registered scans on.

    Parameters
    ----------
    sampling : dict
        Keywords of `hulls.make_cluster_hulls`.

    Returns
    -------
    dict of str to (float, (n,) int)
        Processor seconds and rows of the scans by method.
    """
    scans = SurveyScans(survey.truth.registered.scan_ids)
    places_m = survey.truth.registered.map_from_sensor[:, :2, 3]
    methods: dict[str, Callable[[], IntArray]] = {
        "every_nth": partial(baselines.order_every_nth, scans),
        "distance": partial(baselines.order_farthest_first, places_m),
        "cluster_hull": partial(_order_by_hulls, survey, sampling),
        "wall_length": partial(_order_by_walls, survey, cells),
    }
    # the first call loads what all others use
    _order_by_hulls(survey, sampling, most=1)
    return {method: time_call(choose) for method, choose in methods.items()}


def time_to_quality(
    survey: TimedSurvey,
    orders: Mapping[str, tuple[float, IntArray]],
    sizes: Sequence[int],
    *,
    recorded_s: float,
) -> Iterator[list[Measurement]]:
    """Make plans of ever more scans until one is good, by every order, and of all scans.

    Parameters
    ----------
    orders : dict of str to (float, (n,) int)
        As `time_orders` returns them.
    sizes : sequence of int, increasing
        Numbers of scans to try.
    recorded_s : float
        What reading and registration took.

    Yields
    ------
    list of Measurement
        Of one order; `level` is the number of scans; the last is the first of which a plan is good,
        or the most that were tried.
    """
    n_scans = len(survey.truth.registered.scan_ids)
    for method, (selecting_s, order) in orders.items():
        rows: list[Measurement] = []
        for size in [size for size in sizes if size < n_scans]:
            f1, seconds = survey.measure_plan(order[:size])
            rows += _rows(method, size, f1, recorded_s + selecting_s + seconds, selecting_s)
            if f1 >= GOOD:
                break
        yield rows
    f1, seconds = survey.measure_plan(np.arange(n_scans))
    yield list(_rows(ALL_SCANS, n_scans, f1, recorded_s + seconds, 0.0))


def _order_by_hulls(survey: TimedSurvey, sampling: Settings, most: int | None = None) -> IntArray:
    scans = survey.store.scans(survey.store.scan_ids[:most])
    _, polygons = hulls.scan_polygons(hull_scans(scans, sampling))
    return area_greedy.order_by_area(polygons).order


def _order_by_walls(survey: TimedSurvey, settings: WallCellSettings) -> IntArray:
    known = survey.truth.registered
    sensors_m: FloatArray = known.map_from_sensor[:, :3, 3]
    planar = survey.store.planar
    axes_deg = wall_cells.choose_axes_deg(survey.store, sensors_m, settings)
    observed = [
        wall_cells.observe_wall_cells(
            scan_id,
            xyz_m,
            sensor_xyz_m=sensor_m,
            planar=planar,
            settings=settings,
            axes_deg=axes_deg,
        )
        for (scan_id, xyz_m), sensor_m in zip(survey.store.scans(), sensors_m, strict=True)
    ]
    columns = wall_cells.observation_columns(known.scan_ids, observed)
    if planar:
        columns = persistence.weigh_by_persistence(columns, known)
    scans = SurveyScans(known.scan_ids, {"observations": columns})
    return objectives.cover_wall_length(scans).greedy().order


def _rows(
    method: str, size: int, f1: float, seconds: float, selecting_s: float
) -> Iterator[Measurement]:
    for quantity, value in ((F1, f1), (SECONDS, seconds), (SELECTING, selecting_s)):
        yield Measurement(method, size, 0, quantity, value)
