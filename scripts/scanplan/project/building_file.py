"""A building of several storeys: building.yaml beside the folders of its datasets.

No heavy imports: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project import dataset_files, overlooked_files, texts, user_file
from scanplan.project.yaml_file import is_number, read_yaml

if TYPE_CHECKING:
    from scanplan.types import FilePath

BUILDING_FILE = "building.yaml"
_KEYS = {"name", "frame", "storeys"}
_STOREY_KEYS = {"dataset", "name", "elevation_m", "building_from_map"}
_HIGHEST_M = 10_000.0
"""Above or below the building's zero: heights above the sea, and the deepest mines."""
_FARTHEST_M = 10_000.0
"""Between the map frames of storeys: wider than any building."""
_LEAST_APART_M = 0.5
"""From floor to floor: a mezzanine, or a wing some steps up."""


@dataclass(frozen=True)
class Storey:
    """A storey of a building.

    Attributes
    ----------
    dataset : str
        The name of its dataset.
    name : str
    elevation_m : float or None
        Of its floor in the building; None where the shared map frame tells it.
    place : (float, float, float)
        Where its map frame lies in the building's: x and y in metres, rotation in degrees.
    aligned : bool
        Whether that is known; else the frames are laid on each other as they are.
    """

    dataset: str
    name: str
    elevation_m: float | None
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    aligned: bool = True


@dataclass(frozen=True)
class Building:
    """Storeys from the lowest up, and the name that their common results carry."""

    name: str
    storeys: tuple[Storey, ...]

    def list_results(self) -> list[str]:
        """List what is made of all storeys together."""
        return [f"results/{self.name}/building.{suffix}" for suffix in ("ifc", "dxf", "pdf")]

    def note_unaligned(self) -> list[str]:
        """Say which storeys are laid on the others as their frames happen to lie."""
        loose = [storey.dataset for storey in self.storeys if not storey.aligned]
        if not loose:
            return []
        fault = f"{', '.join(loose)} not aligned with the storeys below"
        remedy = "give `building_from_map: [x_m, y_m, rotation_deg]`, or `frame: shared`"
        return [f"{self.name}: {fault}; {remedy}"]


def find_building(datasets: Mapping[str, FilePath | None]) -> Building | None:
    """Return the building that datasets are storeys of; None where they are of none.

    Parameters
    ----------
    datasets : dict of str to (path-like or None)
        Name to path, as `dataset.name_datasets` gives them. Two or more in one folder, with a file
        building.yaml beside them, are a building.

    Raises
    ------
    StageError
        If the file is wrong, or names a storey that has no scans.
    """
    folder = _find_folder(datasets)
    remedy = "write the storeys there, or remove it"
    path = folder and user_file.find_file(folder / BUILDING_FILE, remedy)
    if path is None:
        return None
    building = read_building(path)
    for storey in building.storeys:
        if storey.dataset not in datasets:
            fault = f"storey {storey.name} has no scans: its dataset {storey.dataset} is not given"
            raise StageError(f"{path}: {fault} ({', '.join(datasets)}); add it, or leave it out")
    if building.name.casefold() in map(str.casefold, datasets):
        raise StageError(f"{path}: name {building.name} is that of a dataset; choose another")
    return building


def list_overlooked(datasets: Mapping[str, FilePath | None]) -> list[str]:
    """List in lines which files beside datasets have nearly the name of a building's."""
    folder = _find_folder(datasets)
    if folder is None:
        return []
    note = overlooked_files.note_misnamed(folder, (BUILDING_FILE,), "storeys are")
    return [note] if note else []


def _find_folder(datasets: Mapping[str, FilePath | None]) -> Path | None:
    """Return the one folder that two or more datasets lie in; None where there is none."""
    paths = [Path(path) for path in datasets.values() if path is not None]
    folders = {path.absolute().parent for path in paths}
    if len(datasets) < 2 or len(paths) < len(datasets) or len(folders) != 1:
        return None
    return paths[0].parent


def read_building(path: FilePath) -> Building:
    """Read and check building.yaml.

    Raises
    ------
    StageError
    """
    values = read_yaml(path)
    given = values.get("storeys")
    if unknown := sorted(map(str, set(values) - _KEYS)):
        raise StageError(f"{path}: has {', '.join(unknown)}; known are {', '.join(sorted(_KEYS))}")
    if not isinstance(given, list) or len(given) < 2:
        raise StageError(f"{path}: storeys is {given!r}, expected a list of two or more")
    if values.get("frame") not in (None, "shared"):
        raise StageError(f"{path}: frame is {values['frame']!r}, expected `shared`, or none")
    is_shared = values.get("frame") == "shared"
    storeys = tuple(
        _read_storey(f"{path}: storey {number}", storey, is_shared, is_first=number == 1)
        for number, storey in enumerate(given, 1)
    )
    for i, storey in enumerate(storeys):
        if storey.dataset in [other.dataset for other in storeys[:i]]:
            raise StageError(f"{path}: dataset {storey.dataset} is two storeys; leave one out")
    stated_m = {s.dataset: s.elevation_m for s in storeys if s.elevation_m is not None}
    if fault := explain_low_storey(stated_m):
        raise StageError(f"{path}: by elevation_m {fault}; give that of each floor")
    given_name = texts.check_text(f"{path}: name", values.get("name", "building"))
    name = dataset_files.name_results(f"{path}: name {given_name}", given_name)
    dataset_files.check_results_name(str(path), name)
    return Building(name, storeys)


def explain_low_storey(elevations_m: Mapping[str, float]) -> str | None:
    """Return which storeys lie in one another, None where all are as far apart as storeys are.

    Parameters
    ----------
    elevations_m : dict of str to float
        Of the floors, by the storeys' names.
    """
    for (lower, low_m), (upper, high_m) in pairwise(
        sorted(elevations_m.items(), key=itemgetter(1))
    ):
        if high_m - low_m < _LEAST_APART_M:
            limit = f"storeys are at least {_LEAST_APART_M:g} m apart"
            return f"{lower} and {upper} lie {high_m - low_m:g} m apart, {limit}"
    return None


def _read_storey(place: str, values: Any, is_shared: bool, *, is_first: bool) -> Storey:
    if not isinstance(values, dict) or not isinstance(values.get("dataset"), str):
        raise StageError(f"{place}: is {values!r}, expected `dataset: NAME` with what is known")
    if unknown := sorted(map(str, set(values) - _STOREY_KEYS)):
        known = ", ".join(sorted(_STOREY_KEYS))
        raise StageError(f"{place}: has {', '.join(unknown)}; known are {known}")
    elevation_m = values.get("elevation_m")
    if elevation_m is None and not is_shared:
        raise StageError(f"{place}: has no elevation_m; give it, or `frame: shared` for all")
    if elevation_m is not None and not is_number(elevation_m, -_HIGHEST_M, _HIGHEST_M):
        expected = f"expected metres, up to {_HIGHEST_M:g}"
        raise StageError(f"{place}: elevation_m is {elevation_m!r}, {expected}")
    name = texts.check_text(f"{place}: name", values.get("name", values["dataset"]))
    motion = values.get("building_from_map")
    if motion is not None and not _is_motion(motion):
        expected = f"expected [x_m, y_m, rotation_deg], up to {_FARTHEST_M:g} m and 360"
        raise StageError(f"{place}: building_from_map is {motion!r}, {expected}")
    x_m, y_m, rotation_deg = map(float, motion or (0, 0, 0))
    aligned = is_shared or is_first or motion is not None
    height_m = None if elevation_m is None else float(elevation_m)
    return Storey(values["dataset"], name, height_m, (x_m, y_m, rotation_deg), aligned)


def _is_motion(value: Any) -> bool:
    limits = (_FARTHEST_M, _FARTHEST_M, 360.0)
    is_triple = isinstance(value, list) and len(value) == len(limits)
    return is_triple and all(
        is_number(of, -limit, limit) for of, limit in zip(value, limits, strict=True)
    )
