"""The settings of a dataset: defaults, the dataset's own, the command line's; checked against the schema."""

import math
import os
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator, ValidationError, validators

from scanplan.errors import StageError
from scanplan.project.renamed_keys import explain_old_keys
from scanplan.project.settings_schema import Schema, default_settings, iterate_keys, read_schema
from scanplan.project.yaml_file import read_yaml
from scanplan.types import FilePath, Settings

COMMAND_LINE = "--config"
"""Origin of the settings that were given one by one on the command line."""

OF_A_RUN = ("dataset", "replace")
"""Keys that say what a run is of, and nothing of how its results are made."""

# JSON knows no whole numbers and takes 5.0 for one; range() and a schema's reader do not
_WHOLE = Draft202012Validator.TYPE_CHECKER.redefine("integer", lambda _, value: type(value) is int)
_Validator = validators.extend(Draft202012Validator, type_checker=_WHOLE)
_DEFAULTS, _MANUAL = "config/config.yaml", "config/README.md explains every key"
_ROOT = Path(__file__).parents[3]
_CODE_KEY = "__use_yte__"


@dataclass(frozen=True)
class Layer:
    """Settings from one place, which win over those before them.

    Attributes
    ----------
    origin : str
        A file, or `COMMAND_LINE`.
    values : dict
    """

    origin: str
    values: dict[str, Any]


def merge_settings(base: Settings, over: Settings) -> dict[str, Any]:
    """Return `base` with the values of `over` laid over it, section by section; neither is changed."""
    result = dict(base)
    for key, value in over.items():
        both = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = merge_settings(result[key], value) if both else value
    return result


def read_defaults(path: FilePath, schema: Schema) -> dict[str, Any]:
    """Return the schema's defaults with the values of config/config.yaml laid over them, checked.

    Raises
    ------
    StageError
        See `check_settings`.
    """
    settings = merge_settings(default_settings(schema), read_yaml(path))
    check_settings(settings, schema, _DEFAULTS)
    return settings


def check_settings(settings: Settings, schema: Schema, origin: str) -> None:
    """Check settings against the JSON schema.

    Parameters
    ----------
    settings : dict
    schema : dict
    origin : str
        Where the settings come from, for the message.

    Raises
    ------
    StageError
        Naming the key, the value, what is allowed and the remedy, for the first fault in order of the keys.
    """
    if _CODE_KEY in settings:
        raise StageError(
            f"{origin}: {_CODE_KEY}: has Snakemake execute what the file says; settings are data, drop it"
        )
    given = [key for key, _ in iterate_leaves(settings)]
    if old := explain_old_keys(given, [key for key, _ in iterate_keys(schema)]):
        raise StageError(f"{origin}: {old}; {_MANUAL}")
    faults = sorted(
        _Validator(schema).iter_errors(settings), key=lambda e: (str(e.path), e.message)
    )
    if faults:
        raise StageError(f"{origin}: {_explain(faults[0], origin)}; {_MANUAL}")
    for key, value in iterate_leaves(settings):
        if not _is_finite(value):
            raise StageError(f"{origin}: {key}: {value} is no finite number; {_MANUAL}")


def _is_finite(value: Any) -> bool:
    if isinstance(value, list):
        return all(map(_is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)


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
    schema : dict

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
        settings = merge_settings(settings, layer.values)
        check_settings(settings, schema, layer.origin)
    _check_order(settings, layers, schema)
    return {key: value for key, value in settings.items() if key not in OF_A_RUN}


def settings_of_run(defaults: Settings, layers: Sequence[Layer], schema: Schema) -> dict[str, Any]:
    """Return what the command line says of the run itself: `OF_A_RUN`, checked like `settings_of_dataset`."""
    settings = dict(defaults)
    for layer in layers:
        of_run = {key: layer.values[key] for key in OF_A_RUN if key in layer.values}
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
                f"{path}: `{key}` is given on the command line, not in the dataset's own settings; drop it"
            )
    return [Layer(str(path), values)]


def find_origin(layers: Sequence[Layer], *keys: str) -> str | None:
    """Return where one of some keys, or one below them, was set last; None where all are as by default.

    Parameters
    ----------
    layers : sequence of Layer
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
        What a stage said: `simulate.site.start_m: ...`, or anything else, which is returned as it is.
    layers : sequence of Layer
        The settings of the dataset.
    """
    key = fault.partition(":")[0]
    origin = find_origin(layers, key) if re.fullmatch(r"[a-z0-9_]+(\.[a-z0-9_]+)+", key) else None
    return f"{origin}: {fault}" if origin else fault


def _check_order(settings: Settings, layers: Sequence[Layer], schema: Schema) -> None:
    """Refuse limits that cross, in the name of what set one of them last."""
    values = dict(iterate_leaves(settings))
    for key, node in iterate_keys(schema):
        value = values[key]
        for other in [*node.get("x-above", []), *node.get("x-at-least", [])]:
            must_differ = other in node.get("x-above", [])
            least = values[other]
            if value < least or (must_differ and value == least):
                origin = find_origin(layers, key, other) or _DEFAULTS
                limit = "must be above" if must_differ else "must not be below"
                raise StageError(
                    f"{origin}: {key}: {value} {limit} {other} ({least}); change one of them, {_MANUAL}"
                )
        if node.get("x-falling") and any(rough < fine for rough, fine in pairwise(value)):
            origin = find_origin(layers, key) or _DEFAULTS
            raise StageError(
                f"{origin}: {key}: {value} must not rise, from rough to fine; {_MANUAL}"
            )


def iterate_leaves(settings: Settings, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of nested settings with their keys, joined by dots: `("plan.method", "hull")`."""
    for key, value in settings.items():
        if isinstance(value, dict):
            yield from iterate_leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _explain(fault: ValidationError, origin: str) -> str:
    key = ".".join(map(str, fault.path)) or "settings"
    node: Any = fault.schema
    value: Any = fault.instance
    if fault.validator == "additionalProperties":
        known = ", ".join(node["properties"])
        extra = ", ".join(sorted(str(key) for key in set(value) - set(node["properties"])))
        return f"{key}: unknown key {extra}; known are {known}"
    if fault.validator == "type" and fault.validator_value == "object":
        return f"{key}: is {value!r}, expected keys with values below it; leave the section out if there are none"
    if origin == COMMAND_LINE and isinstance(value, str) and fault.validator == "type":
        return f"{key}: {fault.message} (nested values of --config arrive as text: put them into a file for --configfile)"
    if fault.validator in ("anyOf", "oneOf"):
        numeral = origin == COMMAND_LINE and isinstance(value, (int, float))
        hint = f" (a name of digits wants quotes: --config '{key}=\"{value}\"')" if numeral else ""
        return f"{key}: is {value!r}{hint}, expected: {node['description']}"
    return f"{key}: {fault.message}"


def _check_files(paths: Sequence[str]) -> None:
    """Say of every file whether it can be given as settings of a run, before Snakemake itself reads it."""
    schema = read_schema(_ROOT / "workflow/schemas/config.schema.yaml")
    for path in paths:
        values = read_yaml(path)
        if not values:
            raise StageError(
                f"{path}: holds no settings; write `section: {{key: value}}`, or leave CONFIG out"
            )
        check_settings(merge_settings(default_settings(schema), values), schema, path)


if __name__ == "__main__":
    try:
        _check_files(sys.argv[1:])
    except StageError as error:
        raise SystemExit(f"scanplan: {error}") from None
