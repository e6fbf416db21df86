"""The schema of the settings: the one place of every key's default, range, unit and meaning.

No heavy imports: this runs whenever the workflow is parsed.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from scanplan.project import texts

if TYPE_CHECKING:
    from scanplan.types import FilePath


ADVANCED = "advanced"
"""The section of the tuned keys, each in a section of its own name below it."""

Schema = dict[str, Any]
"""A JSON schema, or the part of it that describes a key or a section."""

# a tenth of the time that Python takes; no message need say where in the schema a fault lies
_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read_schema(path: FilePath, *further: FilePath) -> Schema:
    """Read the schema of the settings.

    Parameters
    ----------
    *further : path-like
        Schemas of more sections, as the laboratory's.

    Returns
    -------
    dict
        With the `$defs` put in where a key refers to one, and every section closed to keys that it
        does not name.
    """
    schema = yaml.load(Path(path).read_text(encoding="utf-8"), _Loader)
    complete = _complete(schema, schema.pop("$defs", {}))
    for other in further:
        complete["properties"] |= read_schema(other)["properties"]
    return complete


def default_settings(schema: Schema) -> dict[str, Any]:
    """Return the default of every key, nested as the schema is."""
    return {
        key: default_settings(node) if is_section(node) else node["default"]
        for key, node in schema["properties"].items()
    }


def is_section(node: Schema) -> bool:
    """Return whether a part of the schema describes keys below it, not a value."""
    return "properties" in node


def iterate_keys(schema: Schema, prefix: str = "") -> Iterator[tuple[str, Schema]]:
    """Yield every key that has a value, joined by dots, and what the schema says of it."""
    for key, node in schema["properties"].items():
        if is_section(node):
            yield from iterate_keys(node, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", node


def type_texts(values: Any, node: Schema) -> Any:
    """Return values whose texts are what a file of the same words would give.

    Below a section Snakemake reads what is behind --config as text, numbers too.

    Parameters
    ----------
    values : dict, list, str, or any other
        Settings, or the value of one; what is no text stays as it is.
    node : dict
        The part of the schema that describes it. Text stays text where none of the types of its
        key is that of the value it would be.
    """
    if isinstance(values, dict):
        below = node.get("properties", {})
        return {key: type_texts(value, below.get(key, {})) for key, value in values.items()}
    kinds = [node, *node.get("anyOf", []), *node.get("oneOf", [])]
    if isinstance(values, list):
        items: Schema = next((kind["items"] for kind in kinds if "items" in kind), {})
        return [type_texts(value, items) for value in values]
    if not isinstance(values, str):
        return values
    # one half alone stays, and is refused where the text is checked
    with suppress(ValueError):
        values = texts.join_pairs(values)
    allowed = {name for kind in kinds for name in _list_types(kind)}
    return _type_text(values, allowed)


def _list_types(node: Schema) -> list[str]:
    named = node.get("type", [])
    return [named] if isinstance(named, str) else list(named)


def _type_text(text: str, allowed: set[str]) -> Any:
    try:
        # a colon would make minutes of a number
        value = text if ":" in text else yaml.load(text, _Loader)
    except (yaml.YAMLError, ValueError):
        return text
    names = {
        type(None): {"null"},
        bool: {"boolean"},
        int: {"integer", "number"},
        float: {"number"},
    }
    return value if names.get(type(value), set()) & allowed else text


def list_choices(schema: Schema, *keys: str) -> list[str]:
    """Return what a setting may be, in the schema's order, as the workflow's list of it."""
    for key in keys:
        schema = schema["properties"][key]
    return list(schema["enum"])


def _complete(node: Schema, definitions: dict[str, Schema]) -> Schema:
    if "$ref" in node:
        own = {key: value for key, value in node.items() if key != "$ref"}
        return definitions[node["$ref"].removeprefix("#/$defs/")] | own
    if not is_section(node):
        return node
    properties = {key: _complete(child, definitions) for key, child in node["properties"].items()}
    closed = {"type": "object", "additionalProperties": False, "properties": properties}
    return node | closed
