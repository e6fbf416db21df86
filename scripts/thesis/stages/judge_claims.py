"""Measure every claim of the thesis on every seed."""

from collections.abc import Mapping, Sequence

import pandas as pd

from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath
from thesis import judging, thesis_schemas

_SCHEMAS = {
    "walls": schemas.EVALUATION,
    "hull": schemas.SELECTION,
    "cluster_hull": schemas.SELECTION,
    "clusters": thesis_schemas.CLUSTERS,
    "areas": thesis_schemas.AREAS,
    "unevenness": thesis_schemas.UNEVENNESS,
    "premises": thesis_schemas.PREMISES,
    "times": thesis_schemas.TIMES,
    "candidates": thesis_schemas.CANDIDATES,
    "poses": schemas.POSE_ERRORS,
    "steps": thesis_schemas.STEPS,
}


def judge_claims(
    files: Mapping[str, Sequence[FilePath]],
    output: FilePath,
    *,
    rooms_seeds: Sequence[int],
    drive_seeds: Sequence[int],
) -> None:
    """Write what was measured for every claim by quantity, and whether the claim holds by it.

    Parameters
    ----------
    files : dict of str to list of path-like
        Tables by kind of survey and table, as `judging.judge_claims` calls them, seed by seed.
    output : path-like
        claims.parquet, to write.
    rooms_seeds, drive_seeds : list of int
        Of the files that begin with `rooms_`, and of the others.
    """
    rooms = {name: paths for name, paths in files.items() if name.startswith("rooms_")}
    drives = {name: paths for name, paths in files.items() if not name.startswith("rooms_")}
    rows = []
    for kind, of_kind, seeds in (
        (judging.ROOMS, rooms, rooms_seeds),
        (judging.DRIVE, drives, drive_seeds),
    ):
        for i, seed in enumerate(seeds):
            rows += judging.judge_claims(kind, f"seed {seed}", _read_tables(of_kind, i))
    claims = pd.DataFrame(rows).sort_values(list(thesis_schemas.CLAIMS.sorted_by))
    tables.write_table(output, thesis_schemas.CLAIMS, claims.to_dict("list"))
    judged = claims[claims["holds"] != ""].drop_duplicates(["claim", "survey"])["holds"]
    log.log_line(f"judge_claims: {len(judged)} judgements, {(judged == 'yes').sum()} of them yes")


def _read_tables(files: Mapping[str, Sequence[FilePath]], i: int) -> dict[str, pd.DataFrame]:
    """Read the tables of the i-th seed; the thesis's limits have one of the first alone."""
    return {
        name: pd.DataFrame(tables.read_table(paths[i], _SCHEMAS[name.split("_", 1)[1]]))
        for name, paths in files.items()
        if i < len(paths)
    }


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        judge_claims(
            {key: list(paths) for key, paths in snakemake.input.items()},
            snakemake.output.claims,
            rooms_seeds=snakemake.params.rooms_seeds,
            drive_seeds=snakemake.params.drive_seeds,
        )
