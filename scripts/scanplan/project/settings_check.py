"""Settings checked against the schema: the first fault, its key, what is allowed, the remedy."""

from __future__ import annotations

import math
from collections.abc import Iterator
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from jsonschema import Draft202012Validator, FormatChecker, ValidationError, validators

from scanplan.errors import MOST_NAMED, StageError
from scanplan.project import reference_systems, texts
from scanplan.project.renamed_keys import explain_old_keys
from scanplan.project.settings_schema import Schema, iterate_keys

if TYPE_CHECKING:
    from scanplan.types import Settings

COMMAND_LINE = "--config"
"""Origin of the settings that were given one by one on the command line."""

MODULE = "config of the module"
"""Origin of those that another workflow gives."""

MANUAL = "config/settings.md explains every key"
"""What a message about a key ends with."""

# JSON knows no whole numbers and takes 5.0 for one; range() and a schema's reader do not
_WHOLE = Draft202012Validator.TYPE_CHECKER.redefine("integer", lambda _, value: type(value) is int)
_Validator = validators.extend(Draft202012Validator, type_checker=_WHOLE)
_FORMATS = FormatChecker(formats=())
_CODE_KEY = "__use_yte__"


def check_settings(settings: Settings, schema: Schema, origin: str) -> None:
    """Check settings against the JSON schema.

    Parameters
    ----------
    origin : str
        Where the settings come from, for the message.

    Raises
    ------
    StageError
        Naming the key, the value, what is allowed and the remedy, for the first fault in order of
        the keys. Keys of earlier versions are named first, with what they are called now.
    """
    if _CODE_KEY in settings:
        raise StageError(
            f"{origin}: {_CODE_KEY}: has Snakemake execute what the file says; settings are data,"
            " drop it"
        )
    given = [key for key, _ in iterate_leaves(settings)]
    if old := explain_old_keys(given, [key for key, _ in iterate_keys(schema)]):
        raise StageError(f"{origin}: {old}; {MANUAL}")
    validator = _Validator(schema, format_checker=_FORMATS)
    faults = sorted(validator.iter_errors(settings), key=lambda e: (str(e.path), e.message))
    if faults:
        raise StageError(f"{origin}: {_explain(faults[0], origin)}; {MANUAL}")
    for key, value in iterate_leaves(settings):
        if not _is_finite(value):
            raise StageError(f"{origin}: {key}: {value} is no finite number; {MANUAL}")


@_FORMATS.checks("line", raises=ValueError)
def _is_line(value: object) -> bool:
    """Return whether a text can stand in a line of a drawing; raise with why not."""
    if isinstance(value, str) and (fault := texts.explain_unfit(value)):
        raise ValueError(fault)
    return True


@_FORMATS.checks("path", raises=StageError)
def _is_path(value: object) -> bool:
    if isinstance(value, str):
        texts.check_path(value)
    return True


@_FORMATS.checks("crs", raises=ValueError)
def _is_reference_system(value: object) -> bool:
    if isinstance(value, str) and (fault := reference_systems.find_fault(value)):
        raise ValueError(f"is {value!r}: {fault}")
    return True


def _is_finite(value: Any) -> bool:
    if isinstance(value, list):
        return all(map(_is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def find_crossed_limits(settings: Settings, schema: Schema) -> tuple[tuple[str, ...], str] | None:
    """Return the first keys whose values contradict one another, and the fault.

    The schema says which limits lie above others (`x-above`), or not below them (`x-at-least`), and
    which lists do not rise (`x-falling`).

    Parameters
    ----------
    settings : dict
        Checked by `check_settings`.

    Returns
    -------
    (tuple of str, str) or None
        None where nothing contradicts.
    """
    values = dict(iterate_leaves(settings))
    for key, node in iterate_keys(schema):
        value = values[key]
        for other in node.get("x-above", []):
            if value <= values[other]:
                return (key, other), _crossing(key, value, "be above", other, values[other])
        for other in node.get("x-at-least", []):
            if value < values[other]:
                return (key, other), _crossing(key, value, "not be below", other, values[other])
        if node.get("x-falling") and value != sorted(value, reverse=True):
            return (key,), f"{key}: {value} must not rise, from rough to fine"
    return None


def _crossing(key: str, value: Any, relation: str, other: str, limit: Any) -> str:
    return f"{key}: {value} must {relation} {other} ({limit}); change one of them"


def iterate_leaves(settings: Settings, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of nested settings with their keys joined by dots: `plan.method`, `hull`."""
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
        extra = sorted(map(str, set(value) - set(node["properties"])))[:MOST_NAMED]
        meant = [near for name in extra for near in get_close_matches(name, node["properties"], 1)]
        ask = f" (did you mean {', '.join(meant)}?)" if meant else ""
        section, dot, below = extra[0].partition(".")
        if dot and section in node["properties"]:
            ask = f" (write `{section}:`, and indented below it `{below}:`)"
        return f"{key}: unknown key {', '.join(extra)}{ask}; known are {known}"
    if fault.validator == "type" and fault.validator_value == "object":
        remedy = "leave the section out if there are none"
        return f"{key}: is {value!r}, expected keys with values below it; {remedy}"
    if fault.validator == "pattern" and "x-unit" in node:
        return f"{key}: is {value!r}, expected: {node['x-unit']}"
    if fault.validator == "format":
        return f"{key}: {fault.cause}"
    if fault.validator in ("maxLength", "maxItems"):
        unit = "characters" if isinstance(value, str) else "entries"
        return f"{key}: has {len(value)} {unit}, at most {fault.validator_value}; write fewer"
    if fault.validator in ("anyOf", "oneOf"):
        numeral = origin == COMMAND_LINE and isinstance(value, (int, float))
        remedy = f" (a name of digits wants to be in a list: --config '{key}=[\"NAME\"]')"
        hint = remedy if numeral else ""
        return f"{key}: is {value!r}{hint}, expected: {node['description']}"
    return f"{key}: {_shorten(fault.message)}"


def _shorten(message: str) -> str:
    """Return a message with the middle left out that a value of hundreds of letters has."""
    return message if len(message) <= 200 else f"{message[:60]} ... {message[-60:]}"
