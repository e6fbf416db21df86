"""Faces, to be found by where they are."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.plan.faces.intervals import FaceInterval


class FaceTree:
    """Faces of a plan, to be found by where they are.

    Parameters
    ----------
    faces : sequence of intervals.FaceInterval
    """

    def __init__(self, faces: Sequence[FaceInterval]) -> None:
        self._faces = np.array([*faces, None], object)[:-1]
        self._ends_m = np.array([face.ends for face in faces]).reshape(-1, 2, 2)
        self._tree = shapely.STRtree(np.asarray(shapely.linestrings(self._ends_m), object))

    def within(self, shape: BaseGeometry, distance_m: float) -> list[FaceInterval]:
        """Return the faces no farther from a shape than a distance, in their order."""
        rows = self._tree.query(shape, predicate="dwithin", distance=distance_m)
        return self._faces[np.sort(rows)].tolist()
