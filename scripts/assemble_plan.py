"""Make the floor plan from the first scans of an ordering.

Faces, walls, openings and rooms, each drawn once.
"""

import functools
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from scanplan.plan import messages, planning
from scanplan.plan.floorplan import FloorPlan, make_floorplan
from scanplan.plan.floorplan_files import format_nearly
from scanplan.plan.model import fronts
from scanplan.plan.model.designed_walls import DesignedWalls
from scanplan.rays import free_space, levels, ray_set
from scanplan.selection import stopping
from scanplan.stage import log, witnesses, workers
from scanplan.store import doubts, registered_scans, schemas, tables
from scanplan.types import FilePath, Settings
from scanplan.validation import contradictions


def assemble_plan(
    walls: FilePath,
    selection: FilePath,
    scans: FilePath,
    registration: FilePath,
    outputs: Mapping[str, FilePath],
    *,
    settings: Settings,
    design: FilePath | None = None,
    storey: str | int | None = None,
    threads: int = 1,
    **stop: Any,
) -> None:
    """Write the tables of the plan.

    Parameters
    ----------
    walls, selection, scans, registration : path-like
        walls/<extractor>.parquet, selection/<method>.parquet, scans.parquet and
        registration.parquet.
    outputs : dict of str to path-like
        Files to write: plan/<name>.parquet for the names in `planning.TABLES`.
    settings : dict
        What `planning.make_plan_settings` takes.
    design : path-like, optional
        What the floor is likelier to be as, an .ifc or .dxf file: a first plan ties its frame.
    storey : str or int, optional
        Of the design, by name or number from below.
    threads : int
        Cores to use; the plan does not depend on it.
    **stop
        How many scans to use, see `stopping.choose_n_scans`.
    """
    observed = tables.read_table(walls, schemas.WALLS, allow_empty=True)
    chosen_ids, reason = stopping.read_chosen_scans(selection, **stop)
    count = len(chosen_ids)
    scan_ids = np.sort(chosen_ids)
    is_used = np.isin(observed["scan_id"], scan_ids)
    earlier = doubts.read_doubts(registration, schemas.REGISTRATION).join(
        doubts.read_doubts(walls, schemas.WALLS)
    )
    messages.check_segments(walls, observed, is_used, count, earlier.findings)
    segments = {column: values[is_used] for column, values in observed.items()}
    store = tables.ScanStore(scans)
    registered = registered_scans.read_registered_scans(registration, store)
    rows = registered_scans.rows_of_scans(scan_ids, registered, selection, registration)
    poses = registered.map_from_sensor
    sensors_m = dict(zip(registered.scan_ids.tolist(), poses[:, :3, 3], strict=True))
    rays = ray_set.gather_rays(
        store.scans(scan_ids), sensors_m, planar=store.planar, threads=threads
    )
    wait_for_rays = workers.begin_in_thread(
        _read_rays, rays, settings["openings"]["min_opening_m"], threads=threads
    )
    find_floor = None
    if store.planar:
        retained = store.scans(registered.scan_ids)
        find_floor = workers.begin_in_thread(
            free_space.find_seen_floor, retained, sensors_m, threads=threads
        )
    dense = fronts.DenseScans(store.scans, registered, store.planar, threads=threads)
    others = planning.OtherScans(find_floor, dense)
    limits = planning.make_plan_settings(settings)
    chosen = planning.ChosenScans.of_registered(segments, rays, registered, rows)
    # sums that a library shares out among cores differ in their last digits
    with threadpool_limits(1):
        make_plan = functools.partial(
            planning.make_plan, chosen, poses[:, :2, 3], limits, others=others, threads=threads
        )
        plan = make_plan()
        messages.check_plan(walls, plan, is_used.sum(), count, earlier.findings)
        if design is not None:
            plan = make_plan(designed=_lay_design(design, storey, plan))
    heights_m, sparse = wait_for_rays()
    drawn = FloorPlan(
        name="",
        **{name: getattr(plan, name) for name in ("faces", "walls", "openings", "rooms", "free")},
        floor_z_m=float(heights_m["floor_z_m"]),
        ceiling_z_m=float(heights_m["ceiling_z_m"]),
    )
    track_m = poses[np.argsort(registered.t_ns), :2, 3]
    measured = [
        sparse,
        contradictions.measure_range_offset(
            rays, segments, limits.ranges, limits.reading.band_m, poses[rows, :3, 2]
        ),
        *contradictions.measure_drawn_walls(drawn, rays, track_m),
    ]
    found = earlier.add(findings=witnesses.tell("assemble_plan", measured))
    for name, schema in planning.TABLES.items():
        notes = None
        if name == "free":
            notes = {**heights_m, **found.as_notes(), "nearly": format_nearly(plan.nearly)}
        columns = getattr(plan, name)
        tables.write_table(outputs[name], schema, columns, allow_empty=True, notes=notes)
    log.log_line(
        f"assemble_plan: {messages.summarise_plan(plan)}; {is_used.sum():,} segments of"
        f" {count} scans; {reason}"
    )


def _lay_design(design: FilePath, storey: str | int | None, plan: planning.Plan) -> DesignedWalls:
    """Return a design where a plan ties it, and log what is doubtful about that."""
    # not of a plan without one
    from scanplan.design import design_prior, design_reading

    found = {name: getattr(plan, name) for name in planning.TABLES}
    first = make_floorplan(found, math.nan, math.nan, "the survey")
    known = design_reading.read_design(design)
    designed, told = design_prior.lay_design(known, Path(design).name, first, storey)
    for line in told:
        log.log_warning(f"assemble_plan: {line}")
    return designed


def _read_rays(
    rays: ray_set.RaySet, min_opening_m: float
) -> tuple[dict[str, str], witnesses.Measured]:
    """Return `_find_heights`, and how many points are too far off to see openings there."""
    return _find_heights(rays), messages.measure_sparse_rays(rays, min_opening_m)


def _find_heights(rays: ray_set.RaySet) -> dict[str, str]:
    """Return the heights of floor and ceiling in the map frame in words; nan where not seen."""
    z_m = np.empty(0) if rays.planar else rays.xyz_m[:, 2]
    floor_z_m, ceiling_z_m = levels.find_floor_and_ceiling(z_m)
    return {"floor_z_m": repr(float(floor_z_m)), "ceiling_z_m": repr(float(ceiling_z_m))}


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        assemble_plan(
            snakemake.input.walls,
            snakemake.input.selection,
            snakemake.input.scans,
            snakemake.input.registration,
            dict(snakemake.output.items()),
            **snakemake.params.stop,
            design=snakemake.input.get("design") or None,
            storey=snakemake.params.storey,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
        )
