"""The stages of a plan as functions of arrays: the workflow's helpers, in its order."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from scanplan.arrays.given_scans import GivenScans, Placed, PlacedScans, read_given, read_poses
from scanplan.extraction import extractors, segments
from scanplan.plan import messages, planning
from scanplan.plan.floorplan import FloorPlan, make_floorplan
from scanplan.plan.floorplan_files import join_rated
from scanplan.plan.model import fronts
from scanplan.project import stage_settings
from scanplan.rays import free_space, levels, ray_set
from scanplan.recordings.motion import pose_kind
from scanplan.registration import batches, mapping, results
from scanplan.registration.registration_settings import registration_settings
from scanplan.selection import methods, orderings, persistence, stopping, wall_cells
from scanplan.stage import workers
from scanplan.store import registered_scans, scan_cache
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import Array, Columns, FloatArray, IntArray, Settings
from scanplan.validation import confidence, left_out_scans, prediction

_ORIGIN = "scans"  # what messages name in the place of a file
_METHOD = "wall_length"


@dataclass(frozen=True, eq=False)
class ArrayPlan:
    """A floor plan, and the scans that it is made of.

    Attributes
    ----------
    drawn : FloorPlan
        Tables, shapes and heights: all that `exports` draws.
    evidence : dict of str to (n,) array
        Which scans show a wall: the columns of `schemas.EVIDENCE`.
    scans : RegisteredScans
        Those that registration kept; `scan_ids` are indices of the scans given.
    chosen_ids : (k,) int
        Those that the plan is made of, the most worth first.
    """

    drawn: FloorPlan
    evidence: Columns
    scans: RegisteredScans
    chosen_ids: IntArray

    @property
    def walls(self) -> Columns:
        """The columns of `schemas.PLAN_WALLS`: centre lines, thickness, heights, errors (m)."""
        return self.drawn.walls

    @property
    def openings(self) -> Columns:
        """The columns of `schemas.OPENINGS`: type, ends, width, sill and lintel (m)."""
        return self.drawn.openings

    @property
    def rooms(self) -> Columns:
        """The columns of `schemas.ROOMS`: area (m2), perimeter (m), whether closed."""
        return self.drawn.rooms

    @property
    def room_shapes(self) -> Array:
        """The rooms' outlines, (r,) shapely Polygons, metres, map frame."""
        return self.drawn.areas


def points_from_ranges(
    ranges_m: npt.ArrayLike, angle_min_rad: float, angle_step_rad: float
) -> FloatArray:
    """Return the points (n, 2) of a 2-D scanner's ranges (n,), in its frame; NaN without return.

    >>> points_from_ranges([2.0, float("inf"), 3.0], 0.0, np.pi / 4).round(6).tolist()
    [[2.0, 0.0], [nan, nan], [0.0, 3.0]]
    """
    far_m = np.asarray(ranges_m, float)
    angle_rad = angle_min_rad + angle_step_rad * np.arange(len(far_m))
    far_m = np.where(np.isfinite(far_m) & (far_m > 0), far_m, np.nan)
    return far_m[:, None] * np.column_stack([np.cos(angle_rad), np.sin(angle_rad)])


def register_scans(
    scans: Sequence[npt.ArrayLike],
    poses: npt.ArrayLike,
    t_ns: npt.ArrayLike | None = None,
    *,
    settings: Settings | None = None,
    threads: int = 1,
) -> RegisteredScans:
    """Register scans to one another, and keep those that fit.

    Parameters
    ----------
    scans : sequence of (n_i, 3) or (n_i, 2) float
        Points in the sensor's frame, metres, one sweep each, free of the sensor's motion; (n, 2) of
        a level 2-D scanner. What is not finite or out of range is left out.
    poses : (n, 4, 4) float
        The localiser's `world_from_sensor` of each scan, z upwards; NaN where it has none.
    t_ns : (n,) int, increasing, optional
        When they were taken; ten a second by default.
    settings : dict, optional
        What differs from the defaults, section by section as in a `dataset.yaml`. With
        `registration.icp_method: none` poses are exact and stay as they are.
    threads : int
        Processes to use; the result does not depend on it.

    Returns
    -------
    RegisteredScans
        `scan_ids` are indices of the scans given.

    Raises
    ------
    ValueError
        If an array is of the wrong shape, or a pose is no rigid motion.
    StageError
        If a setting is out of its range, or no scan can be kept.
    """
    return _register(read_given(scans, t_ns, settings), poses, threads)


def make_plan(
    scans: Sequence[npt.ArrayLike],
    poses: npt.ArrayLike | RegisteredScans,
    t_ns: npt.ArrayLike | None = None,
    *,
    settings: Settings | None = None,
    name: str = "",
    threads: int = 1,
) -> ArrayPlan:
    """Make the floor plan of scans: register them, choose few, find their walls, assemble these.

    Parameters
    ----------
    scans, t_ns, settings, threads
        As of `register_scans`; each scan given may be chosen (`poses` of the settings thins none).
    poses : (n, 4, 4) float or RegisteredScans
        As of `register_scans`, or what that returned of the same scans.
    name : str
        What drawings call the plan.

    Raises
    ------
    ValueError
        As `register_scans`, or if `plan.method` is another than `wall_length`.
    StageError
        As `register_scans`, or if the scans show no wall.
    """
    given = read_given(scans, t_ns, settings)
    if (method := given.settings["plan"]["method"]) != _METHOD:
        raise ValueError(f"settings: plan.method: is {method}, of arrays it must be {_METHOD}")
    is_known = isinstance(poses, RegisteredScans)
    known = poses if is_known else _register(given, poses, threads)
    # sums that a library shares out among cores differ in their last digits
    with threadpool_limits(1):
        return assemble_plan(PlacedScans(given, known), name, threads)


def _register(given: GivenScans, poses: npt.ArrayLike, threads: int) -> RegisteredScans:
    kind = stage_settings.select_topics(given.settings)["pose_kind"]
    limits = registration_settings(stage_settings.select_section(given.settings, "registration"))
    if kind == pose_kind.STATIONS:
        limits = limits.of_stations()
    n_scans = len(given.scans)
    survey = batches.CandidateScans(
        scan_ids=np.arange(n_scans),
        priors=read_poses(poses, n_scans),
        planar=given.planar,
        is_odometry=pose_kind.is_drifting(kind),
    )
    with (
        TemporaryDirectory(prefix="scanplan-") as folder,
        scan_cache.open_scan_cache(Path(folder, "raw")) as raw,
        scan_cache.open_scan_cache(Path(folder, "thinned")) as thinned,
        workers.open_pool(threads) as run,
    ):
        cut = batches.cut_survey(n_scans, limits)
        caches = mapping.CandidateCaches(raw, thinned)
        verdicts, edges = mapping.register_candidates(survey, cut, given.scans, caches, run, limits)
        in_sequence = mapping.SequentialMap(survey, given.t_ns, verdicts, edges, thinned)
        verdicts, _ = mapping.optimise_map(in_sequence, run, limits)
    results.check_any_kept(verdicts, sum(scan.n_dropped for scan in given.scans), _ORIGIN)
    columns = results.registration_columns(survey.scan_ids, given.t_ns, verdicts)
    return registered_scans.select_kept_scans(columns, _ORIGIN)


def rate_plan(made: ArrayPlan, placed: Placed) -> FloorPlan:
    """Return a plan with how likely its elements are right, by rays of scans not chosen."""
    limits = prediction.ValidationSettings(**stage_settings.select_validation(placed.settings))
    rays = left_out_scans.draw_left_out_rays(
        placed, placed.known, made.chosen_ids, made.drawn, limits
    )
    found = prediction.validate_by_rays(made.drawn, rays, limits)
    rated = confidence.rate_elements(made.drawn, found.elements, limits.max_sigma_m)
    return join_rated(made.drawn, rated)


def _choose_scans(placed: Placed) -> IntArray:
    """Return the scans (k,) that the plan is made of, by rank."""
    cells = wall_cells.WallCellSettings(
        **stage_settings.select_wall_cells(placed.settings, methods.WALL_LIMITS)
    )
    axes_deg = wall_cells.choose_axes_deg(placed, placed.known.map_from_sensor[:, :3, 3], cells)
    observe = partial(
        wall_cells.observe_wall_cells, planar=placed.planar, settings=cells, axes_deg=axes_deg
    )
    observed = [observe(i, xyz_m, sensor_xyz_m=placed.sensors_m[i]) for i, xyz_m in placed.scans()]
    columns = wall_cells.observation_columns(placed.scan_ids, observed)
    if placed.planar:
        columns = persistence.weigh_by_persistence(columns, placed.known)
    wanted = stage_settings.select_order(placed.settings, methods.METHODS[_METHOD].settings)
    ordering = orderings.order_scans(
        _METHOD,
        {"scan_id": placed.scan_ids, "n_points": placed.n_points},
        others={"observations": columns},
        min_overlap=wanted["min_overlap"],
        budget=stopping.points_budget(**wanted["budget"]),
    )
    stop = stage_settings.select_section(placed.settings, "selection", "stop")
    count, _ = stopping.choose_n_scans(ordering, planar=placed.planar, **stop)
    return ordering["scan_id"][:count]


def _extract_segments(placed: Placed, scan_ids: IntArray) -> Columns:
    """Return the wall segments of some scans: the columns of `schemas.WALLS`."""
    name = placed.settings["plan"]["extractor"]
    settings = stage_settings.select_extractor(placed.settings, name)
    finder = extractors.make_wall_finder(
        extractors.EXTRACTORS[name], settings, planar=placed.planar
    )
    find = partial(extractors.find_wall_segments, finder=finder)
    found = [
        find(i, xyz_m, sensor_xyz_m=placed.sensors_m[i]) for i, xyz_m in placed.scans(scan_ids)
    ]
    return segments.segment_columns(scan_ids.tolist(), found)


def assemble_plan(placed: Placed, name: str, threads: int) -> ArrayPlan:
    """Choose few of registered scans, find their walls, and assemble these.

    Raises
    ------
    StageError
        If the scans show no wall.
    """
    parts = placed.parts
    chosen = [_choose_scans(part) for part in parts]
    chosen_ids = np.concatenate(chosen)
    scan_ids = np.sort(chosen_ids)
    rows = placed.rows(scan_ids)
    by_part = [
        _extract_segments(part, np.sort(ids)) for part, ids in zip(parts, chosen, strict=True)
    ]
    found = {name: np.concatenate([of[name] for of in by_part]) for name in by_part[0]}
    n_segments = len(found["scan_id"])
    messages.check_segments(_ORIGIN, found, np.ones(n_segments, bool), len(rows))
    rays = ray_set.gather_rays(
        placed.scans(scan_ids),
        placed.sensors_m,
        planar=placed.planar,
        left_out=placed.left_out,
        threads=threads,
    )
    flat = parts[-1]
    find_seen = partial(free_space.find_seen_floor, flat.scans(), flat.sensors_m)
    dense = fronts.DenseScans(
        placed.scans, placed.known, placed.planar, left_out=placed.left_out, threads=threads
    )
    plan = planning.make_plan(
        planning.ChosenScans.of_registered(found, rays, placed.known, rows),
        placed.known.map_from_sensor[:, :2, 3],
        planning.make_plan_settings(stage_settings.select_plan(placed.settings)),
        others=planning.OtherScans(find_seen if flat.planar else None, dense),
        threads=threads,
    )
    messages.check_plan(_ORIGIN, plan, n_segments, len(rows))
    # planar scans are the last
    z_m = np.empty(0) if placed.planar else rays.xyz_m[: rays.first[len(chosen[0])], 2]
    export = stage_settings.select_files(placed.settings)
    drawn = make_floorplan(
        {table: getattr(plan, table) for table in planning.TABLES},
        *levels.find_floor_and_ceiling(z_m),
        name,
        furniture=plan.furniture,
        assumed_thickness_m=export["assumed_thickness_m"],
        assumed_height_m=export["assumed_height_m"],
    )
    return ArrayPlan(drawn, plan.evidence, placed.known, chosen_ids)
