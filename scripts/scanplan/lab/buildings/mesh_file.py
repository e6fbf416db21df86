"""Reading the triangles of a building: STL, OBJ and PLY, told in metres."""

import io

import numpy as np
import trimesh

from scanplan.errors import StageError

SUFFIXES = (".stl", ".obj", ".ply")
METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
MIN_EXTENT_M, MAX_EXTENT_M, MAX_HEIGHT_M = 1.5, 2000.0, 60.0
# what one storey may measure, to guess a unit by
_LOW_M, _HIGH_M, _WIDE_M = 2.0, 12.0, 3.0
# below this a triangle's area is that of two corners 0.1 mm apart on an edge of 1 mm
_MIN_AREA_M2 = 1e-7
_STL_HEADER, _STL_RECORD = 84, 50


def parse_mesh(data, suffix, source, *, unit="m"):
    """Read a mesh.

    Parameters
    ----------
    data : bytes
    suffix : str
        One of `SUFFIXES`; it tells the format.
    source : path-like
        What errors name as their origin.
    unit : str
        What one step of the file's coordinates is, one of `METRES`; none of the formats says it.

    Returns
    -------
    triangles_m : (t, 3, 3) float64
        None of zero area.
    notes : tuple of str
        What was found odd and is used all the same: faces dropped, holes.

    Raises
    ------
    StageError
        If the file is empty, cut off or of another format, or its size is that of no building.
    """
    if unit not in METRES:
        raise ValueError(f"unit {unit!r} is none of {', '.join(METRES)}")
    if not data:
        raise StageError(f"{source}: is empty (0 bytes); export it again")
    if suffix == ".stl":
        _check_stl(data, source)
    triangles = _triangles(data, suffix, source)
    finite = np.isfinite(triangles).all(axis=(1, 2))
    _check_size(triangles[finite], unit, source)
    triangles_m = triangles[finite] * METRES[unit]
    flat = _area(triangles_m) <= _MIN_AREA_M2
    kept = triangles_m[~flat]
    if not len(kept):
        raise StageError(
            f"{source}: holds {len(triangles)} faces, none with an area; export the building's surfaces"
        )
    dropped = [
        (np.count_nonzero(flat), "of zero area"),
        (np.count_nonzero(~finite), "with coordinates not finite"),
    ]
    notes = [
        f"{source}: {count} of {len(triangles)} faces {what} dropped"
        for count, what in dropped
        if count
    ]
    return kept, (*notes, *_holes(kept, source))


def _triangles(data, suffix, source):
    try:
        # process=False keeps the corners as they are; no resolver, so that no other file is read
        loaded = trimesh.load_mesh(io.BytesIO(data), file_type=suffix[1:], process=False)
        triangles = np.array(loaded.triangles, float).reshape(-1, 3, 3)
    # trimesh's readers raise whatever their parsing meets
    except Exception as error:
        told = str(error).splitlines()[0][:120] if str(error) else type(error).__name__
        raise StageError(
            f"{source}: cannot be read as {suffix[1:].upper()} ({told}); it is cut off or of another format,"
            " export it again"
        ) from None
    if not len(triangles):
        raise StageError(
            f"{source}: holds no faces; export the building's surfaces as {suffix[1:].upper()}"
        )
    return triangles


def _check_stl(data, source):
    """Refuse an STL that was cut off, which its readers pass over."""
    count = int.from_bytes(data[80:_STL_HEADER], "little") if len(data) >= _STL_HEADER else 0
    if len(data) == _STL_HEADER + count * _STL_RECORD and len(data) >= _STL_HEADER:
        return
    if data.lstrip()[:5].lower() == b"solid" and b"facet" in data[:2000]:
        if b"endsolid" not in data[-2000:]:
            raise StageError(
                f"{source}: has no `endsolid`, the ASCII STL is cut off; export or copy it again"
            )
        return
    if data.lstrip()[:5].lower() == b"solid" and b"endsolid" in data:
        raise StageError(f"{source}: holds no faces; export the building's surfaces as STL")
    raise StageError(
        f"{source}: has {len(data)} bytes, its header announces {count} faces ({_STL_HEADER + count * _STL_RECORD}"
        " bytes); the binary STL is cut off or no STL, export or copy it again"
    )


def _check_size(triangles, unit, source):
    if not len(triangles):
        raise StageError(f"{source}: no coordinate is finite; export it again")
    corners = triangles.reshape(-1, 3)
    extent_m = np.ptp(corners, axis=0) * METRES[unit]
    if extent_m[:2].max() > MAX_EXTENT_M or extent_m[2] > MAX_HEIGHT_M:
        guess = _likely(corners)
        remedy = (
            f"set simulate.site.unit: {guess}"
            if guess
            else "set simulate.site.unit, or cut out a floor"
        )
        raise StageError(
            f"{source}: spans {_by(extent_m)} m in {unit}, the limits are {MAX_EXTENT_M:g} m and {MAX_HEIGHT_M:g} m of"
            f" height; {remedy}"
        )
    if extent_m[:2].max() < MIN_EXTENT_M:
        raise StageError(
            f"{source}: spans {_by(extent_m)} m, no room for a rover (at least {MIN_EXTENT_M:g} m);"
            f" its coordinates are not in {unit}, set simulate.site.unit"
        )


def _likely(corners):
    """The unit in which both width and height are those of one storey; None if there is no such unit."""
    width, height = np.ptp(corners[:, :2], axis=0).max(), np.ptp(corners[:, 2])
    fits = (
        u for u, m in METRES.items() if _LOW_M <= height * m <= _HIGH_M and width * m >= _WIDE_M
    )
    return next(fits, None)


def _by(extent_m):
    return " x ".join(f"{side:g}" for side in np.round(extent_m, 3))


def _area(triangles):
    a, b, c = np.moveaxis(triangles, 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def _holes(triangles_m, source):
    """Tell of edges that only one face has: rays pass there, and walls with such edges are cut as sheets."""
    _, corner = np.unique(np.round(triangles_m.reshape(-1, 3), 6), axis=0, return_inverse=True)
    a, b, c = corner.reshape(-1, 3).T
    edges = np.sort(np.concatenate([np.c_[a, b], np.c_[b, c], np.c_[c, a]]), axis=1)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    open_edges = int(np.count_nonzero(uses % 2))
    return (
        (f"{source}: has holes ({open_edges} open edges); rays pass through them",)
        if open_edges
        else ()
    )
