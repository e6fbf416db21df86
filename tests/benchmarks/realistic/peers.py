"""What simpler methods make of the same scans: rooms of a watershed, lines of a raster."""

import importlib.util
import time
from typing import TYPE_CHECKING

import walls_bench
import watershed_rooms

from scanplan.lab.evaluation.scores import score_files
from scanplan.rays import ray_set
from scanplan.store import registered_scans, tables

if TYPE_CHECKING:
    from scanplan.lab.evaluation.scores.score_files import Placed

_OF_ROOMS = ("room_iou", "rooms_above_08_share", "bormann_recall", "bormann_precision")
_OF_LINES = ("wall_correctness_010", "wall_completeness_010")


def has_line_detector() -> bool:
    """Return whether OpenCV is installed, which finds lines in a raster (LSD)."""
    return importlib.util.find_spec("cv2") is not None


def measure_peers(placed: "Placed") -> dict[str, float]:
    """Return measures of peers by name, of all scans that were registered."""
    store = tables.ScanStore(placed.folder / "scans.parquet")
    file = placed.folder / "registration.parquet"
    registered = registered_scans.read_registered_scans(file, store)
    places_m = registered.map_from_sensor[:, :3, 3]
    sensors_m = dict(zip(registered.scan_ids.tolist(), places_m, strict=True))
    started = time.process_time()
    rays = ray_set.gather_rays(store.scans(registered.scan_ids), sensors_m, planar=store.planar)
    rooms = watershed_rooms.find_watershed_rooms(rays)
    took_s = time.process_time() - started
    score = score_files.score_peer_rooms(placed, rooms)
    found = {f"watershed_{name}": score.measures[name] for name in _OF_ROOMS}
    found["watershed_cpu_s"] = took_s
    if has_line_detector() and placed.scene.is_whole:
        lines_m = walls_bench.raster_lines(list(store.scans()), planar=store.planar)
        score = score_files.score_peer_lines(placed, lines_m)
        found |= {f"lsd_{name}": score.measures[name] for name in _OF_LINES}
    return found
