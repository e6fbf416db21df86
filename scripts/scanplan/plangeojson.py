"""The plan as GeoJSON, in the local metres of the survey."""

import json

import numpy as np

NOTE = (
    "Coordinates are metres in the survey's local map frame, not longitude and latitude: "
    "x and y are those of the localiser's map, north is unknown."
)


def dumps(faces, name):
    """Return the faces of a plan as the text of a GeoJSON FeatureCollection, one feature a line.

    RFC 7946 knows no coordinates but longitude and latitude; a plan has none, and says so in `note`.

    Parameters
    ----------
    faces : dict of str to (n,) array
        The columns of `schemas.FACES`.
    name : str
        The dataset's name.

    Returns
    -------
    str
        Coordinates rounded to 0.1 mm. The normal (nx, ny) points to the side the face was seen from, on the left of
        the way from its first point to its second.
    """
    features = [_feature(faces, i) for i in range(len(faces["face"]))]
    head = json.dumps({"type": "FeatureCollection", "name": name, "note": NOTE, "units": "m"}, ensure_ascii=False)
    lines = ",\n".join(json.dumps(feature, allow_nan=False) for feature in features)
    return f'{head[:-1]}, "features": [\n{lines}\n]}}\n'


def _feature(faces, i):
    x0_m, y0_m, x1_m, y1_m = (_rounded(faces[c][i], 4) for c in ("x0_m", "y0_m", "x1_m", "y1_m"))
    return {
        "type": "Feature",
        "id": int(faces["face"][i]),
        "properties": {
            "kind": "face",
            "face": int(faces["face"][i]),
            "length_m": _rounded(np.hypot(x1_m - x0_m, y1_m - y0_m), 4),
            "nx": _rounded(faces["nx"][i], 6),
            "ny": _rounded(faces["ny"][i], 6),
            "n_points": int(faces["n_points"][i]),
            "n_scans": int(faces["n_scans"][i]),
            **{c: _rounded(faces[c][i], 4) for c in ("rmse_m", "z_min_m", "z_max_m")},
        },
        "geometry": {"type": "LineString", "coordinates": [[x0_m, y0_m], [x1_m, y1_m]]},
    }


def _rounded(value, digits):
    # + 0.0 turns a negative zero into zero
    return round(float(value), digits) + 0.0
