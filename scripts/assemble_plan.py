"""Make the floor plan from the first scans of an ordering: faces, walls, openings and rooms, each standing once."""

import numpy as np

from scanplan import schemas, stagelog, tables
from scanplan.evaluation import registered
from scanplan.plan import planning, plansummary, rays
from scanplan.selection import stopping


def assemble_plan(walls, selection, scans, registration, outputs, *, settings, **stop):
    """Write the tables of the plan.

    Parameters
    ----------
    walls, selection, scans, registration : path-like
        walls/<extractor>.parquet, selection/<method>.parquet, scans.parquet and registration.parquet.
    outputs : dict of str to path-like
        Files to write: plan/<name>.parquet for the names in `planning.TABLES`.
    settings : dict
        Keywords of `planning.settings`.
    **stop
        How many scans to use, see `stopping.n_scans`.
    """
    seen = tables.read(walls, schemas.WALLS, allow_empty=True)
    ordering = tables.read(selection, schemas.SELECTION)
    count, reason = stopping.n_scans(ordering, **stop)
    chosen = np.sort(ordering["scan_id"][:count])
    used = np.isin(seen["scan_id"], chosen)
    plansummary.check_segments(walls, seen, used, count)
    kept, store = registered.read(registration), tables.ScanStore(scans)
    rows = registered.rows_of(chosen, kept, selection, registration)
    positions = dict(zip(chosen.tolist(), kept.map_from_sensor[rows, :3, 3], strict=True))
    looked = rays.gather(store.scans(chosen), positions, planar=store.planar)
    track_m = kept.map_from_sensor[:, :2, 3]
    segments = {column: values[used] for column, values in seen.items()}
    up = kept.map_from_sensor[rows, :3, 2]
    plan = planning.make(segments, looked, track_m, kept.t_ns[rows], planning.settings(**settings), up)
    plansummary.check_plan(walls, plan, used.sum(), count)
    for name, schema in planning.TABLES.items():
        tables.write(outputs[name], schema, getattr(plan, name), allow_empty=True)
    if warning := plansummary.sparse(looked, settings["openings"]["min_opening_m"]):
        stagelog.say(f"assemble_plan: {warning}")
    stagelog.say(f"assemble_plan: {used.sum():,} segments of {count} scans ({reason}) make {plansummary.text(plan)}")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        assemble_plan(
            snakemake.input.walls,
            snakemake.input.selection,
            snakemake.input.scans,
            snakemake.input.registration,
            dict(snakemake.output.items()),
            **snakemake.params.stop,
            settings=snakemake.params.settings,
        )
