"""Measure every claim of the thesis on every seed."""

from scanplan.lab.thesis import judging
from scanplan.stage import log
from scanplan.store import schemas, tables

_SCHEMAS = {
    "walls": schemas.EVALUATION,
    "hull": schemas.SELECTION,
    "cluster_hull": schemas.SELECTION,
    "clusters": schemas.CLUSTERS,
    "areas": schemas.AREAS,
    "unevenness": schemas.UNEVENNESS,
    "times": schemas.TIMES,
    "poses": schemas.POSE_ERRORS,
    "steps": schemas.STEPS,
}


def judge_claims(files, output, *, rooms_seeds, drive_seeds):
    """Write what was measured for every claim, quantity by quantity, and whether the claim holds by it.

    Parameters
    ----------
    files : dict of str to list of path-like
        Tables by kind of survey and table, as `judging.judge_claims` calls them, seed by seed.
    output : path-like
        claims.parquet, to write.
    rooms_seeds, drive_seeds : list of int
        Of the files that begin with `rooms_`, and of the others.
    """
    rooms = _by_seed(files, rooms_seeds, ["rooms"])
    drive = _by_seed(files, drive_seeds, ["drive", "limits"])
    rows = []
    for kind, found in ((judging.ROOMS, rooms), (judging.DRIVE, drive)):
        rows += [
            row
            for seed, known in found.items()
            for row in judging.judge_claims(kind, f"seed {seed}", known)
        ]
    rows.sort(key=lambda row: (row["claim"], row["survey"], row["quantity"]))
    tables.write_table(
        output,
        schemas.CLAIMS,
        {name: [row[name] for row in rows] for name in schemas.CLAIMS.columns},
    )
    judged = {(row["claim"], row["survey"]): row["holds"] for row in rows if row["holds"]}
    log.log_line(
        f"judge_claims: {len(judged)} judgements, {list(judged.values()).count('yes')} of them yes"
    )


def _by_seed(files, seeds, kinds):
    return {
        seed: {
            key: tables.read_table(paths[i], _SCHEMAS[key.split("_", 1)[1]])
            for key, paths in files.items()
            if key.split("_")[0] in kinds
        }
        for i, seed in enumerate(seeds)
    }


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        judge_claims(
            {key: list(paths) for key, paths in snakemake.input.items() if key != "code"},
            snakemake.output.claims,
            rooms_seeds=snakemake.params.rooms_seeds,
            drive_seeds=snakemake.params.drive_seeds,
        )
