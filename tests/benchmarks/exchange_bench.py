"""What users of a plan's files rely on: words that can be read, ids that stay.

Plans of surveys that are registered already are made again with this code, and kept.
"""

import contextlib
import copy
import itertools
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

import assemble_plan
import extract_chosen_walls
import validate_plan
from scanplan.exports.data import element_ids
from scanplan.exports.data.element_ids import Elements
from scanplan.exports.sheet import composition, lettering
from scanplan.plan import floorplan_files, planning
from scanplan.plan.floorplan import FloorPlan
from scanplan.project import stage_settings
from scanplan.project.settings import merge_settings
from scanplan.types import BoolArray, Settings

CHANGES: list[dict[str, Any]] = [
    *({"selection": {"stop": {"area_share": v}}} for v in (0.96, 0.94, 0.97, 0.93, 0.90)),
    *({"plan": {"merge": {"tolerance_m": v}}} for v in (0.05, 0.07)),
    *({"plan": {"merge": {"max_angle_deg": v}}} for v in (8.0, 12.0)),
    {"plan": {"merge": {"merge_distance_m": 0.12}}},
    {"plan": {"openings": {"min_opening_m": 0.55}}},
    {"plan": {"openings": {"max_opening_m": 2.4}}},
    {"plan": {"rooms": {"min_area_m2": 1.2}}},
    {"building": {"max_door_m": 1.4}},
    {"building": {"door_height_m": 1.95}},
    {"walls": {"inlier_m": 0.045}},
    {"walls": {"max_gap_m": 0.45}},
    {"walls": {"min_length_m": 0.45}},
    {"building": {"max_thickness_m": 0.55}},
    {"seed": 2},
]
"""Changes of settings, one at a time, that leave a building what it is."""


def bench_sheets(results: Path, kept: Path, names: Sequence[str], settings: Settings) -> None:
    """Print how many words of each survey's sheet lie on another, and how high the least are.

    Parameters
    ----------
    results : Path
        Folder of the surveys' results.
    kept : Path
        Plans of this code are kept there.
    names : sequence of str
        Surveys; of all where none is named.
    settings : dict
        Default settings.
    """
    n_overlaps, least_mm = 0, np.inf
    for name in names or sorted(path.parent.name for path in results.glob("*/scans.parquet")):
        plan = make_plan(results / name, settings, kept / name, rate=True)
        sheet = composition.compose_sheet(plan)
        words = [*composition.paper_words(sheet)]
        boxes = [lettering.word_box(word) for word in words]
        n_met = sum(a.intersects(b) for a, b in itertools.combinations(boxes, 2))
        lowest_mm = min(word.size_mm for word in words)
        n_unnamed = sum(not stamp.words for stamp in sheet.stamps)
        print(
            f"sheets, {name}: {sheet.page.name} 1:{sheet.page.scale}, {len(words)} words,"
            f" {n_met} on another, letters of {lowest_mm} mm and more,"
            f" {len(sheet.stamps)} rooms, {n_unnamed} of them without a stamp",
            flush=True,
        )
        n_overlaps, least_mm = n_overlaps + n_met, min(least_mm, lowest_mm)
    print(f"sheets, all: {n_overlaps} words on another, letters of {least_mm} mm and more")


def bench_ids(results: Path, kept: Path, names: Sequence[str], settings: Settings) -> None:
    """Print the share of GlobalIds that stay over `CHANGES`, one after the other.

    Of all elements, of those that still exist - half of what they cover, with 0.1 m around, is
    covered by elements of their table - and of those that exist as elements of their own.
    Parameters as of `bench_sheets`.
    """
    for name in names:
        plan = make_plan(results / name, settings, kept / name / "unchanged")
        before = element_ids.list_elements(plan)
        ids = element_ids.identify_elements(before, element_ids.no_known(), name)
        known = element_ids.merge_known(before, ids, element_ids.no_known())
        counts = []
        for number, change in enumerate(CHANGES):
            changed = merge_settings(copy.deepcopy(settings), change)
            plan = make_plan(results / name, changed, kept / name / f"change_{number}")
            after = element_ids.list_elements(plan)
            ids_after = element_ids.identify_elements(after, known, name)
            known = element_ids.merge_known(after, ids_after, known)
            is_kept = np.isin(ids, ids_after)
            exists = find_existing(before, after)
            counts.append([len(ids), is_kept.sum(), exists.sum(), (is_kept & exists).sum()])
            print(
                f"ids, {name}, {change}: {is_kept.sum()} of {len(ids)} stay,"
                f" {(is_kept & exists).sum()} of {exists.sum()} that exist",
                flush=True,
            )
        n_all, n_kept, n_exist, n_kept_existing = np.sum(counts, axis=0)
        print(
            f"ids, {name}: {n_kept / n_all:.1%} of all, {n_kept_existing / n_exist:.1%} of the"
            f" {n_exist / n_all:.1%} that still exist"
        )


def find_existing(before: Elements, after: Elements) -> BoolArray:
    """Return which elements (n,) are at least half covered by later ones of their table."""
    tables, later_tables = map(element_ids.tables_of, (before.kinds, after.kinds))
    exists = np.zeros(len(tables), bool)
    for table in element_ids.KINDS:
        rows = np.flatnonzero(tables == table)
        ground = shapely.union_all(element_ids.grow_shapes(after.shapes[later_tables == table]))
        shapes = element_ids.grow_shapes(before.shapes[rows])
        covered = shapely.area(shapely.intersection(shapes, ground))
        exists[rows] = covered >= shapely.area(shapes) / 2
    return exists


def make_plan(results: Path, settings: Settings, kept: Path, *, rate: bool = False) -> FloorPlan:
    """Return the plan of a survey's chosen scans by some settings, made where it is not kept."""
    files = {table: kept / f"{table}.parquet" for table in planning.TABLES}
    if rate:
        files["confidence"] = kept / "confidence.parquet"
    if not all(path.exists() for path in files.values()):
        kept.mkdir(parents=True, exist_ok=True)
        with _silence():
            _make_tables(results, settings, kept, rate=rate)
    return floorplan_files.read_floorplan(files, results.name)


def _make_tables(results: Path, settings: Settings, kept: Path, *, rate: bool) -> None:
    method = settings["plan"]["method"]
    selection = results / f"selection/{method}.parquet"
    scans, registration = results / "scans.parquet", results / "registration.parquet"
    stop = stage_settings.select_section(settings, "selection", "stop")
    extractor = settings["plan"]["extractor"]
    extract_chosen_walls.extract_chosen_walls(
        scans,
        registration,
        selection,
        kept / "segments.parquet",
        extractor=extractor,
        settings=stage_settings.select_extractor(settings, extractor),
        stop=stop,
    )
    tables = {table: kept / f"{table}.parquet" for table in planning.TABLES}
    assemble_plan.assemble_plan(
        kept / "segments.parquet",
        selection,
        scans,
        registration,
        tables,
        settings=stage_settings.select_plan(settings),
        **stop,
    )
    if not rate:
        return
    validate_plan.validate_plan(
        tables | {"selection": selection, "scans": scans, "registration": registration},
        {
            "elements": kept / "validation.parquet",
            "rays": kept / "validation_rays.parquet",
            "confidence": kept / "confidence.parquet",
        },
        settings=stage_settings.select_validation(settings),
        **stop,
    )


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Leave out what stages say of their work."""
    with (
        contextlib.redirect_stdout(None),
        contextlib.redirect_stderr(None),
    ):
        yield
