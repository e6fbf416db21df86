"""The datasets of a run: what each is called, where its files are, and what is made of it.

No heavy imports: this runs while the workflow is being parsed.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project import (
    catalogue_file,
    corrections_file,
    dataset_files,
    dataset_list,
    design_file,
    export_formats,
    overlooked_files,
    provenance,
    texts,
    tolerance_file,
    user_file,
    words_file,
)
from scanplan.project.settings import KnownSettings, Layer, read_own_layers, settings_of_dataset

if TYPE_CHECKING:
    from scanplan.types import FilePath, Settings

DEMO = "demo"
_PLAN = tuple(
    f"plan/{t}" for t in ("faces", "walls", "openings", "rooms", "evidence", "free", "furniture")
)
_VALIDATION = ("plan/validation", "plan/validation_rays", "plan/confidence")
_VISIT = ("plan/questions", "plan/standpoints")
_TABLES = (
    *("poses", "registration", "edges", "scans"),
    *("plan/segments", *_PLAN, *_VALIDATION, *_VISIT),
)
_DRAWN = (
    *(f"plan/plan.{suffix}" for suffix in ("geojson", "dxf", "svg", "pdf", "png")),
    "plan/next_visit.geojson",
    "plan/map.pgm",
    "plan/map.yaml",
    *(f"figures/{f}.svg" for f in ("registration", "scans", "walls", "validation")),
    "report.html",
    "summary.txt",
)
_EVALUATION = ("plan", "poses")
_COMPARED = ("comparison.html", "figures/area.svg")
_COMPARED_WITH_TRUTH = (
    *(f"evaluation/{table}.parquet" for table in ("walls", "walls_aligned", "oracle", "seconds")),
    *("figures/evaluation.svg", "figures/oracle_shares.svg"),
)
_COVERED = tuple(f"{table}.parquet" for table in ("hulls", "visibility"))
COMPARISON = (*_COMPARED, *_COMPARED_WITH_TRUTH, *_COVERED)
"""Results of a dataset that a plan by the usual ordering has no stages for."""
_OF_ALL_SCANS, _ORDERINGS = "walls", "selection"
COMPARED_FOLDERS = (_OF_ALL_SCANS, _ORDERINGS)
"""Folders of what extractors find in all scans, and of orderings beside the plan's own."""
CHANGES = ("parquet", "geojson", "svg", "pdf", "png", "dxf", "html", "txt")
"""Suffixes of what is made of two surveys of a floor."""
GROWN = ("parquet", "csv", "geojson", "svg", "pdf", "png", "dxf", "txt")
"""Suffixes of what is made of all surveys of a floor together."""
DESIGN = ("parquet", "csv", "geojson", "svg", "pdf", "png", "txt")
"""Suffixes of what is made of a survey and its design."""
OF_MODEL = ("as_built.ifc", "deviations.bcf")
"""What is made of them, too, where the design is a building model."""


@dataclass(frozen=True)
class Dataset:
    """A survey that results are made of.

    Attributes
    ----------
    name : str
        Of its folder under results/.
    settings : dict
        Checked, of all sections.
    recordings : tuple of str
        Files that hold its clouds and poses.
    truth : tuple of str or None
        truth.geojson and truth_poses.tum, where the true walls and poses are known.
    building : str or None
        The file of the building that it is simulated in; None of a recorded survey.
    layers : tuple of settings.Layer
        Where its settings come from, beside the defaults.
    source : str
        What its results are made of, as `provenance` compares it.
    notes : tuple of str
        What the user should know of it before it is run.
    corrections : str or None
        The file of what a person says of its plan, where there is one.
    designs : tuple of str
        Files of which one is the design that it is held against, see `design_file.choose_design`.
    """

    name: str
    settings: dict[str, Any]
    recordings: tuple[str, ...]
    truth: tuple[str, str] | None = None
    building: str | None = None
    layers: tuple[Layer, ...] = ()
    source: str = ""
    notes: tuple[str, ...] = ()
    corrections: str | None = None
    designs: tuple[str, ...] = ()


def name_datasets(given: FilePath | list[FilePath] | None) -> dict[str, str | None]:
    """Name the datasets of a run.

    Parameters
    ----------
    given : None, path-like or list of path-like
        A folder, a recording or the file of a simulated survey, or several; the demo if None. A
        file that lists them (`dataset_list`) stands for what it lists.

    Returns
    -------
    dict of str to (str or None)
        Name to path, in the order given; the demo has no path.

    Raises
    ------
    StageError
        If two would share a folder of results, on a file system that knows no case too, or one
        would take the place of something else; see `dataset_list.read_list`.
    """
    if given is None:
        return {DEMO: None}
    paths: dict[str, str | None] = {}
    # not all file systems tell `Hall` from `hall`
    taken: dict[str, str] = {}
    for name, path in _list_named(given):
        other = taken.get(name.casefold())
        if other and provenance.identify_source(path) == provenance.identify_source(other):
            raise StageError(f"{path}: is given twice, first as {other}; leave one out")
        if other:
            fault = f"its results would be called {name} like those of {other}"
            raise StageError(f"{path}: {fault}, case of letters aside; rename one of them")
        dataset_files.check_results_name(str(path), name)
        taken[name.casefold()] = path
        paths[name] = path
    return paths


def _list_named(given: FilePath | list[FilePath]) -> Iterator[tuple[str, str]]:
    for path in map(str, given if isinstance(given, list) else [given]):
        texts.check_path(path)
        if dataset_list.is_list(path):
            yield from dataset_list.read_list(path)
        else:
            yield dataset_files.dataset_name(path), path


def describe_dataset(
    name: str,
    path: FilePath | None,
    known: KnownSettings,
    *,
    drawings: FilePath,
    usual: Settings | None = None,
) -> Dataset:
    """Gather what is known of a dataset before anything is run.

    Parameters
    ----------
    path : path-like or None
        A folder, a recording or the file of a simulated survey; the demo if None.
    drawings : path-like
        The folder of the drawings that settings may name.
    usual : dict, optional
        The settings of a dataset that states none of its own, where they have been worked out: of
        many datasets most are such.

    Returns
    -------
    Dataset

    Raises
    ------
    StageError
        If files or settings are missing or wrong.
    """
    own = _read_own_settings(path)
    layers = (*own, *known.given)
    source = provenance.identify_source(path)
    if own or usual is None:
        settings = settings_of_dataset(known.defaults, layers, known.schema)
    else:
        settings = dict(usual)
    export = settings["plan"]["export"]
    if export["catalogue"] is not None:
        catalogue_file.read_catalogue(export["catalogue"])
    words_file.read_words(export["language"])
    words_file.read_layers(export["layers"])
    if path is None or dataset_files.is_survey_file(path):
        _check_survey(path, own)
        found = describe_simulated(name, settings, drawings)
    else:
        recordings = tuple(dataset_files.find_files(path))
        notes = tuple(overlooked_files.list_overlooked(path))
        corrections = _read_corrections(name, path)
        truth = _truth_beside(Path(path))
        found = Dataset(name, settings, recordings, truth, notes=notes, corrections=corrections)
    named = settings["plan"]["design"]
    tolerance_file.read_tolerances(named["tolerances"])
    designs = design_file.find_designs(named["file"], path)
    return replace(found, layers=layers, source=source, designs=designs)


def _read_own_settings(path: FilePath | None) -> list[Layer]:
    if path is None:
        return []
    if not dataset_files.is_survey_file(path):
        return read_own_layers(Path(path, dataset_files.SETTINGS_FILE))
    remedy = "give a YAML file with a section `simulate`, a folder or a recording"
    if user_file.find_file(path, remedy) is None:
        raise StageError(f"{path}: does not exist; {remedy}")
    if dataset_files.is_rosbag2_metadata(path):
        remedy = f"give its folder as the dataset, {Path(path).parent}"
        raise StageError(f"{path}: describes a rosbag2 recording; {remedy}")
    return read_own_layers(path)


def _read_corrections(name: str, path: FilePath | None, *, simulated: bool = False) -> str | None:
    """Return the file of corrections; one with a mistake ends the run before it begins."""
    place = corrections_file.place_corrections(name, path, is_simulated=simulated)
    found = corrections_file.find_beside(place)
    if found is None:
        return None
    corrections_file.read_corrections(found)
    return str(found)


def _check_survey(path: FilePath | None, own: Sequence[Layer]) -> None:
    if path is not None and not any("simulate" in layer.values for layer in own):
        fault = "has no section `simulate`, which says what is surveyed"
        remedy = "to use it as settings of a dataset, give it as CONFIG (--configfile)"
        raise StageError(f"{path}: {fault}; {remedy}")


def describe_simulated(name: str, settings: dict[str, Any], drawings: FilePath) -> Dataset:
    """Return the dataset that a simulation leaves under results/.

    Raises
    ------
    StageError
        If there is no such building.
    """
    building = settings["simulate"]["building"]
    drawing = Path(drawings, f"{building}.geojson")
    if not drawing.is_file() and not Path(building).is_file():
        ours = ", ".join(sorted(file.stem for file in Path(drawings).glob("*.geojson")))
        raise StageError(
            f"simulate.building: {building} is neither a file nor a drawing of ours ({ours})"
        )
    files = survey_files(settings["simulate"]["recording"], name)
    return Dataset(
        name,
        settings,
        (files["recording"],),
        (files["truth"], files["true_poses"]),
        os.path.relpath(drawing) if drawing.is_file() else building,
        corrections=_read_corrections(name, None, simulated=True),
    )


def survey_files(suffix: str, name: str = "{dataset}") -> dict[str, str]:
    """Return the files of a simulated survey by what they are, its recording with a suffix."""
    folder = f"results/{name}/survey"
    return {
        "recording": f"{folder}/survey.{suffix}",
        "truth": f"{folder}/truth.geojson",
        "true_poses": f"{folder}/truth_poses.tum",
        "true_trajectory": f"{folder}/truth_trajectory.tum",
    }


def list_results(found: Dataset) -> list[str]:
    """List the plan of a dataset and all that it is made of, but the recording of a simulated one.

    Where the truth is known the plan and the poses are evaluated, too.
    """
    files = [f"{table}.parquet" for table in _TABLES]
    files += [f"{_ORDERINGS}/{found.settings['plan']['method']}.parquet", *_DRAWN]
    if found.corrections:
        files += [f"{table.replace('plan/', 'plan/corrected/')}.parquet" for table in _PLAN]
    files += export_formats.list_exports(found.settings["plan"]["export"]["formats"])
    if found.truth:
        files += [f"evaluation/{table}.parquet" for table in _EVALUATION]
    return [f"results/{found.name}/{file}" for file in files]


def list_comparison(found: Dataset, methods: Sequence[str], extractors: Sequence[str]) -> list[str]:
    """List what the plan of a dataset is compared with, beside what `list_results` lists.

    Parameters
    ----------
    methods, extractors : list of str
        All orderings, and all extractors: they find the walls of all scans.

    Returns
    -------
    list of str
    """
    others = [method for method in methods if method != found.settings["plan"]["method"]]
    files = [f"{_ORDERINGS}/{method}.parquet" for method in others]
    files += [f"{_OF_ALL_SCANS}/{extractor}.parquet" for extractor in extractors]
    files += ["hulls.parquet", *_COMPARED]
    if found.truth:
        files += _COMPARED_WITH_TRUTH
    return [f"results/{found.name}/{file}" for file in files]


def pair_surveys(names: Sequence[str]) -> list[tuple[str, str]]:
    """Return each dataset but the first with the one that is given before it, the earlier first.

    Raises
    ------
    StageError
        If there are fewer than two.
    """
    if len(names) < 2:
        example = "`changes --config 'dataset=[FIRST, SECOND]'`"
        raise StageError(
            f"changes: needs two surveys of a floor, {len(names)} is given ({', '.join(names)});"
            f" give the earlier one first: {example}"
        )
    return list(pairwise(names))


def list_floors(given: FilePath | list[FilePath] | None) -> dict[str, list[str]]:
    """Return the surveys of each floor, the earliest first.

    Parameters
    ----------
    given : None, path-like or list of path-like
        As of `name_datasets`; a list in a file may state floors, see `dataset_list.read_floors`.

    Raises
    ------
    StageError
        As `name_datasets`.
    """
    stated: dict[str, str] = {}
    for path in map(str, given if isinstance(given, list) else [given] if given else []):
        stated |= dataset_list.read_floors(path) if dataset_list.is_list(path) else {}
    floors: dict[str, list[str]] = {}
    for name in name_datasets(given):
        floors.setdefault(stated.get(name, name), []).append(name)
    return floors


def list_deviations(found: Dataset) -> list[str]:
    """List what is made of a dataset and its design.

    Raises
    ------
    StageError
        If it has none, or several.
    """
    files = [f"deviations.{suffix}" for suffix in DESIGN]
    files += OF_MODEL if _has_model(found) else ()
    return _place_beside_deviations(found, files)


def list_replaced_models(found: Dataset) -> list[str]:
    """List what an earlier design has left that was a building model, where this one is none.

    Raises
    ------
    StageError
        As `list_deviations`.
    """
    return _place_beside_deviations(found, () if _has_model(found) else OF_MODEL)


def _has_model(found: Dataset) -> bool:
    return design_file.choose_design(found.name, found.designs).lower().endswith(".ifc")


def _place_beside_deviations(found: Dataset, files: Iterable[str]) -> list[str]:
    return [f"results/{found.name}/design/{file}" for file in files]


def find_truth(found: Dataset) -> tuple[str, str]:
    """Return truth.geojson and truth_poses.tum of a dataset.

    Raises
    ------
    StageError
        If its truth is not known.
    """
    if found.truth is None:
        remedy = "put truth.geojson and truth_poses.tum into its folder"
        raise StageError(f"{found.name}: has no truth to be evaluated against; {remedy}")
    return found.truth


def _truth_beside(folder: Path) -> tuple[str, str] | None:
    remedy = "put the file there, or nothing"
    found = [user_file.find_file(folder / name, remedy) for name in dataset_files.TRUTH_FILES]
    faces, poses = found
    return None if faces is None or poses is None else (str(faces), str(poses))
