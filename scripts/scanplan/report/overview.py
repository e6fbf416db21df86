"""One table of many datasets: what was found of each, how doubtful it is, and which failed."""

import math
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from scanplan.plan import floorplan, floorplan_files
from scanplan.report.templates import render_template
from scanplan.stage.run_times import read_job_costs
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath
from scanplan.validation.doubts import list_doubts

Row = dict[str, Any]

MADE, FAILED, MISSING = "plan", "failed", "no plan"
"""What became of a dataset: it has a plan, a stage of it failed, it was not got to."""

_NUMBERS = tuple(name for name, kind in schemas.OVERVIEW.columns.items() if kind == "float64")
_DRAWN = ("faces", "walls", "openings", "rooms", "free")
_CHECKED = ("confidence", "validation")


def gather_overview(
    results: FilePath,
    faults: Mapping[str, Sequence[str]],
    run_times: Mapping[str, Sequence[FilePath]],
    corrected: Collection[str] = (),
) -> list[Row]:
    """Gather a row for each dataset from its results.

    Parameters
    ----------
    results : path-like
        The folder with a folder for each dataset.
    faults : dict of str to sequence of str
        Name of every dataset to what its stages ended with in this run; empty where none failed.
    run_times : dict of str to sequence of path-like
        Name of every dataset to what Snakemake measured of its stages.
    corrected : collection of str
        Those whose plans have corrections.

    Returns
    -------
    list of dict
        By name, the columns of `schemas.OVERVIEW`: NaN where unknown.
    """
    return [
        {
            **dict.fromkeys(_NUMBERS, math.nan),
            "name": name,
            "why": "; ".join(told),
            "seconds": math.fsum(c.seconds for c in read_job_costs(run_times[name]).values()),
            **_describe_results(
                Path(results, name), told, "plan/corrected" if name in corrected else "plan"
            ),
        }
        for name, told in sorted(faults.items())
    ]


def _describe_results(folder: Path, faults: Sequence[str], plan: str) -> Row:
    row: Row = {}
    if (folder / "registration.parquet").exists():
        kept = tables.read_table(folder / "registration.parquet", schemas.REGISTRATION)["kept"]
        row |= {"registered": int(kept.sum()), "candidates": len(kept)}
    files = {table: folder / plan / f"{table}.parquet" for table in _DRAWN}
    files |= {table: folder / "plan" / f"{table}.parquet" for table in _CHECKED}
    # of a run that was interrupted there may be tables alone, and the page leads to both of these
    pages = (folder / "plan/plan.svg", folder / "report.html")
    is_made = all(file.exists() for file in (*files.values(), *pages))
    row["state"] = FAILED if faults else MADE if is_made else MISSING
    if is_made:
        row |= _describe_plan(files)
        left_out = tables.read_note(files["validation"], schemas.VALIDATION, "n_left_out")
        row["chosen"] = row["registered"] - int(left_out)
    return row


def _describe_plan(files: Mapping[str, Path]) -> Row:
    plan = floorplan_files.read_floorplan(files)
    validation = tables.read_table(files["validation"], schemas.VALIDATION, allow_empty=True)
    kinds = plan.openings["type"]
    return {
        "area_m2": float(plan.net_areas_m2.sum()),
        "rooms": len(plan.rooms["room"]),
        "open_rooms": int((~plan.rooms["closed"]).sum()),
        "walls": len(plan.walls["wall"]),
        "verify": len(list_doubts(plan)),
        **{f"{kind}s": int((kinds == kind).sum()) for kind in floorplan.OPENINGS},
        "predicted": float(validation["share"][-1]),
    }


def write_overview(
    overview: Sequence[Row], results: FilePath, page_sources: Mapping[str, str]
) -> tuple[Path, Path]:
    """Write summary.parquet and summary.html beside the datasets' folders, and return both.

    Parameters
    ----------
    overview : sequence of dict
        See `gather_overview`.
    page_sources : dict of str to str
        The template `overview.html.j2` and what it takes in, see `templates.render_template`.
    """
    table, page = (Path(results, f"summary.{suffix}") for suffix in ("parquet", "html"))
    columns = {column: [row[column] for row in overview] for column in schemas.OVERVIEW.columns}
    tables.write_table(table, schemas.OVERVIEW, columns)
    text = render_template(
        page_sources,
        "overview.html.j2",
        # what failed among hundreds is looked for first
        rows=[_blank_unknown(row) for row in sorted(overview, key=lambda r: r["state"] == MADE)],
        totals={n: math.fsum(row[n] for row in overview if row[n] == row[n]) for n in _NUMBERS},
        states=dict(Counter(row["state"] for row in overview).most_common()),
        made=MADE,
    )
    atomic.write_text(page, text)
    return table, page


def _blank_unknown(row: Row) -> Row:
    return {name: None if value != value else value for name, value in row.items()}
