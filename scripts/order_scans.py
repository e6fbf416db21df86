"""Put the scans in the order in which they are worth most for the plan."""

from scanplan.errors import StageError
from scanplan.selection import orderings, stopping
from scanplan.stage import log
from scanplan.store import schemas, tables

_SCHEMAS = {
    "observations": schemas.OBSERVATIONS,
    "visibility": schemas.VISIBILITY,
    "registration": schemas.REGISTRATION,
}


def order_scans(
    hulls, output, *, method, seed=None, min_overlap=0.0, streaming=None, budget=None, others=None
):
    """Write the table of one method's ordering.

    Parameters
    ----------
    hulls : path-like
        hulls.parquet.
    output : path-like
        selection/<method>.parquet, to write.
    method : str
        One of `methods.METHODS`.
    seed, min_overlap, streaming, budget
        Those of them that `methods.SETTINGS` names for the method, see `orderings.order_scans`;
        `budget` are keywords of `stopping.points_budget`.
    others : dict of str to path-like, optional
        The tables that `methods.TABLES` names for the method.
    """
    columns = tables.read_table(
        hulls, schemas.HULLS, ["scan_id", "cluster", "n_points", "geometry"]
    )
    read = {
        name: tables.read_table(path, _SCHEMAS[name], allow_empty=True)
        for name, path in (others or {}).items()
    }
    limit = stopping.points_budget(**(budget or {}))
    settings = {
        "seed": seed,
        "min_overlap": min_overlap,
        "streaming_settings": streaming,
        "budget": limit,
    }
    selection = orderings.order_scans(method, columns, others=read, **settings)
    if selection["covered_m2"][-1] == 0:
        raise StageError(
            f"{hulls}: {len(selection['rank'])} scans cover 0 m2, more is needed to order them; every cluster of their"
            " points lies on one line: use fewer clusters (n_clusters) or check the recording"
        )
    tables.write_table(output, schemas.SELECTION, selection)
    log.log_line(f"order_scans: {orderings.summarise_order(method, selection)}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        order_scans(
            snakemake.input.hulls,
            snakemake.output.selection,
            method=snakemake.wildcards.method,
            **snakemake.params.settings,
            others={name: path for name, path in snakemake.input.items() if name in _SCHEMAS},
        )
