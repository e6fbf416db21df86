"""Make the floor plan from the first scans of an ordering.

Faces, walls, openings and rooms, each standing once.
"""

import numpy as np

from scanplan.plan import messages, planning
from scanplan.rays import ray_set
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables


def assemble_plan(walls, selection, scans, registration, outputs, *, settings, **stop):
    """Write the tables of the plan.

    Parameters
    ----------
    walls, selection, scans, registration : path-like
        walls/<extractor>.parquet, selection/<method>.parquet, scans.parquet and
        registration.parquet.
    outputs : dict of str to path-like
        Files to write: plan/<name>.parquet for the names in `planning.TABLES`.
    settings : dict
        Keywords of `planning.make_plan_settings`.
    **stop
        How many scans to use, see `stopping.choose_n_scans`.
    """
    seen = tables.read_table(walls, schemas.WALLS, allow_empty=True)
    ordering = tables.read_table(selection, schemas.SELECTION)
    count, reason = stopping.choose_n_scans(ordering, **stop)
    chosen = np.sort(ordering["scan_id"][:count])
    used = np.isin(seen["scan_id"], chosen)
    messages.check_segments(walls, seen, used, count)
    kept, store = registered_scans.read_registered_scans(registration), tables.ScanStore(scans)
    rows = registered_scans.rows_of_scans(chosen, kept, selection, registration)
    positions = dict(zip(chosen.tolist(), kept.map_from_sensor[rows, :3, 3], strict=True))
    looked = ray_set.gather_rays(store.scans(chosen), positions, planar=store.planar)
    track_m = kept.map_from_sensor[:, :2, 3]
    segments = {column: values[used] for column, values in seen.items()}
    up = kept.map_from_sensor[rows, :3, 2]
    plan = planning.make_plan(
        segments, looked, track_m, kept.t_ns[rows], planning.make_plan_settings(**settings), up
    )
    messages.check_plan(walls, plan, used.sum(), count)
    for name, schema in planning.TABLES.items():
        tables.write_table(outputs[name], schema, getattr(plan, name), allow_empty=True)
    if warning := messages.sparse_rays_warning(looked, settings["openings"]["min_opening_m"]):
        log.log_line(f"assemble_plan: {warning}")
    log.log_line(
        f"assemble_plan: {used.sum():,} segments of {count} scans ({reason}) make {messages.summarise_plan(plan)}"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        assemble_plan(
            snakemake.input.walls,
            snakemake.input.selection,
            snakemake.input.scans,
            snakemake.input.registration,
            dict(snakemake.output.items()),
            **snakemake.params.stop,
            settings=snakemake.params.settings,
        )
