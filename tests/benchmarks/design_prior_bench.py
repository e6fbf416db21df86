"""What a design is worth as a prior of the plan: plans with it and without, of cut drives, too."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

import assemble_plan
from scanplan.errors import StageError
from scanplan.lab.evaluation.scores import score_files
from scanplan.plan import planning
from scanplan.project import stage_settings
from scanplan.selection import stopping
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import IntArray, Settings

_SHARES = (1.0, 0.5, 0.25)  # of a drive: a prior ought to tell most where little was seen
_MEASURES = {
    "wall_completeness_005": "walls",
    "room_iou": "rooms IoU",
    "windows_recall": "windows",
    "doors_seen_recall": "doors",
    "opening_type_right": "types right",
}
"""Those that are printed, with the heads of their columns."""
_TABLES = {"registration.parquet": schemas.REGISTRATION, "plan/segments.parquet": schemas.WALLS}


def print_table(folder: Path, designs: Mapping[str, Path], settings: Settings) -> None:
    """Print measures of plans with and without a design as a prior, then their means.

    Parameters
    ----------
    folder : Path
        With results/ of surveys; their plans are made anew in prior/, of whole drives and of parts.
    designs : dict of str to Path
        By the name of a survey.
    settings : dict
        Default settings.
    """
    rows: list[dict[str, str | float]] = []
    for name, design in designs.items():
        for share in _SHARES:
            cut = _cut_drive(folder, name, share, settings)
            for prior in ("without", "with"):
                given = design if prior == "with" else None
                which = {"survey": name, "of the drive": share, "prior": prior}
                rows.append(which | _measure(cut, given, settings))
    table = pd.DataFrame(rows).set_index(["survey", "of the drive", "prior"])
    print("plans with a design as a prior and without")
    print(table.to_string(float_format="{:.2f}".format, na_rep="-"))
    model = [designs[name].name for name in table.index.get_level_values("survey")]
    print()
    means = table.groupby([model, "prior"], sort=False).mean()
    print(means.to_string(float_format="{:.2f}".format))


def _cut_drive(folder: Path, name: str, share: float, settings: Settings) -> Path:
    """Write what a plan of the first part of a drive is made of; return its folder."""
    whole, cut = folder / "results" / name, folder / f"prior/{name}_{share:g}"
    (cut / "plan").mkdir(parents=True, exist_ok=True)
    for shared in ("scans.parquet", "survey"):
        (cut / shared).unlink(missing_ok=True)
        (cut / shared).symlink_to((whole / shared).resolve())
    registered = registered_scans.read_registered_scans(whole / "registration.parquet")
    kept = registered.t_ns <= np.quantile(registered.t_ns, share)
    known = registered.scan_ids[kept]
    stop = stage_settings.select_section(settings, "selection", "stop")
    chosen, _ = stopping.read_chosen_scans(_selection(whole), **stop)
    _selection(cut).parent.mkdir(exist_ok=True)
    chosen = np.intersect1d(chosen, known)
    _copy_scans(_selection(whole), _selection(cut), schemas.SELECTION, chosen)
    for table, schema in _TABLES.items():
        _copy_scans(whole / table, cut / table, schema, known)
    return cut


def _selection(results: Path) -> Path:
    return results / "selection/wall_length.parquet"


def _copy_scans(source: Path, target: Path, schema: schemas.Schema, scan_ids: IntArray) -> None:
    """Copy the rows of some scans of a table."""
    columns = tables.read_table(source, schema, allow_empty=True)
    is_of_these = np.isin(columns["scan_id"], scan_ids)
    rows = {name: values[is_of_these] for name, values in columns.items()}
    notes = tables.read_notes(source, schema)
    tables.write_table(target, schema, rows, allow_empty=True, notes=notes)


def _measure(cut: Path, design: Path | None, settings: Settings) -> dict[str, float]:
    outputs = {table: cut / f"plan/{table}.parquet" for table in planning.TABLES}
    try:
        assemble_plan.assemble_plan(
            cut / "plan/segments.parquet",
            _selection(cut),
            cut / "scans.parquet",
            cut / "registration.parquet",
            outputs,
            settings=stage_settings.select_plan(settings),
            design=design,
        )
    except StageError as fault:
        # a part of a drive may fit no storey, or no one of several
        print(f"design, {cut.name} with {design}: refused, {fault}"[:150])
        return dict.fromkeys(_MEASURES.values(), np.nan)
    measures = score_files.score_results(score_files.place_results(cut)).measures
    return {label: float(measures[name]) for name, label in _MEASURES.items()}
