"""The settings of a dataset: defaults, the dataset's own, the command line's; the later win.

No heavy imports: this runs whenever the workflow is parsed.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from scanplan.errors import StageError
from scanplan.project import export_formats
from scanplan.project.settings_check import (
    COMMAND_LINE,
    MANUAL,
    check_settings,
    find_crossed_limits,
    iterate_leaves,
)
from scanplan.project.settings_schema import Schema, default_settings, iterate_keys, read_schema
from scanplan.project.yaml_file import read_yaml

if TYPE_CHECKING:
    from scanplan.types import FilePath, Settings

OF_A_RUN = ("dataset", "replace")
"""Keys that say what a run is of, and nothing of how its results are made."""

_DEFAULTS = "config/config.yaml"
SCHEMA_FILE = Path(__file__).parents[3] / "workflow/schemas/config.schema.yaml"
"""The schema of the settings."""
LABORATORY_FILE = SCHEMA_FILE.parents[1] / "thesis/config.schema.yaml"
"""That of what the laboratory has beside them."""


@dataclass(frozen=True)
class Layer:
    """Settings from one place, which win over those before them.

    Attributes
    ----------
    origin : str
        A file, or `settings_check.COMMAND_LINE`.
    values : dict
    folder : Path or None
        Where files that it names may lie, besides the folder of the command.
    """

    origin: str
    values: dict[str, Any]
    folder: Path | None = None


class KnownSettings(NamedTuple):
    """What settings are made of beside a dataset's own.

    Attributes
    ----------
    defaults : dict
        See `read_defaults`.
    given : sequence of Layer
        The command line's.
    schema : dict
        What all must fit.
    """

    defaults: Settings
    given: Sequence[Layer]
    schema: Schema


def merge_settings(base: Settings, over: Settings) -> dict[str, Any]:
    """Return `base` with the values of `over` laid over it, section by section, both unchanged."""
    result = dict(base)
    for key, value in over.items():
        both = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = merge_settings(result[key], value) if both else value
    return result


def read_defaults(path: FilePath, schema: Schema) -> dict[str, Any]:
    """Return the schema's defaults with the values of config/config.yaml laid over them, checked.

    Formats whose library is not installed are left out: whoever wants them asks for them.

    Raises
    ------
    StageError
        See `check_settings`.
    """
    settings = merge_settings(default_settings(schema), read_yaml(path))
    check_settings(settings, schema, _DEFAULTS)
    usual = settings["plan"]["export"]["formats"]
    lacking = export_formats.list_lacking()
    of_plan = {"formats": [name for name in usual if name not in lacking]}
    return merge_settings(settings, {"plan": {"export": of_plan}})


def settings_of_dataset(
    defaults: Settings, layers: Sequence[Layer], schema: Schema
) -> dict[str, Any]:
    """Return the checked settings of one dataset.

    Parameters
    ----------
    defaults : dict
        See `read_defaults`.
    layers : sequence of Layer
        The dataset's own settings and the command line's; the later win.

    Returns
    -------
    dict
        Without the keys `OF_A_RUN`.

    Raises
    ------
    StageError
        Naming where the fault lies, the key, its value, what is allowed and the remedy.
    """
    settings = dict(defaults)
    for layer in layers:
        # what a run is of has been checked once: the list of many datasets is long
        own = {key: value for key, value in layer.values.items() if key not in OF_A_RUN}
        check_settings(own, schema, layer.origin)
        settings = merge_settings(settings, _name_beside(own, layer.folder, schema))
    if crossed := find_crossed_limits(settings, schema):
        keys, fault = crossed
        raise StageError(f"{find_origin(layers, *keys) or _DEFAULTS}: {fault}; {MANUAL}")
    return {key: value for key, value in settings.items() if key not in OF_A_RUN}


def _name_beside(values: dict[str, Any], folder: Path | None, schema: Schema) -> dict[str, Any]:
    """Return settings with the files that lie in a folder named by their places.

    Any other name is one of ours, or that of a file in the folder of the command.
    """
    for key, node in iterate_keys(schema) if folder else ():
        *sections, last = key.split(".")
        said: Any = values
        for section in sections:
            said = said.get(section, {})
        name = said.get(last) if node.get("format") == "path" else None
        if folder and name and os.path.lexists(folder / name):
            place: Any = str(folder / name)
            for of in reversed(key.split(".")):
                place = {of: place}
            values = merge_settings(values, place)
    return values


def settings_of_run(defaults: Settings, layers: Sequence[Layer], schema: Schema) -> dict[str, Any]:
    """Return what the command line says of the run, `OF_A_RUN`, checked like other settings."""
    settings = dict(defaults)
    for layer in layers:
        of_run = {key: layer.values[key] for key in OF_A_RUN if key in layer.values}
        if layer.origin == COMMAND_LINE and of_run.get("dataset", layer) is None:
            raise StageError(
                f"{COMMAND_LINE}: dataset: is empty; name a folder or a recording, or leave it out"
                " for the demo"
            )
        settings = merge_settings(settings, of_run)
        check_settings(settings, schema, layer.origin)
    return {key: settings[key] for key in OF_A_RUN}


def read_own_layers(path: FilePath | None, *, may_lack: bool = True) -> list[Layer]:
    """Return the layers of a dataset's own file: none where it has none, if it may.

    Raises
    ------
    StageError
        If it says what is for the command line alone, or cannot be read.
    """
    if path is None or (may_lack and not os.path.lexists(path)):
        return []
    values = read_yaml(path)
    for key in OF_A_RUN:
        if key in values:
            raise StageError(
                f"{path}: `{key}` is given on the command line, not in the dataset's own settings;"
                " drop it"
            )
    return [Layer(str(path), values, Path(path).parent)]


def find_origin(layers: Sequence[Layer], *keys: str) -> str | None:
    """Return where one of some keys, or one below them, was set last; None where none was.

    Parameters
    ----------
    *keys : str
        Joined by dots: `plan.method`, or a section, `plan`.
    """
    for layer in reversed(layers):
        for given, _ in iterate_leaves(layer.values):
            if any(f"{given}.".startswith(f"{key}.") for key in keys):
                return layer.origin
    return None


def locate_fault(fault: str, layers: Sequence[Layer]) -> str:
    """Put the file that gives a setting before a fault that begins with the setting's key.

    Parameters
    ----------
    fault : str
        What a stage said: `simulate.site.start_m: ...`, or anything else, which is returned as it
        is.
    layers : sequence of Layer
        The settings of the dataset.
    """
    key = fault.partition(":")[0]
    origin = find_origin(layers, key) if re.fullmatch(r"[a-z0-9_]+(\.[a-z0-9_]+)+", key) else None
    return f"{origin}: {fault}" if origin else fault


def end_on_faulty_settings(arguments: Sequence[str]) -> None:
    """End the process in one line if what a command gives cannot be settings of a run.

    A file for --configfile that holds none, or a key of more words for --config, which Snakemake
    meets with a traceback.

    Parameters
    ----------
    arguments : list of str
        Of Snakemake's command, which itself would execute what such a file may say.

    Raises
    ------
    SystemExit
    """
    # which workflow will be run is not known yet
    schema = read_schema(SCHEMA_FILE, LABORATORY_FILE)
    try:
        for path in _list_words(arguments, "--configf.*"):
            _check_file(path, schema)
        for word in _list_words(arguments, "--config|-C"):
            _check_key(word)
    except StageError as error:
        raise SystemExit(f"scanplan: {error}") from None


def _list_words(arguments: Sequence[str], options: str) -> list[str]:
    """Return the words after the options that a regular expression matches."""
    words = []
    is_of_option = False
    for word in arguments:
        if word.startswith("-"):
            option, _, word = word.partition("=")
            is_of_option = re.fullmatch(options, option) is not None
        if is_of_option and word:
            words.append(word)
    return words


def _check_key(word: str) -> None:
    key, _, value = word.partition("=")
    if key.isidentifier():
        return
    section, *keys = key.split(".")
    within = "".join(f"{{{name}: " for name in keys) + (value or "VALUE") + "}" * len(keys)
    raise StageError(
        f"--config {word}: {key} is no name of a section; give a section with its keys, as"
        f" --config '{section}={within}', or a file: --configfile FILE"
    )


def _check_file(path: str, schema: Schema) -> None:
    values = read_yaml(path)
    if not values:
        raise StageError(
            f"{path}: holds no settings; write `section: {{key: value}}`, or leave the file out"
        )
    check_settings(merge_settings(default_settings(schema), values), schema, path)
