"""One table of many datasets: what was found of each, how doubtful it is, and which failed."""

import math
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from scanplan.plan import floorplan, floorplan_files
from scanplan.report.templates import render_template
from scanplan.stage.run_times import read_job_costs
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath
from scanplan.validation.doubts import list_to_verify

MADE, FAILED, MISSING = "plan", "failed", "no plan"
"""What became of a dataset: it has a plan, a stage of it failed, it was not got to."""

_TEXTS = ("name", "state", "why")
_NUMBERS = (
    *("area_m2", "rooms", "open_rooms", "walls", "verify", "doors", "windows", "passages"),
    *("chosen", "registered", "candidates", "predicted", "seconds"),
)
_DRAWN = ("faces", "walls", "openings", "rooms", "free")
_CHECKED = ("confidence", "validation")


def gather_overview(
    results: FilePath,
    faults: Mapping[str, Sequence[str]],
    run_times: Mapping[str, Sequence[FilePath]],
    corrected: Collection[str] = (),
) -> pd.DataFrame:
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
    pandas.DataFrame
        Columns `name`, `state`, `why`, `area_m2`, `rooms`, `walls`, `doors`, `windows`, `passages`,
        `verify` (elements to verify on site, as the report lists them), `open_rooms`, `chosen`,
        `registered`, `candidates` (scans), `predicted` (share of rays of left-out scans), `seconds`
        (of all stages); NaN where unknown.
    """
    rows = [
        {
            "name": name,
            "why": "; ".join(told),
            "seconds": math.fsum(c.seconds for c in read_job_costs(run_times[name]).values()),
            **_describe_results(
                Path(results, name), told, "plan/corrected" if name in corrected else "plan"
            ),
        }
        for name, told in faults.items()
    ]
    overview = pd.DataFrame(rows, columns=[*_TEXTS, *_NUMBERS])
    overview = overview.astype(dict.fromkeys(_NUMBERS, float))
    return overview.sort_values("name", ignore_index=True)


def _describe_results(folder: Path, faults: Sequence[str], plan: str) -> dict[str, Any]:
    row: dict[str, Any] = {}
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


def _describe_plan(files: Mapping[str, Path]) -> dict[str, Any]:
    plan = floorplan_files.read_floorplan(files)
    validation = tables.read_table(files["validation"], schemas.VALIDATION, allow_empty=True)
    kinds = plan.openings["type"]
    return {
        "area_m2": float(plan.rooms["area_m2"].sum()),
        "rooms": len(plan.rooms["room"]),
        "open_rooms": int((~plan.rooms["closed"]).sum()),
        "walls": len(plan.walls["wall"]),
        "verify": len(list_to_verify(plan)),
        **{f"{kind}s": int((kinds == kind).sum()) for kind in floorplan.OPENINGS},
        "predicted": float(validation["share"][-1]),
    }


def write_overview(
    overview: pd.DataFrame, results: FilePath, page_sources: Mapping[str, str]
) -> tuple[Path, Path]:
    """Write summary.parquet and summary.html beside the datasets' folders, and return both.

    Parameters
    ----------
    overview : pandas.DataFrame
        See `gather_overview`.
    page_sources : dict of str to str
        The template `overview.html.j2` and what it takes in, see `templates.render_template`.
    """
    table, page = (Path(results, f"summary.{suffix}") for suffix in ("parquet", "html"))
    with atomic.replace_file(table) as temporary:
        overview.to_parquet(temporary, index=False)
    # what failed among hundreds is looked for first
    is_made = overview["state"] == MADE
    shown = pd.concat([overview[~is_made], overview[is_made]]).astype(object)
    text = render_template(
        page_sources,
        "overview.html.j2",
        rows=shown.where(shown.notna(), None).to_dict("records"),
        totals=overview[list(_NUMBERS)].sum().to_dict(),
        states=overview["state"].value_counts().to_dict(),
        made=MADE,
    )
    atomic.write_text(page, text)
    return table, page
