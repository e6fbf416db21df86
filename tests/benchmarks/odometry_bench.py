"""Poses of drives with odometry alone, after one rigid motion, against the truth.

Drives of 200 and 600 m through ring_office come back to places they passed: twice round its
hallways, and through all its rooms and back. The real one is held against poses of others.
"""

import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from helpers import odometry_drives
from scanplan.lab.simulation import survey_setup
from scanplan.types import FloatArray, Settings

_ROUTES = {"200": "hallways", "600": "rooms"}
_MOST_M = {"2d": (0.05, 0.15), "3d": (0.03, 0.10)}
_SEEDS = (1, 2)
_REAL = "intel_odometry"
_REAL_MOST_M = 0.15  # of the median: some of the reference's own error


def drive_names() -> list[str]:
    """Return all drives: a length in metres, a sensor, a seed; and the real one."""
    simulated = [
        f"{metres}_{sensor}_{seed}" for metres in _ROUTES for sensor in _MOST_M for seed in _SEEDS
    ]
    return [*simulated, _REAL]


def bench(
    project: Path, settings: Settings, folder: Path, recordings: Path, names: Sequence[str]
) -> bool:
    """Print errors of the recorded and of the registered poses, and whether they are in bounds.

    Parameters
    ----------
    project : Path
    settings : dict
        The whole configuration.
    folder : Path
        Drives and tables are kept there.
    recordings : Path
        The folder with the real one.
    names : sequence of str
        See `drive_names`.

    Returns
    -------
    bool
        Whether all are in bounds.
    """
    are_good = [_measure(project, settings, folder, recordings, name) for name in names]
    return all(are_good)


def _measure(project: Path, settings: Settings, folder: Path, recordings: Path, name: str) -> bool:
    started_s = time.process_time()
    if name == _REAL:
        return _measure_real(recordings / _REAL, folder / name, started_s)
    metres, sensor, seed = name.split("_")
    building = project / "config/buildings/ring_office.geojson"
    way_m = _plan_way(building, settings, _ROUTES[metres], float(metres))
    bags = odometry_drives.record_drives(
        building, folder / name, [way_m.tolist()], sensor=sensor, seed=int(seed)
    )
    placed = odometry_drives.register_drive(bags, folder / name)
    truth = folder / name / "truth_poses.tum"
    kept = placed.kept
    recorded_m = odometry_drives.errors_m(placed.t_ns[kept], placed.recorded[kept], truth)
    off_m = odometry_drives.errors_m(placed.t_ns[kept], placed.world_from_sensor[kept], truth)
    is_good = bool((np.percentile(off_m, (50, 95)) <= _MOST_M[sensor]).all())
    print(
        f"odometry, {name}: odometry {_state(recorded_m)}, registered {_state(off_m)}"
        f" ({'within' if is_good else 'beyond'} {_MOST_M[sensor]} m); {_state_rest(placed)};"
        f" {time.process_time() - started_s:.0f} s of processor time",
        flush=True,
    )
    return is_good


def _measure_real(dataset: Path, folder: Path, started_s: float) -> bool:
    bags = [str(dataset / "intel.bag")]
    placed = odometry_drives.register_drive(bags, folder, input={"base_from_sensor": [0.0] * 6})
    kept = placed.kept
    off_m = odometry_drives.errors_m(
        placed.t_ns[kept],
        placed.world_from_sensor[kept],
        _sorted_copy(dataset / "reference.tum", folder / "reference.tum"),
        # the robot stood for longer than it takes to the next scan that is kept
        max_gap_s=5.0,
    )
    is_good = bool(np.median(off_m) <= _REAL_MOST_M)
    print(
        f"odometry, {_REAL}: registered {_state(off_m)} at {len(off_m)} reference poses"
        f" ({'within' if is_good else 'beyond'} {_REAL_MOST_M} m); {_state_rest(placed)};"
        f" {time.process_time() - started_s:.0f} s of processor time",
        flush=True,
    )
    return is_good


def _sorted_copy(reference: Path, copy: Path) -> Path:
    """Write reference poses in the order of their stamps, each stamp once."""
    stated = (row for row in reference.read_text().splitlines() if row.strip() and row[0] != "#")
    rows = {float(row.split()[0]): row for row in stated}
    copy.write_text("\n".join(rows[stamp] for stamp in sorted(rows)) + "\n")
    return copy


def _plan_way(building: Path, settings: Settings, route: str, metres: float) -> FloatArray:
    """Return a way there and back again, cut at a length."""
    simulated = settings["simulate"]
    chosen = simulated | {"site": simulated["site"] | {"route": route}}
    place = survey_setup.prepare_site(
        building.read_bytes(), building, chosen, seed=simulated["seed"]
    )
    once_m = np.asarray(place.waypoints_m)
    again_m = once_m if np.allclose(once_m[0], once_m[-1]) else once_m[::-1]
    way_m = np.vstack([once_m, again_m[1:]])
    gone_m = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way_m, axis=0).T))])
    return way_m[gone_m <= metres]


def _state(off_m: FloatArray) -> str:
    median_m, high_m = np.percentile(off_m, (50, 95))
    return f"{100 * median_m:.1f} cm in the median, 95 % within {100 * high_m:.1f} cm"


def _state_rest(placed: odometry_drives.Placed) -> str:
    told = "; ".join(placed.told) or "nothing"
    return f"{placed.kept.sum()} of {len(placed.kept)} scans kept, told: {told}"
