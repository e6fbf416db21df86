"""Scores of the bench's plans: a row of measures a floor, and a row for each element."""

import json
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import shapely

from realistic import peers, pictures, plans
from realistic.floors import Floor
from realistic.recordings import Recorded
from scanplan.errors import StageError
from scanplan.lab.evaluation.scores import score, score_files
from scanplan.lab.evaluation.truth_file import parse_features

_N_PROCESSES = 2  # of the machine that the bench is timed for


def score_floors(
    floors: Sequence[Floor], recorded: Mapping[str, Recorded], results: Path
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the measures of floors, a row each, and their elements.

    A floor without a plan, or without a recording, has a row that says in `failed` why.
    """
    if not peers.has_line_detector():
        print("realistic: no OpenCV (cv2) here, so no lines of raster and LSD", flush=True)
    with ProcessPoolExecutor(_N_PROCESSES, mp_context=get_context("spawn")) as pool:
        jobs = [pool.submit(_score, floor, recorded[floor.name], results) for floor in floors]
        done = [job.result() for job in jobs]
    rows = [row for row, _ in done]
    return pd.DataFrame(rows), stack_floors({str(r["floor"]): of for r, of in done if of})


def stack_floors(of_floors: Mapping[str, Mapping[str, Any]]) -> pd.DataFrame:
    """Return the elements of floors as one table: also `floor`, and `size` in m or m2."""
    none = pd.DataFrame(score.element_columns([])).assign(floor="")
    parts = [pd.DataFrame(columns).assign(floor=name) for name, columns in of_floors.items()]
    elements = pd.concat(parts, ignore_index=True) if parts else none
    return elements.assign(size=elements["length_m"].fillna(elements["area_m2"]).fillna(0.0))


def _score(
    floor: Floor, recorded: Recorded, results: Path
) -> tuple[dict[str, Any], Mapping[str, Any] | None]:
    named = ("name", "kind", "sensor", "half")
    row: dict[str, Any] = {key: value for key, value in asdict(floor).items() if key in named}
    row = {"floor": row.pop("name"), **row, "failed": recorded.failed}
    if recorded.failed:
        # what lies among the results is of an earlier recording
        return row, None
    costs = plans.stage_costs(results, floor.name)
    row |= {"failed": plans.last_words(results, floor.name)}
    row |= {"simulate_cpu_s": recorded.seconds, **costs}
    row["total_cpu_s"] = sum(v for k, v in costs.items() if k.endswith("_cpu_s") and v == v)
    if row["failed"]:
        return row, None
    try:
        placed = place_floor(results / floor.name, recorded)
        of_plan = score_files.score_results(placed)
        row |= of_plan.measures | peers.measure_peers(placed)
    except StageError as error:
        # one floor must not end the run of all
        return {**row, "failed": f"score: {error}"}, None
    return row, of_plan.elements


def place_floor(
    folder: Path, recorded: Recorded, *, with_points: bool = True
) -> score_files.Placed:
    """Place the results of a floor beside its truth, as its kind of truth asks for.

    Parameters
    ----------
    folder : Path
        results/<floor>.
    recorded : Recorded
    with_points : bool
        Whether what is missed is judged by points, too: seconds.
    """
    if recorded.true_poses is not None:
        return score_files.place_results(
            folder, recorded.truth, recorded.true_poses, with_points=with_points
        )
    if recorded.truth.suffix == ".npz":
        return score_files.place_results_by_raster(folder, recorded.truth)
    return score_files.place_results_by_hand(folder, recorded.truth)


def read_true_features(recorded: Recorded, building: Path | None) -> list[pictures.TrueFeature]:
    """Return what is true of a floor, and the furniture of its drawing, to be drawn."""
    if recorded.truth.suffix == ".npz":
        return _trace_rooms(recorded.truth)
    features = list(parse_features(recorded.truth))
    if building is not None:
        drawn = json.loads(building.read_text())["features"]
        features += [f for f in drawn if f["properties"]["kind"] == "furniture"]
    return [
        (f["properties"]["kind"], shapely.geometry.shape(f["geometry"]), f["properties"])
        for f in features
    ]


def _trace_rooms(truth: Path) -> list[pictures.TrueFeature]:
    """Return the rooms of a raster of labels as polygons of its rows."""
    from scanplan.lab.evaluation.scores import raster_truth

    scene = raster_truth.read_raster_scene(truth)
    return [("room", np.asarray(scene.rooms, object)[i], {}) for i in range(len(scene.rooms))]
