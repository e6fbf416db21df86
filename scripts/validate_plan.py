"""Measure how well the plan predicts the rays of scans that it was not made of."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scanplan.plan import floorplan
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath, Settings
from scanplan.validation import left_out_scans, prediction


def validate_plan(
    plan: Mapping[str, FilePath],
    selection: FilePath,
    scans: FilePath,
    registration: FilePath,
    outputs: Mapping[str, FilePath],
    *,
    settings: Settings,
    **stop: Any,
) -> None:
    """Write the tables of a plan's validation; no truth is asked.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms` and `free` of plan/.
    selection, scans, registration : path-like
        selection/<method>.parquet, scans.parquet and registration.parquet.
    outputs : dict of str to path-like
        `elements` and `rays`, to write: plan/validation.parquet and plan/validation_rays.parquet.
    settings : dict
        Keywords of `prediction.ValidationSettings`.
    **stop
        How many scans make the plan, see `stopping.choose_n_scans`.
    """
    limits = prediction.ValidationSettings(**settings)
    drawn = floorplan.read_floorplan(plan)
    chosen_ids, _ = stopping.read_chosen_scans(selection, **stop)
    registered = registered_scans.read_registered_scans(registration)
    left_out_ids = np.setdiff1d(registered.scan_ids, chosen_ids)
    scan_ids = left_out_scans.draw_left_out_scans(left_out_ids, limits.max_scans, limits.seed)
    rays = left_out_scans.draw_rays(
        tables.ScanStore(scans),
        scan_ids,
        registered_scans.sensor_positions(scan_ids, registered, scans, registration),
        (drawn.storey_m[0], drawn.ceiling_z_m),
        max_rays=limits.max_rays,
        seed=limits.seed,
    )
    found = prediction.validate_by_rays(drawn, rays, limits)
    absent = prediction.explain_absence(found, len(registered.scan_ids), len(left_out_ids))
    notes = {
        "n_left_out": str(len(left_out_ids)),
        "n_scans": str(len(scan_ids)),
        "tolerance_m": repr(found.tolerance_m),
        "absent": absent,
    }
    tables.write_table(outputs["elements"], schemas.VALIDATION, found.elements, notes=notes)
    tables.write_table(outputs["rays"], schemas.VALIDATION_RAYS, found.rays, allow_empty=True)
    result = absent or prediction.summarise_counts(found)
    log.log_line(f"validate_plan: {len(scan_ids)} of {len(left_out_ids)} scans left out; {result}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        validate_plan(
            dict(snakemake.input.items()),
            snakemake.input.selection,
            snakemake.input.scans,
            snakemake.input.registration,
            dict(snakemake.output.items()),
            settings=snakemake.params.settings,
            **snakemake.params.stop,
        )
