"""Recordings of the catalogue's drives, made once by the simulator of this checkout, and kept.

Every commit that is measured reads the same bytes, whatever its own simulator does.
"""

import contextlib
import hashlib
import io
import json
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import catalogue
import yaml

import simulate_survey
from helpers.default_settings import SETTINGS
from realistic.floors import Floor
from scanplan.errors import StageError
from scanplan.project import code_files, stage_settings
from scanplan.project.settings import merge_settings

_SCRIPT = simulate_survey.__file__
_N_PROCESSES = 2  # of the machine that the bench is timed for


@dataclass(frozen=True)
class Recorded:
    """The files of a floor's recording.

    Attributes
    ----------
    dataset : Path
        The folder that the workflow is given.
    truth : Path
        GeoJSON, or of a map its cells.
    true_poses : Path or None
        Of a simulated drive.
    seconds : float
        Processor time that simulating took; NaN of a real one.
    failed : str
        Why it could not be simulated, so that none of the files need be there; else "".
    """

    dataset: Path
    truth: Path
    true_poses: Path | None
    seconds: float = float("nan")
    failed: str = ""


def record_floors(floors: Sequence[Floor], folder: Path) -> dict[str, Recorded]:
    """Simulate the drives that are missing or out of date; return the recordings by floor.

    A drive whose simulation fails ends no other's: its recording says why, and the next run tries
    again.
    """
    drives = [floor.drive for floor in floors if floor.drive]
    waiting = [drive for drive in drives if not _is_current(drive, folder)]
    failed: dict[str, str] = {}
    if waiting:
        with ProcessPoolExecutor(_N_PROCESSES, mp_context=get_context("spawn")) as pool:
            jobs = [pool.submit(_simulate, drive, folder) for drive in waiting]
            for done, (drive, job) in enumerate(zip(waiting, jobs, strict=True), 1):
                made = job.result()
                words = f"simulated {drive.name} in {made} s"
                if isinstance(made, str):
                    failed[drive.name] = made
                    words = f"no recording of {drive.name}: {made}"
                print(f"realistic: {words} ({done} of {len(waiting)})", flush=True)
    return {floor.name: _find_files(floor, folder, failed.get(floor.name, "")) for floor in floors}


def _find_files(floor: Floor, folder: Path, failed: str) -> Recorded:
    if floor.drive is None:
        assert floor.recording is not None and floor.truth is not None
        return Recorded(floor.recording, floor.truth, None)
    truth = folder / "truths" / floor.name
    made = {} if failed else json.loads((truth / "made.json").read_text())
    return Recorded(
        folder / "recordings" / floor.name,
        truth / "truth.geojson",
        truth / "truth_poses.tum",
        made.get("seconds", float("nan")),
        failed,
    )


def _is_current(drive: catalogue.Drive, folder: Path) -> bool:
    made = folder / "truths" / drive.name / "made.json"
    survey = catalogue.write_survey(drive, folder / "surveys")
    return made.is_file() and json.loads(made.read_text())["digest"] == _digest(survey)


def _digest(survey: Path) -> str:
    """Return what names a recording: its survey and building, and the code that simulates."""
    total = hashlib.sha256(code_files.digest_helpers(_SCRIPT).encode())
    settings = yaml.safe_load(survey.read_text())
    building = Path(settings["simulate"].pop("building"))
    total.update(json.dumps(settings, sort_keys=True).encode())
    total.update(building.read_bytes())
    return total.hexdigest()[:16]


def _simulate(drive: catalogue.Drive, folder: Path) -> float | str:
    """Write a drive's dataset folder and its truth.

    Return the processor seconds that it took, or what it failed of.
    """
    survey = catalogue.write_survey(drive, folder / "surveys")
    dataset, truth = folder / "recordings" / drive.name, folder / "truths" / drive.name
    for place in (dataset, truth):
        place.mkdir(parents=True, exist_ok=True)
    # files of an attempt that fails are those of no digest
    (truth / "made.json").unlink(missing_ok=True)
    started = time.process_time()
    try:
        _run_simulation(survey, dataset, truth)
    except StageError as error:
        return f"simulate: {error}"
    except Exception as error:  # whatever the fault, the other drives can be measured
        return f"simulate: {type(error).__name__}: {error}"
    seconds = round(time.process_time() - started, 2)
    (truth / "made.json").write_text(json.dumps({"digest": _digest(survey), "seconds": seconds}))
    return seconds


def _run_simulation(survey: Path, dataset: Path, truth: Path) -> None:
    """Simulate a survey's file into the folders of its recording and its truth."""
    own = yaml.safe_load(survey.read_text())
    settings = merge_settings(SETTINGS, own)
    # its progress would mix with that of the other process
    with contextlib.redirect_stdout(io.StringIO()):
        simulate_survey.simulate_survey(
            settings["simulate"]["building"],
            dataset / "survey.bag",
            truth / "truth.geojson",
            truth / "truth_poses.tum",
            truth / "truth_trajectory.tum",
            **stage_settings.select_simulation(settings),
        )
    (dataset / "dataset.yaml").write_text(
        yaml.safe_dump({key: value for key, value in own.items() if key != "simulate"})
    )
