"""A long drive simulated: rays a second, cast and written, and memory."""

import copy
import os
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import simulate_survey
from scanplan.types import Settings

N_SCANS = 6_000  # ten minutes at 10 Hz: memory must not grow with them
_HALLWAYS_M = 107  # length of ring_office's hallways
_N_AZIMUTH = 1800  # of a VLP-16 at 10 Hz
_N_BEAMS = 16  # of a VLP-16
_THREADS = 2  # the cores that the measured figures are stated for
_KIB = 1024  # bytes, the unit of /proc
_LOOK_S = 0.5  # shorter takes processor time from what is measured, longer misses peaks


def bench(root: Path, settings: Settings) -> None:
    """Print rays a second and peak memory of simulating a VLP-16 along ring_office's hallways.

    Parameters
    ----------
    root : pathlib.Path
        The project.
    settings : dict
        The whole configuration.
    """
    rig = hallway_rig(settings, speed_m_s=_HALLWAYS_M / (N_SCANS / 10))
    building = root / "config/buildings/ring_office.geojson"
    with tempfile.TemporaryDirectory() as folder:
        names = ("survey.bag", "truth.geojson", "truth_poses.tum", "truth_trajectory.tum")
        files = [Path(folder, name) for name in names]
        peak = _PeakMemory()
        started = time.perf_counter()
        simulate_survey.simulate_survey(building, *files, **rig, threads=_THREADS)
        seconds = time.perf_counter() - started
        n_scans = len(files[2].read_text().splitlines())
        size = files[0].stat().st_size
    rays = n_scans * _N_AZIMUTH * _N_BEAMS
    print(
        f"simulation: {n_scans:,} scans, {size / 1e9:.1f} GB in {seconds:.1f} s:"
        f" {rays / seconds / 1e6:.1f} million rays a second, cast and written on {_THREADS} cores;"
        f" peak memory {peak.stop() / 1e6:.0f} MB with both workers",
        flush=True,
    )


def hallway_rig(settings: Settings, *, speed_m_s: float, **localiser: float) -> dict[str, Any]:
    """Return the keywords of `simulate_survey` for a 10 Hz VLP-16 along hallways.

    Parameters
    ----------
    settings : dict
        The whole configuration.
    speed_m_s : float
    **localiser
        Instead of settings of `simulate.localiser`.
    """
    chosen = copy.deepcopy(settings["simulate"])
    chosen["sensor"] |= {"n_azimuth": _N_AZIMUTH, "sweep": True}
    chosen["drive"] |= {"speed_m_s": speed_m_s}
    chosen["site"] |= {"route": "hallways"}
    chosen["localiser"] |= localiser
    return {key: value for key, value in chosen.items() if key not in ("building", "recording")}


class _PeakMemory:
    """The most memory that this process and its children held at once, sampled from now on."""

    def __init__(self) -> None:
        self._bytes = 0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()

    def stop(self) -> int:
        """Return the bytes."""
        self._ended.set()
        self._thread.join()
        return self._bytes

    def _watch(self) -> None:
        while not self._ended.wait(_LOOK_S):
            held = sum(map(_private_bytes, [os.getpid(), *_children(os.getpid())]))
            self._bytes = max(self._bytes, held)


def _children(pid: int) -> list[int]:
    tasks = Path(f"/proc/{pid}/task").iterdir()
    return [int(child) for task in tasks for child in (task / "children").read_text().split()]


def _private_bytes(pid: int) -> int:
    """Return the memory that a process alone holds, without libraries that several share."""
    try:
        rows = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:]
    except OSError:
        return 0
    private = [row for row in rows if row.startswith(("Private_", "Pss_Shmem"))]
    return _KIB * sum(int(row.split()[1]) for row in private)
