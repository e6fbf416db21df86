"""Plans of realistic buildings and real floors by any commit, against what is true of them.

`run` makes and scores them: the recordings once, the plans with the code of a commit; a table of
measures and one of elements, and a page with a picture of every floor.
"""

from collections.abc import Sequence
from pathlib import Path

import guard

from realistic import comparing, floors, page, plans, recordings, scoring, summary

SCORES = "scores"
"""Folder of the tables and pages of runs, one below it by commit and words."""
_LONGEST = 200  # of a name that any file system takes


def run(project: Path, data: Path, folder: Path, revision: str, words: Sequence[str]) -> None:
    """Score the plans of floors by the code of a commit.

    Parameters
    ----------
    project : Path
        The checkout that the commit is taken from.
    data : Path
        Folder with the real recordings; where it is missing only drives are measured.
    folder : Path
        For recordings, results and scores; kept.
    revision : str
        Any name that git knows the commit by.
    words : sequence of str
        See `floors.choose_floors`; words with an equals sign are settings that all plans are made
        with, as `plan.merge.min_scans=3`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    settings = [word for word in words if "=" in word]
    chosen = floors.choose_floors(data, [word for word in words if word not in settings])
    recorded = recordings.record_floors(chosen, folder)
    results = plans.make_plans(project, revision, folder, recorded, settings)
    measures, elements = scoring.score_floors(chosen, recorded, results)
    title = "+".join([guard.name_commit(project, revision)[:12], *words])
    home = folder / SCORES / title[:_LONGEST]
    home.mkdir(parents=True, exist_ok=True)
    for name, table in (("measures", measures), ("elements", elements)):
        table.to_parquet(home / f"{name}.parquet", index=False)
    measures.to_csv(home / "measures.csv", index=False)
    elements.drop(columns="geometry", errors="ignore").to_csv(home / "elements.csv", index=False)
    truths = {
        floor.name: scoring.read_true_features(recorded[floor.name], _drawing(floor, folder))
        for floor in chosen
        if not recorded[floor.name].failed
    }
    page.write_page(home / "index.html", f"Plans of {title}", measures, elements, truths)
    (home / "summary.md").write_text(summary.format_tables(measures), encoding="utf-8")
    summary.print_summary(measures)
    print(f"realistic: {home / 'index.html'}", flush=True)


def compare(before: Path, after: Path) -> None:
    """Print what changed between the scores of two commits, element by element."""
    comparing.compare(before, after)


def _drawing(floor: floors.Floor, folder: Path) -> Path | None:
    return folder / f"surveys/{floor.name}.geojson" if floor.drive else None
