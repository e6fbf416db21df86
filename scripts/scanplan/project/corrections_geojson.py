"""Corrections as features of GeoJSON, as programs for maps write them.

Standard library only: this runs while the workflow is being parsed.
"""

import json
from collections.abc import Iterable, Mapping
from typing import Any

from scanplan.errors import StageError
from scanplan.plain_types import FilePath
from scanplan.project import user_file


def read_features(path: FilePath) -> list[dict[str, Any]]:
    """Return the entries that the features of a file stand for, as in corrections.yaml.

    Raises
    ------
    StageError
        If it is no collection of features, or one of them has no properties or no geometry.
    """
    text = user_file.read_text(path, "write a FeatureCollection as GeoJSON")
    try:
        features = json.loads(text, object_pairs_hook=_read_object)["features"]
        properly = all(_is_feature(feature) for feature in features)
    except (ValueError, LookupError, TypeError, RecursionError) as error:
        fault = f"is no GeoJSON FeatureCollection ({error})"
        raise StageError(f"{path}: {fault}; mend it, or write corrections.yaml") from None
    if not properly:
        raise StageError(f"{path}: a feature has no properties or no geometry; mend it")
    return [_of_feature(feature) for feature in features]


def _read_object(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object of JSON; of a key that stands twice one value would be lost silently."""
    values: dict[str, Any] = {}
    for key, value in pairs:
        if key in values:
            raise ValueError(f"duplicate key {key!r}")
        values[key] = value
    return values


def _is_feature(feature: Mapping[str, Any]) -> bool:
    return isinstance(feature["properties"], dict) and isinstance(feature["geometry"], dict)


def _of_feature(feature: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entry that a feature stands for.

    A point is a place, a line what is added, a polygon the outline of what stands about.
    """
    properties = {k: v for k, v in feature["properties"].items() if v is not None}
    geometry = feature["geometry"]
    corners = geometry.get("coordinates")
    if geometry.get("type") == "Polygon" and isinstance(corners, list) and len(corners) == 1:
        ring = corners[0]
        return {**properties, "outline": ring[:-1] if isinstance(ring, list) else ring}
    return {**properties, "at" if geometry.get("type") == "Point" else "line": corners}
