"""Tabulate time, scans and data after each step from recording to subset (thesis, table 5.1)."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from scanplan.stage import log, run_times
from scanplan.store import schemas, tables, tum
from scanplan.types import FilePath
from thesis import thesis_schemas

_STEPS = [
    "Data collection",
    "Selecting continuous scans",
    "Registration optimization",
    "Hull creation",
    "Cluster subset selection",
]

_PAST_FIRST_GATE = ("kept", "anchor", "unconfirmed", "icp_diverged", "low_refined_fitness")
"""Reasons of `sequential.ScanResult` that a scan has only past the gate at the localiser's pose."""


def tabulate_steps(
    recordings: Sequence[FilePath],
    true_poses: FilePath,
    registration: FilePath,
    scans: FilePath,
    built: FilePath,
    selection: FilePath,
    times: Sequence[Sequence[FilePath]],
    output: FilePath,
    *,
    n_selected: int,
) -> None:
    """Write the table; its run times differ from run to run.

    Parameters
    ----------
    true_poses, registration, scans, built, selection : path-like
        truth_poses.tum (a pose per recorded scan), registration.parquet, scans.parquet,
        hulls.parquet and an ordering.
    times : list of list of path-like
        The benchmark files of the last three steps, those of a step together. The gate that
        selects scans has no time of its own and writes nothing: both gates are one pass.
    output : path-like
        thesis/steps.parquet, to write.
    n_selected : int
        Size of the subset.
    """
    t_ns, _ = tum.read_tum(true_poses)
    hulls = tables.read_table(built, schemas.HULLS, ["scan_id", "cluster", "n_points"])
    order = tables.read_table(selection, schemas.SELECTION, ["rank", "scan_id"])["scan_id"]
    subset_ids = order[:n_selected]
    verdicts = tables.read_table(registration, schemas.REGISTRATION, ["scan_id", "reason"])
    n_passed = int(np.isin(verdicts["reason"], _PAST_FIRST_GATE).sum())
    n_kept = len(np.unique(hulls["scan_id"]))
    in_subset = np.isin(hulls["scan_id"], subset_ids)
    # points take the same room wherever they are in the table
    share = hulls["n_points"][in_subset].sum() / hulls["n_points"].sum()
    registered_bytes = _size(scans)
    n_bytes = [
        sum(map(_size, recordings)),
        thesis_schemas.NOT_WRITTEN,
        registered_bytes,
        _size(built),
        share * registered_bytes,
    ]
    drive_s = (t_ns[-1] - t_ns[0]) / 1e9
    jobs_s = [sum(map(run_times.read_job_seconds, files)) for files in times]
    rows = {
        "step": np.arange(1, len(_STEPS) + 1),
        "name": _STEPS,
        "seconds": np.array([drive_s, np.nan, *jobs_s]),
        "n_scans": np.array([len(t_ns), n_passed, n_kept, n_kept, len(subset_ids)]),
        "n_bytes": np.array(n_bytes).astype(np.int64),
    }
    tables.write_table(output, thesis_schemas.STEPS, rows)
    log.log_line(
        f"tabulate_steps: {len(t_ns):,} scans, {n_kept} registered, {len(subset_ids)} selected"
    )


def _size(path: FilePath) -> int:
    return Path(path).stat().st_size


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        tabulate_steps(
            snakemake.input.recordings,
            snakemake.input.true_poses,
            snakemake.input.registration,
            snakemake.input.scans,
            snakemake.input.hulls,
            snakemake.input.selection,
            [snakemake.input[name] for name in ("registering", "hulling", "ordering")],
            snakemake.output.steps,
            n_selected=snakemake.params.n_selected,
        )
