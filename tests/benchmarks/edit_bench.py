"""Ten minutes with the editor: a plan before and after what a person who knows it says.

What is said is written as the report's page writes it: lines that part rooms, and rooms that are
one, chosen by eye on a picture of plan and truth; then walls of the truth that the plan lacks, the
longest first. Forty things said are ten minutes.
"""

import json
import shutil
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from correct_plan import correct_plan
from scanplan.lab.evaluation.scores import score_files
from scanplan.plan import planning

_MOST = 40
_LEAST_M = 0.5  # of a wall that somebody would notice is not drawn
_MEASURES = (
    *("floorsp_room_f1", "room_iou", "bormann_recall", "bormann_precision"),
    *("wall_completeness_005", "wall_completeness_010", "hand_doors_true", "hand_doors_found"),
    *("room_n_wrong", "all_n_wrong"),
)


def _split(*line):
    return {"element": "room", "action": "split", "line": [list(end) for end in line]}


def _merge(at, other):
    return {"element": "room", "action": "merge", "at": list(at), "with": list(other)}


SAID = {
    "intel": [
        _split((4.1, 1.25), (7.15, 2.35)),
        _split((9.95, 0.1), (12.0, -2.15)),
        _split((13.35, -4.6), (13.85, -7.9)),
        _split((13.5, -4.55), (17.95, -4.4)),
        _split((-6.1, -18.4), (-2.6, -19.65)),
        _merge((10, -21), (13.3, -21.4)),
    ],
    "lab_ipa": [
        _split((18.25, 16.05), (20.25, 16.1)),
        _split((9.95, 20.9), (11.5, 20.9)),
        _merge((10.5, 24), (11, 29)),
        _split((11.95, 23.9), (11.95, 25.2)),
        _split((16.15, 14.5), (16.15, 16.05)),
        _merge((12.2, 24.5), (13.5, 24.3)),
        _merge((16.6, 15.2), (18, 15.2)),
    ],
}
"""Of floors by name, in the map frame of their plans."""


def measure_edits(results, truth, folder):
    """Print what a plan is worth before and after, and how much was said.

    Parameters
    ----------
    results : path-like
        results/intel or results/lab_ipa, without corrections.
    truth : path-like
        Drawn by hand (.geojson), or of a map (.npz).
    folder : path-like
        For the corrected plan; its corrections.yaml is what was said.
    """
    results, folder = Path(results), Path(folder)
    by_hand = Path(truth).suffix == ".geojson"
    place = score_files.place_results_by_hand if by_hand else score_files.place_results_by_raster
    placed = place(results, truth)
    before = score_files.score_results(placed)
    said = [*SAID[results.name], *_list_missing(placed, before)][:_MOST]
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "plan").mkdir(parents=True)
    file = folder / "corrections.yaml"
    file.write_text("corrections:\n" + "".join(f"- {json.dumps(entry)}\n" for entry in said))
    tables = {name: results / f"plan/{name}.parquet" for name in planning.TABLES}
    corrected = {name: folder / f"plan/{name}.parquet" for name in planning.TABLES}
    correct_plan(file, tables, corrected)
    shutil.copy(results / "plan/confidence.parquet", folder / "plan")
    shutil.copy(results / "registration.parquet", folder)
    after = score_files.score_results(replace(placed, folder=folder))
    counts = Counter(f"{entry['element']} {entry['action']}" for entry in said)
    print(f"{results.name}: {len(said)} things said: {dict(counts)}")
    for name in _MEASURES:
        was, is_now = (of.measures.get(name, np.nan) for of in (before, after))
        print(f"  {name:24} {was:7.3f} -> {is_now:.3f}")


def _list_missing(placed, score):
    """Yield walls of the truth that are not drawn, in the map frame, the longest first."""
    map_from_truth = np.linalg.inv(placed.motion)
    lines_m = placed.scene.inner_m @ map_from_truth[:2, :2].T + map_from_truth[:2, 3]
    rows = zip(*(score.elements[name] for name in ("table", "verdict", "true")), strict=True)
    missed = [true for table, verdict, true in rows if (table, verdict) == ("stretch", "missed")]
    lengths_m = {row: float(np.hypot(*np.diff(lines_m[row], axis=0)[0])) for row in missed}
    for row in sorted(missed, key=lambda row: -lengths_m[row]):
        if lengths_m[row] >= _LEAST_M:
            line = np.round(lines_m[row], 3).tolist()
            yield {"element": "wall", "action": "add", "line": line}
