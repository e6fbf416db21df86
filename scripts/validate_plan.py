"""Measure how well the plan predicts rays of scans it was not made of, and rate its elements."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scanplan.plan import floorplan, floorplan_files
from scanplan.selection import stopping
from scanplan.stage import log, witnesses
from scanplan.store import doubts, registered_scans, schemas, tables
from scanplan.types import Columns, FilePath, Settings
from scanplan.validation import confidence, left_out_scans, prediction, survey_witnesses
from scanplan.validation.doubts import NO_RAYS


def validate_plan(
    inputs: Mapping[str, FilePath],
    outputs: Mapping[str, FilePath],
    *,
    settings: Settings,
    **stop: Any,
) -> None:
    """Write the tables of a plan's validation, and how likely its elements are right.

    No truth is asked.

    Parameters
    ----------
    inputs : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms` and `free` of plan/; `selection`, `scans` and
        `registration`: selection/<method>.parquet, scans.parquet and registration.parquet.
    outputs : dict of str to path-like
        `elements`, `rays` and `confidence`, to write: plan/validation.parquet,
        plan/validation_rays.parquet and plan/confidence.parquet.
    settings : dict
        Keywords of `prediction.ValidationSettings`.
    **stop
        How many scans make the plan, see `stopping.choose_n_scans`.
    """
    limits = prediction.ValidationSettings(**settings)
    drawn = floorplan_files.read_floorplan(inputs)
    chosen_ids, _ = stopping.read_chosen_scans(inputs["selection"], **stop)
    registered = registered_scans.read_registered_scans(inputs["registration"])
    store = tables.ScanStore(inputs["scans"])
    rays = left_out_scans.draw_left_out_rays(store, registered, chosen_ids, drawn, limits)
    n_left_out, n_drawn = len(registered.scan_ids) - len(chosen_ids), len(rays.scan_ids)
    found = prediction.validate_by_rays(drawn, rays, limits)
    absent = prediction.explain_absence(found, len(registered.scan_ids), n_left_out)
    if drawn.doubted.rayless:
        absent = NO_RAYS
    notes = {
        "n_left_out": str(n_left_out),
        "n_scans": str(n_drawn),
        "tolerance_m": repr(found.tolerance_m),
        "absent": absent,
    }
    tables.write_table(outputs["elements"], schemas.VALIDATION, found.elements, notes=notes)
    tables.write_table(outputs["rays"], schemas.VALIDATION_RAYS, found.rays, allow_empty=True)
    result = absent or prediction.summarise_counts(found)
    rated = confidence.rate_elements(drawn, found.elements, limits.max_sigma_m)
    xyz_m = registered.map_from_sensor[:, :3, 3]
    spoken = witnesses.tell(
        "validate_plan", survey_witnesses.measure_plan(drawn, rays, xyz_m, found)
    )
    tables.write_table(
        outputs["confidence"],
        schemas.CONFIDENCE,
        rated,
        notes=doubts.Doubts(findings=tuple(spoken)).as_notes(),
    )
    log.log_line(
        f"validate_plan: {result}; {n_drawn} of {n_left_out} unused scans;"
        f" {_summarise_confidence(drawn, rated)}"
    )


def _summarise_confidence(plan: floorplan.FloorPlan, rated: Columns) -> str:
    counts = [
        f"{np.sum(rated['verify'][rated['table'] == table])}"
        f" of {np.sum(rated['table'] == table)} {table}"
        for table in floorplan.NUMBERS
    ]
    words = f"; not rated, as {NO_RAYS}" if plan.doubted.rayless else ""
    return f"to verify on site: {', '.join(counts)}{words}"


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        validate_plan(
            dict(snakemake.input.items()),
            dict(snakemake.output.items()),
            settings=snakemake.params.settings,
            **snakemake.params.stop,
        )
