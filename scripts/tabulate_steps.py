"""Tabulate time, scans and data after each step from recording to subset (thesis, table 5.1)."""

from pathlib import Path

import numpy as np

from scanplan.lab.evaluation import run_times
from scanplan.stage import log
from scanplan.store import schemas, tables, tum


def tabulate_steps(recordings, true_poses, scans, built, selection, times, output, *, n_selected):
    """Write the table; its run times differ from run to run.

    Parameters
    ----------
    recordings : list of path-like
    true_poses, scans, built, selection : path-like
        truth_poses.tum (a pose per recorded scan), scans.parquet, hulls.parquet and an ordering.
    times : list of list of path-like
        The benchmark files of the last three steps, those of a step together.
    output : path-like
        thesis/steps.parquet, to write.
    n_selected : int
        Size of the subset.
    """
    t_ns, _ = tum.read_tum(true_poses)
    hulls = tables.read_table(built, schemas.HULLS, ["scan_id", "cluster", "n_points"])
    chosen = tables.read_table(selection, schemas.SELECTION, ["rank", "scan_id"])["scan_id"][
        :n_selected
    ]
    # points take the same room wherever they are in the table
    share = hulls["n_points"][np.isin(hulls["scan_id"], chosen)].sum() / hulls["n_points"].sum()
    kept = len(np.unique(hulls["scan_id"]))
    n_bytes = [
        sum(Path(file).stat().st_size for file in recordings),
        _size(scans),
        _size(built),
        share * _size(scans),
    ]
    rows = {
        "step": np.arange(1, 5),
        "name": [
            "Data collection",
            "Selecting and registering scans",
            "Hull creation",
            "Cluster subset selection",
        ],
        "seconds": np.array(
            [
                (t_ns[-1] - t_ns[0]) / 1e9,
                *(sum(map(run_times.read_job_seconds, files)) for files in times),
            ]
        ),
        "n_scans": np.array([len(t_ns), kept, kept, len(chosen)]),
        "n_bytes": np.array(n_bytes).astype(np.int64),
    }
    tables.write_table(output, schemas.STEPS, rows)
    log.log_line(f"tabulate_steps: {len(t_ns):,} scans, {kept} registered, {len(chosen)} selected")


def _size(path):
    return Path(path).stat().st_size


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        tabulate_steps(
            *(
                snakemake.input[name]
                for name in ("recordings", "true_poses", "scans", "hulls", "selection")
            ),
            [snakemake.input[name] for name in ("registering", "hulling", "ordering")],
            snakemake.output.steps,
            n_selected=snakemake.params.n_selected,
        )
