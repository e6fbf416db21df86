"""A long drive simulated: rays a second, cast and written, and memory."""

import copy
import os
import tempfile
import threading
import time
from pathlib import Path

import simulate_survey

N_SCANS = 6_000
_THREADS = 2
_KIB = 1024


def bench(root, settings):
    """Print rays a second and peak memory of simulating a 10 Hz VLP-16 along the hallways of ring_office.

    Parameters
    ----------
    root : pathlib.Path
        The project.
    settings : dict
        The whole configuration.
    """
    # 107 m of hallway
    rig = hallways(settings, speed_m_s=107 / (N_SCANS / 10))
    with tempfile.TemporaryDirectory() as folder:
        names = ("survey.bag", "truth.geojson", "truth_poses.tum", "truth_trajectory.tum")
        files = [Path(folder, name) for name in names]
        before, most = time.perf_counter(), _Most()
        simulate_survey.simulate_survey(
            root / "config/buildings/ring_office.geojson", *files, **rig, threads=_THREADS
        )
        seconds = time.perf_counter() - before
        n, size = len(files[2].read_text().splitlines()), files[0].stat().st_size
    rays = n * 1800 * 16
    print(
        f"simulation: {n:,} scans, {size / 1e9:.1f} GB in {seconds:.1f} s: {rays / seconds / 1e6:.1f} million rays a"
        f" second, cast and written on {_THREADS} cores; peak memory {most.stop() / 1e6:.0f} MB with both workers",
        flush=True,
    )


def hallways(settings, *, speed_m_s, **localiser):
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
    chosen["sensor"] |= {"n_azimuth": 1800, "sweep": True}
    chosen["drive"] |= {"speed_m_s": speed_m_s}
    chosen["site"] |= {"route": "hallways"}
    chosen["localiser"] |= localiser
    return {key: value for key, value in chosen.items() if key not in ("building", "recording")}


class _Most:
    """The most memory that this process and its children have held at once, looked at twice a second."""

    def __init__(self):
        self._bytes, self._ended = 0, threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()

    def stop(self):
        self._ended.set()
        self._thread.join()
        return self._bytes

    def _watch(self):
        while not self._ended.wait(0.5):
            held = sum(map(_private_bytes, [os.getpid(), *_children(os.getpid())]))
            self._bytes = max(self._bytes, held)


def _children(pid):
    return [
        int(child)
        for task in Path(f"/proc/{pid}/task").iterdir()
        for child in (task / "children").read_text().split()
    ]


def _private_bytes(pid):
    """Memory that a process alone holds; libraries that several share count for none."""
    try:
        rows = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:]
    except OSError:
        return 0
    return _KIB * sum(
        int(row.split()[1]) for row in rows if row.startswith(("Private_", "Pss_Shmem"))
    )
