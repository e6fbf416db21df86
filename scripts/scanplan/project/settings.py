"""The settings of a dataset: defaults, the dataset's own, the command line's; checked against the schema."""

import math
import os
import re
from dataclasses import dataclass
from itertools import pairwise

from jsonschema import Draft202012Validator, validators

from scanplan.errors import StageError
from scanplan.project.yaml_file import read_yaml

COMMAND_LINE = "--config"
"""Origin of the settings that were given one by one on the command line."""

OF_A_RUN = ("dataset", "replace")
"""Keys that say what a run is of, and nothing of how its results are made."""

# JSON knows no whole numbers and takes 5.0 for one; range() and a schema's reader do not
_WHOLE = Draft202012Validator.TYPE_CHECKER.redefine("integer", lambda _, value: type(value) is int)
_Validator = validators.extend(Draft202012Validator, type_checker=_WHOLE)
_DEFAULTS, _MANUAL = "config/config.yaml", "config/README.md explains every key"
_EXTRACTORS = ("cluster_ransac", "iterative_ransac")
# (key, another): the first must be above the second, as nothing lies between them otherwise
_ABOVE = [
    ("input.max_range_m", "input.min_range_m"),
    ("selection.visibility.max_height_m", "selection.visibility.min_height_m"),
    *((f"walls.{e}.furniture_height_m", f"walls.{e}.hang_height_m") for e in _EXTRACTORS),
    ("plan.pair.max_thickness_m", "plan.pair.min_thickness_m"),
    ("plan.openings.max_opening_m", "plan.openings.min_opening_m"),
    ("simulate.sensor.max_range_m", "simulate.sensor.min_range_m"),
]
# (key, another): the first must not be below the second
_NOT_BELOW = [
    ("registration.n_previous", "registration.icp_targets"),
    ("hulls.sample_size", "hulls.n_clusters"),
    # of walls, only what is lower than doors is looked at
    *(
        (f"walls.{e}.door_height_m", f"walls.{e}.{low}_height_m")
        for e in _EXTRACTORS
        for low in ("min", "wall")
    ),
    ("plan.merge.merge_distance_m", "plan.merge.tolerance_m"),
    ("plan.openings.max_door_m", "plan.openings.min_opening_m"),
]


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
    values: dict


def merge_settings(base, over):
    """Return `base` with the values of `over` laid over it, section by section; neither is changed."""
    result = dict(base)
    for key, value in over.items():
        both = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = merge_settings(result[key], value) if both else value
    return result


def check_settings(settings, schema, origin):
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
    faults = sorted(
        _Validator(schema).iter_errors(settings), key=lambda e: (str(e.path), e.message)
    )
    if faults:
        raise StageError(f"{origin}: {_explain(faults[0], origin)}; {_MANUAL}")
    for key, value in iterate_leaves(settings):
        if not _is_finite(value):
            raise StageError(f"{origin}: {key}: {value} is no finite number; {_MANUAL}")


def _is_finite(value):
    if isinstance(value, list):
        return all(map(_is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def settings_of_dataset(defaults, layers, schema):
    """Return the checked settings of one dataset.

    Parameters
    ----------
    defaults : dict
        config/config.yaml.
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
    settings = defaults
    for layer in layers:
        settings = merge_settings(settings, layer.values)
        check_settings(settings, schema, layer.origin)
    _check_order(settings, layers)
    return {key: value for key, value in settings.items() if key not in OF_A_RUN}


def settings_of_run(defaults, layers, schema):
    """Return what the command line says of the run itself: a dict of `OF_A_RUN`, checked like `settings_of_dataset`."""
    settings = defaults
    for layer in layers:
        settings = merge_settings(
            settings, {key: layer.values[key] for key in OF_A_RUN if key in layer.values}
        )
        check_settings(settings, schema, layer.origin)
    return {key: settings[key] for key in OF_A_RUN}


def read_own_layers(path, *, may_lack=True):
    """Return the layers of a dataset's own file: none where it has none, if it may.

    Raises
    ------
    StageError
        If it says what is for the command line alone, or cannot be read.
    """
    if may_lack and (path is None or not os.path.lexists(path)):
        return []
    values = read_yaml(path)
    for key in OF_A_RUN:
        if key in values:
            raise StageError(
                f"{path}: `{key}` is given on the command line, not in the dataset's own settings; drop it"
            )
    return [Layer(str(path), values)]


def find_origin(layers, *keys):
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


def locate_fault(fault, layers):
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


def _check_order(settings, layers):
    """Refuse limits that cross, in the name of what set one of them last."""
    rules = [(*pair, True) for pair in _ABOVE] + [(*pair, False) for pair in _NOT_BELOW]
    for high, low, apart in rules:
        most, least = _value(settings, high), _value(settings, low)
        if most < least or (apart and most == least):
            origin = find_origin(layers, high, low) or _DEFAULTS
            limit = "must be above" if apart else "must not be below"
            raise StageError(
                f"{origin}: {high}: {most} {limit} {low} ({least}); change one of them, {_MANUAL}"
            )
    key = "registration.icp_distances_m"
    if any(rough < fine for rough, fine in pairwise(_value(settings, key))):
        origin = find_origin(layers, key) or _DEFAULTS
        raise StageError(
            f"{origin}: {key}: {_value(settings, key)} must not rise, from rough to fine; {_MANUAL}"
        )


def _value(settings, key):
    for part in key.split("."):
        settings = settings[part]
    return settings


def iterate_leaves(settings, prefix=""):
    """Yield the values of nested settings with their keys, joined by dots: `("plan.method", "hull")`."""
    for key, value in settings.items():
        if isinstance(value, dict):
            yield from iterate_leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _explain(fault, origin):
    key = ".".join(map(str, fault.path)) or "settings"
    if fault.validator == "additionalProperties":
        known = ", ".join(fault.schema["properties"])
        extra = ", ".join(
            sorted(str(key) for key in set(fault.instance) - set(fault.schema["properties"]))
        )
        return f"{key}: unknown key {extra}; known are {known}"
    if fault.validator == "type" and fault.validator_value == "object":
        return f"{key}: is {fault.instance!r}, expected keys with values below it; leave the section out if there are none"
    if origin == COMMAND_LINE and isinstance(fault.instance, str) and fault.validator == "type":
        return f"{key}: {fault.message} (nested values of --config arrive as text: put them into a file for --configfile)"
    if fault.validator in ("anyOf", "oneOf"):
        numeral = origin == COMMAND_LINE and isinstance(fault.instance, (int, float))
        quoted = (
            f" (a name of digits wants quotes: --config '{key}=\"{fault.instance}\"')"
            if numeral
            else ""
        )
        return f"{key}: is {fault.instance!r}{quoted}, expected: {fault.schema['description'].rstrip('.')}"
    return f"{key}: {fault.message}"
