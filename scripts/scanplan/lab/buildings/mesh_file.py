"""Reading the triangles of a building, in metres: STL, OBJ and PLY."""

import io

import numpy as np
import trimesh

from scanplan.errors import StageError
from scanplan.lab.buildings.tolerances import DRAWN_M, MAX_EXTENT_M, MESHING_M
from scanplan.recordings.units import METRES
from scanplan.types import FilePath, FloatArray

MIN_EXTENT_M = 1.5  # a smaller floor has no room for a rover
MAX_HEIGHT_M = 60.0  # a higher one is in another unit, or a tower to cut a floor out of
_STOREY_HEIGHTS_M = (2.0, 12.0)  # of one storey, halls among them, to guess a unit by

_STL_HEADER = np.dtype([("text", "S80"), ("count", "<u4")])  # of a binary STL
_STL_FACE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def parse_mesh(
    data: bytes, suffix: str, source: FilePath, *, unit: str = "m"
) -> tuple[FloatArray, tuple[str, ...]]:
    """Read a mesh.

    Parameters
    ----------
    suffix : str
        `.stl`, `.obj` or `.ply`: the format.
    source : path-like
        What errors name as their origin.
    unit : str
        Of the file's coordinates, one of `METRES`; none of the formats states it.

    Returns
    -------
    triangles_m : (t, 3, 3) float64
        None of zero area.
    notes : tuple of str
        What is odd and used all the same: faces dropped, holes.

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
    is_flat = _areas(triangles_m) <= MESHING_M * DRAWN_M
    n_flat = np.count_nonzero(is_flat)
    n_infinite = np.count_nonzero(~finite)
    triangles_m = triangles_m[~is_flat]
    if not len(triangles_m):
        raise StageError(
            f"{source}: holds {len(triangles)} faces, none with an area; export the building's"
            " surfaces"
        )
    notes = [
        f"{source}: {count} of {len(triangles)} faces {fault} dropped"
        for count, fault in ((n_flat, "of zero area"), (n_infinite, "with coordinates not finite"))
        if count
    ]
    return triangles_m, (*notes, *_describe_holes(triangles_m, source))


def _triangles(data: bytes, suffix: str, source: FilePath) -> FloatArray:
    file_type = suffix[1:]
    try:
        # process=False keeps the corners as they are; no resolver, so that no other file is read
        mesh = trimesh.load_mesh(io.BytesIO(data), file_type=file_type, process=False)
        triangles = np.array(mesh.triangles, float).reshape(-1, 3, 3)
    # trimesh's readers raise whatever their parsing meets
    except Exception as error:
        reason = str(error).splitlines()[0][:120] if str(error) else type(error).__name__
        raise StageError(
            f"{source}: cannot be read as {file_type.upper()} ({reason}); it is cut off or of"
            " another format, export it again"
        ) from None
    if not len(triangles):
        raise StageError(
            f"{source}: holds no faces; export the building's surfaces as {file_type.upper()}"
        )
    return triangles


def _check_stl(data: bytes, source: FilePath) -> None:
    """Refuse an STL that was cut off, which its readers pass over."""
    is_ascii = data.lstrip()[:5].lower() == b"solid"
    n_header = _STL_HEADER.itemsize
    header = np.frombuffer(data[:n_header].ljust(n_header, b"\0"), _STL_HEADER)
    count = int(header["count"][0])
    size = n_header + count * _STL_FACE.itemsize
    if len(data) == size:
        return
    if is_ascii and b"facet" in data[:2000]:
        if b"endsolid" not in data[-2000:]:
            raise StageError(
                f"{source}: has no `endsolid`, the ASCII STL is cut off; export or copy it again"
            )
        return
    if is_ascii and b"endsolid" in data:
        raise StageError(f"{source}: holds no faces; export the building's surfaces as STL")
    raise StageError(
        f"{source}: has {len(data)} bytes, its header announces {count} faces ({size} bytes); the"
        " binary STL is cut off or no STL, export or copy it again"
    )


def _check_size(triangles: FloatArray, unit: str, source: FilePath) -> None:
    if not len(triangles):
        raise StageError(f"{source}: no coordinate is finite; export it again")
    corners = triangles.reshape(-1, 3)
    extent_m = np.ptp(corners, axis=0) * METRES[unit]
    spanned = " x ".join(f"{side_m:g}" for side_m in np.round(extent_m, 3))
    if extent_m[:2].max() > MAX_EXTENT_M or extent_m[2] > MAX_HEIGHT_M:
        guess = _likely_unit(corners)
        remedy = f"set simulate.site.unit: {guess}"
        if guess is None:
            remedy = "set simulate.site.unit, or cut out a floor"
        raise StageError(
            f"{source}: spans {spanned} m in {unit}, the limits are {MAX_EXTENT_M:g} m and"
            f" {MAX_HEIGHT_M:g} m of height; {remedy}"
        )
    if extent_m[:2].max() < MIN_EXTENT_M:
        raise StageError(
            f"{source}: spans {spanned} m, no room for a rover (at least {MIN_EXTENT_M:g} m);"
            f" its coordinates are not in {unit}, set simulate.site.unit"
        )


def _likely_unit(corners: FloatArray) -> str | None:
    """Return the unit in which both width and height are those of one storey, None if none is."""
    width = np.ptp(corners[:, :2], axis=0).max()
    height = np.ptp(corners[:, 2])
    low_m, high_m = _STOREY_HEIGHTS_M
    for unit, metres in METRES.items():
        if low_m <= height * metres <= high_m and width * metres >= MIN_EXTENT_M:
            return unit
    return None


def _areas(triangles: FloatArray) -> FloatArray:
    a, b, c = np.moveaxis(triangles, 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def _describe_holes(triangles_m: FloatArray, source: FilePath) -> tuple[str, ...]:
    """Return a note of edges that only one face has.

    Rays pass there, and walls with such edges are cut as sheets.
    """
    _, corner = np.unique(np.round(triangles_m.reshape(-1, 3), 6), axis=0, return_inverse=True)
    a, b, c = corner.reshape(-1, 3).T
    edges = np.sort(np.concatenate([np.c_[a, b], np.c_[b, c], np.c_[c, a]]), axis=1)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    n_open = int(np.count_nonzero(uses % 2))
    return (f"{source}: has holes ({n_open} open edges); rays pass through them",) if n_open else ()
