"""What stray returns, glass and people do to what scans cover, and to orders by it."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from scanplan.lab.evaluation.wall_findings import Findings
from scanplan.rays import visibility_polygon
from scanplan.rays.visibility_polygon import VisibilitySettings
from scanplan.selection import area_greedy, hulls, objectives, wall_cells
from scanplan.selection.survey_scans import SurveyScans
from scanplan.selection.wall_cells import WallCellSettings
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray, Settings
from thesis.beyond.measurements import Measurement
from thesis.beyond.wall_search import measure_walls
from thesis.claim_measures import FOUND
from thesis.comparison.survey_findings import SurveyTruth

FOUND_SHARE, AREA_RATIO = "walls found", "area, of that without outliers"
ONE_HULL, CLUSTERS, TRIMMED = "one hull", "clusters, every point", "clusters, without outliers"
FREE_SPACE, WALL_LENGTH = "free space", "length of wall shown"


def scatter_returns(xyz_m: FloatArray, share: float, rng: np.random.Generator) -> FloatArray:
    """Return a share of the points (n, 3) at random along their rays, as far as the farthest.

    The sensor is at the origin, as for all that follow.
    """
    range_m = np.linalg.norm(xyz_m, axis=1)
    is_stray = rng.random(len(xyz_m)) < share
    stray_m = rng.uniform(0, range_m.max(initial=0.0), len(xyz_m))
    return _move_along(xyz_m, np.where(is_stray, stray_m / range_m, 1.0))


def put_glass(xyz_m: FloatArray, share: float, rng: np.random.Generator) -> FloatArray:
    """Return points (n, 3) of which a share of all directions looks through panes or at mirrors.

    A pane takes ten degrees; what is behind it lies one to three times as far.
    """
    n_sectors = 36
    sector = _sectors(xyz_m, n_sectors)
    factor = np.where(rng.random(n_sectors) < share, rng.uniform(1, 3, n_sectors), 1.0)
    return _move_along(xyz_m, factor[sector])


def put_people(xyz_m: FloatArray, share: float, rng: np.random.Generator) -> FloatArray:
    """Return points (n, 3) of which a share of all directions ends at people, 1 to 2.5 m away.

    A person takes ten degrees, as half a metre does at three.
    """
    n_sectors = 36
    distance_m = rng.uniform(1, 2.5, n_sectors)
    is_person = rng.random(n_sectors) < share
    sector = _sectors(xyz_m, n_sectors)
    level_m = np.hypot(xyz_m[:, 0], xyz_m[:, 1])
    is_hidden = is_person[sector] & (level_m > distance_m[sector])
    return _move_along(xyz_m, np.where(is_hidden, distance_m[sector] / level_m, 1.0))


KINDS: Mapping[str, Callable[[FloatArray, float, np.random.Generator], FloatArray]] = {
    "stray returns": scatter_returns,
    "glass": put_glass,
    "people": put_people,
}


def measure_outliers(
    survey: SurveyTruth,
    findings: Findings,
    scans: Sequence[tuple[int, FloatArray]],
    shares: Iterable[float],
    *,
    n_selected: int,
    sampling: Settings,
    visibility: VisibilitySettings,
    cells: WallCellSettings,
    seed: int,
) -> Iterator[list[Measurement]]:
    """Measure what outliers do: to the mean area, and to what the first scans find.

    Orders go by the scans with outliers, their walls are those of the scans without.

    Parameters
    ----------
    findings : wall_findings.Findings
        Of the scans without outliers.
    scans : sequence of (int, (n, 3) float)
        Id and points, map frame: those to choose from.
    shares : iterable of float
        Of returns or directions, above 0; what is without outliers is measured as 0.
    n_selected : int
        Scans that are chosen.
    sampling : dict
        Keywords of `hulls.make_cluster_hulls`.

    Yields
    ------
    list of Measurement
        Of one kind of outliers, or of none.
    """
    ids = np.array([scan_id for scan_id, _ in scans])
    rows = np.searchsorted(survey.registered.scan_ids, ids)
    sensors_m = survey.registered.map_from_sensor[rows, :3, 3]

    def measure(kind: str, share: float) -> dict[str, tuple[float, float]]:
        changed = [
            _with_outliers(kind, share, scan_id, xyz_m - sensor_m, seed) + sensor_m
            for (scan_id, xyz_m), sensor_m in zip(scans, sensors_m, strict=True)
        ]
        covered = cover_by_each(ids, changed, sensors_m, sampling, visibility, cells)
        return {
            name: (area, measure_walls(survey, findings, rows[order[:n_selected]])[FOUND])
            for name, (area, order) in covered.items()
        }

    clean = measure("", 0.0)
    for kind in KINDS:
        measured = []
        for share, found in [(0.0, clean), *((s, measure(kind, s)) for s in shares)]:
            for name, (area_m2, walls) in found.items():
                case = f"{kind}: {name}"
                measured.append(Measurement(case, share, 0, FOUND_SHARE, walls))
                alone_m2 = clean[name][0]
                ratio = area_m2 / alone_m2 if alone_m2 > 0 else np.nan
                measured.append(Measurement(case, share, 0, AREA_RATIO, ratio))
        yield measured


def cover_by_each(
    scan_ids: IntArray,
    clouds: Sequence[FloatArray],
    sensors_m: FloatArray,
    sampling: Settings,
    visibility: VisibilitySettings,
    cells: WallCellSettings,
) -> dict[str, tuple[float, IntArray]]:
    """Return what scans cover together, square metres or metres, and their order, by surrogate."""
    made: dict[str, list[Columns]] = {TRIMMED: [], CLUSTERS: []}
    free, observed = [], []
    axes_deg = wall_cells.find_main_direction(
        zip(clouds, sensors_m, strict=True), planar=False, settings=cells
    )
    for scan_id, xyz_m, sensor_m in zip(scan_ids.tolist(), clouds, sensors_m, strict=True):
        where: dict[str, Any] = {"sensor_xyz_m": sensor_m, "planar": False}
        for name, radius in ((TRIMMED, sampling["radius"]), (CLUSTERS, "none")):
            own = {**sampling, "radius": radius}
            made[name].append(hulls.make_cluster_hulls(scan_id, xyz_m, **own))
        columns = visibility_polygon.scan_free_space(scan_id, xyz_m, settings=visibility, **where)
        free.append(shapely.from_wkb(columns["geometry"]))
        observed.append(
            wall_cells.observe_wall_cells(
                scan_id, xyz_m, settings=cells, axes_deg=axes_deg or 0, **where
            )
        )
    tables = {name: hulls.concatenate_hulls(parts) for name, parts in made.items()}
    shapes: dict[str, Array] = {
        ONE_HULL: hulls.scan_full_hulls(tables[TRIMMED])[1],
        CLUSTERS: hulls.scan_polygons(tables[CLUSTERS])[1],
        TRIMMED: hulls.scan_polygons(tables[TRIMMED])[1],
        FREE_SPACE: np.array(free, object),
    }
    covered = {name: area_greedy.order_by_area(own) for name, own in shapes.items()}
    columns = wall_cells.observation_columns(scan_ids, observed)
    lengths = objectives.cover_wall_length(SurveyScans(scan_ids, {"observations": columns}))
    covered[WALL_LENGTH] = lengths.greedy()
    return {name: (float(own.covered[-1]), own.order) for name, own in covered.items()}


def _with_outliers(
    kind: str, share: float, scan_id: int, xyz_m: FloatArray, seed: int
) -> FloatArray:
    if not share:
        return xyz_m
    return KINDS[kind](xyz_m, share, np.random.default_rng([seed, scan_id]))


def _sectors(xyz_m: FloatArray, n_sectors: int) -> IntArray:
    """Return the sector (n,) of all directions that each point lies in."""
    turn = np.arctan2(xyz_m[:, 1], xyz_m[:, 0]) / (2 * np.pi) % 1.0
    return np.minimum((turn * n_sectors).astype(int), n_sectors - 1)


def _move_along(xyz_m: FloatArray, factor: FloatArray) -> FloatArray:
    """Return points (n, 3) moved along their rays."""
    is_moved: BoolArray = factor != 1
    return np.where(is_moved[:, None], xyz_m * factor[:, None], xyz_m)
