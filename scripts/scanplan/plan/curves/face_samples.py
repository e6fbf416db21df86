"""Places that a face's points lie at, column by column, with how far each may be off."""

from dataclasses import dataclass

import numpy as np

from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.tolerances import ENOUGH_RAYS
from scanplan.rays.face_raster import CELL_M
from scanplan.types import FloatArray

_LEAST_COLUMNS = 4  # fewer show no curvature beside noise
_LEAST_VARIANCE_M2 = 1e-8  # a tenth of a millimetre: what ranges are rounded to at best


@dataclass(frozen=True, eq=False)
class FaceSamples:
    """A face of a wall by its columns.

    Attributes
    ----------
    face : intervals.FaceInterval
    xy_m : (n, 2) float64
        The mean place of each column's points, scan by scan.
    variance : (n,) float64
        Of each, across the face, square metres: by how scans differ there, and no less than the
        columns scatter about a smooth curve.
    misfit : float
        Sum of their squared distances from a line of their own, in variances.
    """

    face: FaceInterval
    xy_m: FloatArray
    variance: FloatArray
    misfit: float


def sample_face(face: FaceInterval) -> FaceSamples | None:
    """Return a face's samples; None of one that is too short, or that too few points show."""
    observation, points = face.observation, face.points
    if face.n_points < ENOUGH_RAYS:
        return None
    column = np.floor((observation.occupied_m[points] - face.low_m) / CELL_M).astype(np.int64)
    scan = observation.occupied_scan[points]
    # as one number: pairs are sorted ten times as slowly
    n_scans_most = int(scan.max(initial=0)) + 1
    pairs = column * n_scans_most + scan
    of_pair, pair, count = np.unique(pairs, return_inverse=True, return_counts=True)
    places = np.stack([observation.occupied_m[points], observation.occupied_off_m[points]])
    along_m, off_m = (np.bincount(pair, of) / count for of in places)
    of_column = of_pair // n_scans_most
    _, row, n_scans = np.unique(of_column, return_inverse=True, return_counts=True)
    if len(n_scans) < _LEAST_COLUMNS:
        return None
    x_m, y_m = (np.bincount(row, of) / n_scans for of in (along_m, off_m))
    between_scans = np.sum((off_m - y_m[row]) ** 2) / max(len(row) - len(n_scans), 1)
    variance = np.maximum(between_scans / n_scans, _LEAST_VARIANCE_M2)
    variance *= max(_misfit(x_m, y_m, variance, 2) / (len(x_m) - 3), 1.0)
    xy_m = observation.line.at(x_m) + y_m[:, None] * observation.line.normal
    return FaceSamples(face, xy_m, variance, _misfit(x_m, y_m, variance, 1))


def _misfit(x_m: FloatArray, y_m: FloatArray, variance: FloatArray, degree: int) -> float:
    """Return the squared distances from a fitted polynomial of a degree, in variances."""
    fitted = np.polynomial.Polynomial.fit(x_m, y_m, degree, w=variance**-0.5)
    return float(np.sum((y_m - fitted(x_m)) ** 2 / variance))
