"""What simpler methods make of the same scans: rooms of a watershed, lines of a raster."""

import importlib.util
import time
from pathlib import Path

import walls_bench
import watershed_rooms

from realistic.recordings import Recorded
from scanplan.lab.evaluation.scores import plan_scores, score_files
from scanplan.rays import ray_set
from scanplan.store import registered_scans, tables

_OF_ROOMS = ("room_iou", "rooms_above_08_share", "bormann_recall", "bormann_precision")
_OF_LINES = ("wall_correctness_010", "wall_completeness_010")


def measure_peers(folder: Path, recorded: Recorded) -> dict[str, float]:
    """Return measures of peers by name, of all scans that were registered.

    Parameters
    ----------
    folder : Path
        results/<floor>.
    recorded : recordings.Recorded
    """
    placed = score_files.place_results(folder, recorded.truth, recorded.true_poses)
    store = tables.ScanStore(folder / "scans.parquet")
    registered = registered_scans.read_registered_scans(folder / "registration.parquet", store)
    places_m = registered.map_from_sensor[:, :3, 3]
    sensors_m = dict(zip(registered.scan_ids.tolist(), places_m, strict=True))
    scans = store.scans(registered.scan_ids)
    started = time.process_time()
    rays = ray_set.gather_rays(scans, sensors_m, planar=store.planar)
    rooms = watershed_rooms.find_watershed_rooms(rays)
    took_s = time.process_time() - started
    score = plan_scores.score_plain_rooms(placed.move_shapes(rooms), placed.scene)
    found = {f"watershed_{name}": score.measures[name] for name in _OF_ROOMS}
    found["watershed_cpu_s"] = took_s
    if importlib.util.find_spec("cv2") and placed.scene.is_whole:
        lines_m = walls_bench.raster_lines(list(store.scans()), planar=store.planar)
        score = plan_scores.score_plain_lines(
            placed.move_lines(lines_m), placed.scene, placed.sight
        )
        found |= {f"lsd_{name}": score.measures[name] for name in _OF_LINES}
    return found
