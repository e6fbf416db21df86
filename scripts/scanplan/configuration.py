"""The settings of a dataset: defaults, the dataset's own, the command line's; checked against the schema."""

import math
from pathlib import Path

import yaml
from jsonschema import Draft202012Validator, validators

from scanplan.errors import StageError

_COMMAND_LINE = "--configfile or --config"
# JSON knows no whole numbers and takes 5.0 for one; range() and a schema's reader do not
_WHOLE = Draft202012Validator.TYPE_CHECKER.redefine("integer", lambda _, value: type(value) is int)
_Validator = validators.extend(Draft202012Validator, type_checker=_WHOLE)
# (section and key, must not be below section and key)
_ORDERED = [
    (("input", "max_range_m"), ("input", "min_range_m")),
    (("registration", "n_previous"), ("registration", "icp_targets")),
    (("plan", "merge", "merge_distance_m"), ("plan", "merge", "tolerance_m")),
    (("plan", "openings", "max_opening_m"), ("plan", "openings", "min_opening_m")),
    (("selection", "visibility", "max_height_m"), ("selection", "visibility", "min_height_m")),
]


def read_yaml(path):
    """Read a YAML file of settings; plain data only, nothing in it is executed.

    Raises
    ------
    StageError
        If it is no YAML or no mapping.
    """
    try:
        values = yaml.safe_load(Path(path).read_text(encoding="utf-8")) or {}
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise StageError(f"{path}: is not valid YAML ({error})") from None
    except OSError as error:
        raise StageError(f"{path}: cannot be read ({error.strerror}); it must be a readable file") from None
    if not isinstance(values, dict):
        raise StageError(f"{path}: holds {type(values).__name__}, expected `section: {{key: value}}`")
    return values


def merged(base, over):
    """Return `base` with the values of `over` laid over it, section by section; neither is changed."""
    result = dict(base)
    for key, value in over.items():
        both = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = merged(result[key], value) if both else value
    return result


def check(settings, schema, origin):
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
    faults = sorted(_Validator(schema).iter_errors(settings), key=lambda e: (str(e.path), e.message))
    if faults:
        raise StageError(f"{origin}: {_explain(faults[0], origin)}; config/README.md explains every key")
    for key, value in leaves(settings):
        if isinstance(value, float) and not math.isfinite(value):
            raise StageError(f"{origin}: {key}: {value} is no finite number; config/README.md explains every key")
    for high, low in _ORDERED:
        if _value(settings, high) < _value(settings, low):
            raise StageError(
                f"{origin}: {'.'.join(high)}: {_value(settings, high)} is below {'.'.join(low)}"
                f" ({_value(settings, low)}); config/README.md explains every key"
            )


def for_dataset(defaults, dataset_yaml, overrides, schema):
    """Return the checked settings of one dataset.

    Parameters
    ----------
    defaults : dict
        config/config.yaml.
    dataset_yaml : path-like or None
        The dataset's own file; may be missing.
    overrides : dict
        What was given on the command line; wins over both.
    schema : dict

    Returns
    -------
    dict
    """
    own = read_yaml(dataset_yaml) if dataset_yaml is not None and Path(dataset_yaml).exists() else {}
    if "dataset" in own:
        raise StageError(f"{dataset_yaml}: `dataset` is given on the command line, not in the dataset's own settings")
    check(merged(defaults, own), schema, dataset_yaml)
    settings = merged(merged(defaults, own), overrides)
    check(settings, schema, _COMMAND_LINE)
    return settings


def _value(settings, keys):
    for key in keys:
        settings = settings[key]
    return settings


def leaves(settings, prefix=""):
    """Yield the values of nested settings with their keys, joined by dots: `("plan.method", "hull")`."""
    for key, value in settings.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _explain(fault, origin):
    key = ".".join(map(str, fault.path)) or "settings"
    if fault.validator == "additionalProperties":
        known = ", ".join(fault.schema["properties"])
        extra = ", ".join(sorted(str(key) for key in set(fault.instance) - set(fault.schema["properties"])))
        return f"{key}: unknown key {extra}; known are {known}"
    if fault.validator == "type" and fault.validator_value == "object":
        return (
            f"{key}: is {fault.instance!r}, expected keys with values below it; leave the section out if there are none"
        )
    if origin == _COMMAND_LINE and isinstance(fault.instance, str) and fault.validator == "type":
        return (
            f"{key}: {fault.message} (nested values of --config arrive as text: put them into a file for --configfile)"
        )
    return f"{key}: {fault.message}"
