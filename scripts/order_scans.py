"""Put the scans in the order in which they are worth most for the plan."""

import json
from collections.abc import Mapping
from typing import Any

from scanplan.errors import StageError
from scanplan.selection import orderings, stopping
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import Columns, FilePath

_SCHEMAS = {
    "observations": schemas.OBSERVATIONS,
    "visibility": schemas.VISIBILITY,
    "registration": schemas.REGISTRATION,
}


def order_scans(
    scans: FilePath,
    output: FilePath,
    *,
    method: str,
    hulls: FilePath | None = None,
    seed: int | None = None,
    min_overlap: float = 0.0,
    streaming: Mapping[str, Any] | None = None,
    budget: Mapping[str, int | None] | None = None,
    others: Mapping[str, FilePath] | None = None,
) -> None:
    """Write the table of one method's ordering.

    Parameters
    ----------
    scans : path-like
        scans.parquet.
    output : path-like
        selection/<method>.parquet, to write.
    method : str
        One of `methods.METHODS`.
    hulls : path-like, optional
        hulls.parquet, to measure the area that the order covers; methods that need it state so.
    seed, min_overlap, streaming, budget
        Those of them that `methods.METHODS` names for the method, see `orderings.order_scans`;
        `budget` are keywords of `stopping.points_budget`.
    others : dict of str to path-like, optional
        The tables that `methods.METHODS` names for the method.
    """
    store = tables.ScanStore(scans)
    columns = _read_scans(store) if hulls is None else _read_hulls(hulls)
    other_tables = {
        name: tables.read_table(path, _SCHEMAS[name], allow_empty=True)
        for name, path in (others or {}).items()
    }
    selection = orderings.order_scans(
        method,
        columns,
        others=other_tables,
        seed=seed,
        min_overlap=min_overlap,
        streaming_settings=streaming,
        budget=stopping.points_budget(**(budget or {})),
    )
    if selection["covered_m2"][-1] == 0:
        raise StageError(
            f"{hulls}: {len(selection['rank'])} scans cover 0 m2, more is needed to order them;"
            " every cluster of their points lies on one line: use fewer clusters (n_clusters) or"
            " check the recording"
        )
    notes = {"planar": json.dumps(store.planar)}
    tables.write_table(output, schemas.SELECTION, selection, notes=notes)
    log.log_line(f"order_scans: {orderings.summarise_order(method, selection)}")


def _read_scans(store: tables.ScanStore) -> Columns:
    return {"scan_id": store.scan_ids, "n_points": store.n_points}


def _read_hulls(path: FilePath) -> Columns:
    return tables.read_table(path, schemas.HULLS, ["scan_id", "cluster", "n_points", "geometry"])


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        order_scans(
            snakemake.input.scans,
            snakemake.output.selection,
            hulls=snakemake.input.get("hulls"),
            method=snakemake.wildcards.method,
            **snakemake.params.settings,
            others={name: path for name, path in snakemake.input.items() if name in _SCHEMAS},
        )
