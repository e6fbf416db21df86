"""Wall segments known from earlier: of the same points, by the same code and settings.

Whether they are the same is told by a digest of all that a scan's segments depend on, which lies
beside the segments in their table.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from scanplan.errors import StageError
from scanplan.extraction.extractors import WallFinder, find_wall_segments
from scanplan.extraction.segments import WallSegments, segment_columns
from scanplan.store import schemas, tables
from scanplan.types import Array, Columns, FilePath, FloatArray, IntArray, Settings

_DIGESTS = "digests"


def digest_recipe(extractor: str, settings: Settings, code: str) -> bytes:
    """Return a digest of what the segments of all scans depend on beside their points.

    Parameters
    ----------
    code : str
        What names the code of the extraction.
    """
    recipe = json.dumps([extractor, settings, code], sort_keys=True)
    return hashlib.blake2b(recipe.encode()).digest()


def find_unknown_segments(
    scan_id: int,
    xyz_m: FloatArray,
    *,
    recipe: bytes,
    known: Sequence[str],
    sensor_xyz_m: FloatArray,
    finder: WallFinder,
) -> tuple[str, WallSegments | None]:
    """Extract the wall segments of one scan, unless they are known.

    Parameters
    ----------
    xyz_m : (n, 3) float
        The scan's points, map frame.
    recipe : bytes
        See `digest_recipe`.
    known : sequence of str
        Digests of scans whose segments are known.
    sensor_xyz_m, finder
        See `extractors.find_wall_segments`.

    Returns
    -------
    digest : str
        Of all that the segments depend on.
    segments : WallSegments or None
        None where they are known.
    """
    # of all scans that will ever be recorded no two share 16 bytes by chance
    total = hashlib.blake2b(recipe, digest_size=16)
    place_m = np.asarray(sensor_xyz_m, float).tolist()
    total.update(json.dumps([scan_id, finder.planar, *place_m]).encode())
    total.update(np.ascontiguousarray(xyz_m).data)
    digest = total.hexdigest()
    if digest in known:
        return digest, None
    return digest, find_wall_segments(scan_id, xyz_m, sensor_xyz_m=sensor_xyz_m, finder=finder)


class KnownSegments:
    """The wall segments in some tables, by the digests of their scans.

    Parameters
    ----------
    paths : iterable of path-like
        Tables of walls; one that is missing, damaged or says no digests tells nothing.
    """

    def __init__(self, paths: Iterable[FilePath]) -> None:
        self._columns: dict[str, Columns] = {}
        self._digests: dict[int, list[str]] = {}
        for path in paths:
            self._read(path)

    def _read(self, path: FilePath) -> None:
        try:
            digests = json.loads(tables.read_note(path, schemas.WALLS, _DIGESTS) or "{}")
            columns = tables.read_table(path, schemas.WALLS, allow_empty=True)
        except StageError:
            return
        for name, digest in digests.items():
            scan_id = int(name)
            first, last = np.searchsorted(columns["scan_id"], [scan_id, scan_id + 1])
            self._columns[digest] = {name: values[first:last] for name, values in columns.items()}
            self._digests.setdefault(scan_id, []).append(digest)

    def list_digests(self, scan_id: int) -> list[str]:
        """Return the digests under which segments of a scan are known."""
        return self._digests.get(scan_id, [])

    def complete(
        self, scan_ids: IntArray, found: Sequence[tuple[str, WallSegments | None]]
    ) -> dict[str, Array]:
        """Return the columns of the table of walls, of new segments and of known ones.

        Parameters
        ----------
        scan_ids : (n,) int, increasing
        found : sequence of n (str, WallSegments or None)
            See `find_unknown_segments`.
        """
        new = [
            (scan_id, segments)
            for scan_id, (_, segments) in zip(scan_ids, found, strict=True)
            if segments is not None
        ]
        parts: list[Mapping[str, Array]] = [
            segment_columns([scan_id for scan_id, _ in new], [segments for _, segments in new])
        ]
        parts += [self._columns[digest] for digest, segments in found if segments is None]
        stacked = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        order = np.lexsort([stacked["wall"], stacked["scan_id"]])
        return {name: values[order] for name, values in stacked.items()}


def note_digests(
    scan_ids: IntArray, found: Sequence[tuple[str, WallSegments | None]]
) -> dict[str, str]:
    """Return the note of a table of walls that says which segments it has, for `KnownSegments`."""
    digests = [digest for digest, _ in found]
    return {_DIGESTS: json.dumps(dict(zip(scan_ids.tolist(), digests, strict=True)))}


def join_notes(notes: Iterable[Mapping[str, str]]) -> dict[str, str]:
    """Return the notes of the table that holds the rows of several, of other scans each."""
    digests: dict[str, str] = {}
    for of_table in notes:
        digests |= json.loads(of_table.get(_DIGESTS, "{}"))
    return {_DIGESTS: json.dumps(digests)} if digests else {}
