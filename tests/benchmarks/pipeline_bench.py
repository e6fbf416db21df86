"""The default target on long drives of a VLP-16: time, memory and bytes of every stage.

Drives go through all rooms of ring_office, ten scans a second. They are simulated once and kept.
Points take 32 bytes each, as drivers that write PCL's aligned points record them: 6,000 scans make
5.3 GB. The bags of the big drive, ten or as many as are asked for, hold clouds of 2/15 as many
points, of 22 bytes each: 6,000 scans make 0.5 GB. Their seconds are compared with those of the
first of them alone.
"""

import contextlib
import copy
import csv
import os
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import guard
import numpy as np

import simulate_survey
from scanplan.lab.simulation import scan_messages, survey_bag
from scanplan.types import Settings

_SPEED_M_S = 0.627  # through all rooms this makes 6,000 scans
_N_AZIMUTH = 1800  # of a VLP-16 at 10 Hz
_N_AZIMUTH_BIG = 240
_BAG_EVERY_NS = 3600 * 10**9  # from the start of one bag to that of the next
_BLOCK = 2**20  # bytes of a raw read
_ALIGNED = {"x": 0, "y": 4, "z": 8, "intensity": 16, "ring": 20, "time": 24}
_ALIGNED_SIZE = 32
# of a commit whose default target makes more: the plan and its figures
_PLAN = ("plan/plan.svg", *(f"figures/{f}.svg" for f in ("registration", "scans", "walls")))


@dataclass(frozen=True)
class Stage:
    """What Snakemake measured of a stage; memory and bytes in MB, of all of its processes.

    It looks every half second, after 30 s every 30 s: processor time is that of the last look.
    """

    name: str
    seconds: float
    processor_s: float
    peak_mb: float
    read_mb: float
    written_mb: float


def bench(
    project: Path,
    settings: Settings,
    folder: Path,
    revisions: Sequence[str],
    *,
    n_big: int | None = None,
) -> None:
    """Print what the stages of the default target take on a drive, beside a raw read of its bags.

    Parameters
    ----------
    project : pathlib.Path
    settings : dict
        The whole configuration.
    folder : pathlib.Path
        For the drives, kept, and a checkout with results for each commit.
    revisions : list of str
        Commits that are measured before the last one of the project.
    n_big : int, optional
        Bags of a big drive, each of 6,000 scans: all of them are measured after the first alone.
    """
    drive = folder / (f"drives_{n_big}" if n_big else "drive")
    _simulate_drives(project, settings, drive, n_bags=n_big or 1, is_big=n_big is not None)
    before: dict[str, Stage] = {}
    if n_big:
        first = folder / "first_drive"
        first.mkdir(exist_ok=True)
        with contextlib.suppress(FileExistsError):
            (first / "drive_0.bag").symlink_to(drive / "drive_0.bag")
        before = {s.name: s for s in _run(project, "HEAD", folder, first)}
    for revision in (*revisions, "HEAD"):
        _read_raw(drive)
        for stage in _run(project, revision, folder, drive):
            if n_big and stage.name in before:
                _print_growth(stage, before[stage.name], n_big)


def _print_growth(whole: Stage, part: Stage, n_parts: int) -> None:
    seconds = whole.seconds / (n_parts * part.seconds)
    processor = whole.processor_s / (n_parts * max(part.processor_s, 0.01))
    print(f"pipeline:   {whole.name}: {seconds:.2f} of linear, processor {processor:.2f}")


def _simulate_drives(
    project: Path, settings: Settings, drive: Path, *, n_bags: int, is_big: bool
) -> None:
    rig = copy.deepcopy(settings["simulate"])
    rig["sensor"] |= {"n_azimuth": _N_AZIMUTH_BIG if is_big else _N_AZIMUTH}
    rig["drive"] |= {"speed_m_s": _SPEED_M_S}
    rig["site"] |= {"route": "rooms", "start_m": "random"}
    keywords = {k: v for k, v in rig.items() if k not in ("building", "recording", "seed")}
    building = project / "config/buildings/ring_office.geojson"
    truth = drive.with_name(f"{drive.name}_truth")
    for number in range(n_bags):
        bag = drive / f"drive_{number}.bag"
        if bag.exists():
            continue
        start_ns = survey_bag.EPOCH_NS + number * _BAG_EVERY_NS
        # beside the recording a truth would be evaluated, which no user's recording has
        files = [truth / f"{name}_{number}" for name in ("truth", "poses", "trajectory")]
        points = contextlib.nullcontext() if is_big else _aligned_points()
        with points:
            simulate_survey.simulate_survey(
                building,
                bag,
                *files,
                seed=1 + number,
                threads=2,
                start_ns=start_ns,
                **keywords,
            )


def _aligned_points() -> contextlib.AbstractContextManager[object]:
    packed = scan_messages.POINT_DTYPE
    names = list(_ALIGNED)
    aligned = np.dtype(
        {
            "names": names,
            "formats": [packed[name] for name in names],
            "offsets": list(_ALIGNED.values()),
            "itemsize": _ALIGNED_SIZE,
        }
    )
    return mock.patch.object(scan_messages, "POINT_DTYPE", aligned)


def _read_raw(drive: Path) -> None:
    started, before_s = time.perf_counter(), time.process_time()
    size = 0
    for bag in sorted(drive.iterdir()):
        with bag.open("rb", buffering=0) as file:
            while block := file.read(_BLOCK):
                size += len(block)
    print(
        f"pipeline: {drive.name}, {size / 1e9:.1f} GB, raw read:"
        f" {time.perf_counter() - started:.1f} s, processor"
        f" {time.process_time() - before_s:.1f} s",
        flush=True,
    )


def _run(project: Path, revision: str, folder: Path, drive: Path) -> list[Stage]:
    """Run the default target of a commit anew, print its stages and return them."""
    code = guard.check_out(project, revision, folder / revision)
    for made in ("results", "benchmarks", "logs"):
        shutil.rmtree(code / made, ignore_errors=True)
    targets = [] if revision == "HEAD" else [f"results/{drive.name}/{file}" for file in _PLAN]
    command = [sys.executable, "-m", "snakemake", "--cores", "2"]
    command += ["--config", f'dataset="{drive}"', "--", *targets]
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    # as `make run` has it: modules are compiled once
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    started, before = time.perf_counter(), _children_s()
    subprocess.run(command, cwd=code, env=environment, check=True)
    seconds, processor_s = time.perf_counter() - started, _children_s() - before
    stages = read_stages(code / "benchmarks" / drive.name)
    kept_mb = sum(f.stat().st_size for f in (code / "results").rglob("*") if f.is_file()) / 1e6
    for stage in sorted(stages, key=lambda stage: -stage.processor_s):
        print(
            f"pipeline:   {stage.name}: {stage.seconds:.1f} s, processor {stage.processor_s:.1f} s,"
            f" peak {stage.peak_mb:.0f} MB, read {stage.read_mb:.0f} MB, written"
            f" {stage.written_mb:.0f} MB"
        )
    print(
        f"pipeline: {drive.name}, {revision}: {seconds:.1f} s, processor {processor_s:.1f} s, peak"
        f" {max(stage.peak_mb for stage in stages):.0f} MB; {kept_mb:.0f} MB kept",
        flush=True,
    )
    return stages


def read_stages(folder: Path) -> list[Stage]:
    """Return what Snakemake measured of the stages of a dataset, by name."""
    return [_read_stage(path) for path in sorted(folder.glob("*.tsv"))]


def _read_stage(path: Path) -> Stage:
    with path.open() as file:
        row = next(csv.DictReader(file, delimiter="\t"))
    names = ("s", "cpu_time", "max_rss", "io_in", "io_out")
    # a stage that ended before it was looked at has no figures but its seconds
    numbers = [float(row[name]) if row[name] not in ("-", "NA") else 0.0 for name in names]
    return Stage(path.stem, *numbers)


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
