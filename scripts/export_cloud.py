"""Write the registered points as a LAZ file."""

import json
from typing import Any

import numpy as np

from scanplan.exports.data import point_cloud
from scanplan.exports.model_origin import find_site
from scanplan.plan.floorplan import GeoReference
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import FilePath, Settings


def export_cloud(
    scans: FilePath,
    registration: FilePath,
    selection: FilePath,
    output: FilePath,
    *,
    settings: Settings,
    free: FilePath | None = None,
    **stop: Any,
) -> None:
    """Write the points of all scans, or of those that make the plan.

    Parameters
    ----------
    scans, registration, selection : path-like
        scans.parquet, registration.parquet and selection/<method>.parquet.
    output : path-like
        cloud.laz, to write.
    settings : dict
        `scans`, `chosen` or `all`, and `cell_m`, see `point_cloud.write_laz`; `site`, see
        `model_origin.Site`.
    free : path-like, optional
        plan/free.parquet, which states how reference points place the map.
    **stop
        How many scans are chosen, see `stopping.choose_n_scans`.
    """
    store = tables.ScanStore(scans)
    wanted = store.scan_ids
    if settings["scans"] == "chosen":
        wanted = np.sort(stopping.read_chosen_scans(selection, **stop)[0])
    t_ns = int(registered_scans.read_registered_scans(registration).t_ns[-1])
    note = "" if free is None else tables.read_note(free, schemas.FREE, "georeference")
    measured = GeoReference(**json.loads(note)) if note else None
    clouds = log.report_progress(store.scans(wanted), "export_cloud", total=len(wanted))
    with atomic.replace_file(output) as temporary:
        n_points, n_kept = point_cloud.write_laz(
            temporary, clouds, settings["cell_m"], t_ns, find_site(measured, settings["site"])
        )
    log.log_line(f"export_cloud: {len(wanted)} scans, {n_kept:,} of {n_points:,} points")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        export_cloud(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.selection,
            snakemake.output.cloud,
            settings=snakemake.params.settings,
            free=snakemake.input.free,
            **snakemake.params.stop,
        )
