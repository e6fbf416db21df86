"""Measure how well the plan predicts the rays of scans that it was not made of."""

from collections.abc import Mapping
from typing import Any

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
    rays = left_out_scans.draw_left_out_rays(
        tables.ScanStore(scans),
        registered,
        chosen_ids,
        (drawn.storey_m[0], drawn.ceiling_z_m),
        max_scans=limits.max_scans,
        max_rays=limits.max_rays,
        seed=limits.seed,
    )
    n_left_out, n_drawn = len(registered.scan_ids) - len(chosen_ids), len(rays.scan_ids)
    found = prediction.validate_by_rays(drawn, rays, limits)
    absent = prediction.explain_absence(found, len(registered.scan_ids), n_left_out)
    notes = {
        "n_left_out": str(n_left_out),
        "n_scans": str(n_drawn),
        "tolerance_m": repr(found.tolerance_m),
        "absent": absent,
    }
    tables.write_table(outputs["elements"], schemas.VALIDATION, found.elements, notes=notes)
    tables.write_table(outputs["rays"], schemas.VALIDATION_RAYS, found.rays, allow_empty=True)
    result = absent or prediction.summarise_counts(found)
    log.log_line(f"validate_plan: {n_drawn} of {n_left_out} scans left out; {result}")


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
