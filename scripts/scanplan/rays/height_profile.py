"""What becomes of rays at a stretch of a surface, height by height.

Whether rays end at the face, in the depth of a wall behind it, or come out beyond (or never come
back, where something opaque would have returned them) tells the states of a surface apart: solid,
recessed, open. Each is a Dirichlet-multinomial distribution over these three ends, so that many
rays of few scans do not count as many proofs: Minka (2000), Estimating a Dirichlet distribution.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.rays import expected_returns
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.face_rays import FaceRays, cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW, NEAR_FLOOR_M
from scanplan.types import FloatArray

ROWS_M = np.arange(1, 29, 2) / 10  # edges: of beams 2 degrees apart two meet 0.2 m at 3 m
EYE_ROWS = slice(6, 8)  # 1.3 to 1.7 m: sills are lower, lintels are higher
_SOLID, _RECESSED, _OPEN = range(3)
_ENDS = np.array(((9, 0.5, 0.5), (0.5, 9, 0.5), (0.5, 1, 2)))
# of ten rays as many as end at the face, in the wall, and beyond it, in each state: the reveals,
# frames and panes of an opening end a third
_ODD_SHARE = 0.02  # of rows show anything: edges, things in an opening, heights that err


@dataclass(frozen=True, eq=False)
class HeightProfile:
    """Rays that reached a stretch of a surface, by rows of height (r, 3) and in all.

    Attributes
    ----------
    ends : (r, 3) float64
        How many ended at the face, in the wall behind it, and beyond or never, in each row.
    n_floor : int
        How many came down to the floor behind the face.
    open_share : float
        On what share of the length more rays went on than ended at some height of windows.
    n_lost : float
        How many never came back: of those that count as ended beyond or never.
    """

    ends: FloatArray
    n_floor: int
    open_share: float
    n_lost: float = 0.0

    def __add__(self, other: "HeightProfile") -> "HeightProfile":
        """Return what two sides of a wall show together."""
        return HeightProfile(
            self.ends + other.ends,
            self.n_floor + other.n_floor,
            max(self.open_share, other.open_share),
            self.n_lost + other.n_lost,
        )

    @property
    def is_hidden(self) -> bool:
        """Whether hardly a ray reached the lowest half metre: something stands before it."""
        return bool(self.ends[:2].sum() < FEW)

    @property
    def is_into_nothing(self) -> bool:
        """Whether most of what went on never came back: nothing is near beyond."""
        return 2 * self.n_lost > self.n_through.sum()

    @property
    def n_through(self) -> FloatArray:
        """How many rays of each row (r,) ended beyond, or never."""
        return self.ends[:, _OPEN]

    def log_likelihoods(self) -> tuple[FloatArray, FloatArray]:
        """Return how likely each row (r,) is if it is wall, solid or recessed, and if it is open.

        Logarithms; rows without rays say nothing, and no row alone says all: what it shows may be
        of something else.
        """
        from scipy import special  # 0.2 s, and few stages ask this

        count = self.ends[:, None]
        total = count.sum(axis=2)
        of_ends = special.gammaln(count + _ENDS) - special.gammaln(_ENDS)
        of_total = special.gammaln(_ENDS.sum(axis=1))
        likely = of_ends.sum(axis=2) + of_total - special.gammaln(total + _ENDS.sum(axis=1))
        wall = np.logaddexp(likely[:, _SOLID], likely[:, _RECESSED]) - np.log(2)
        anything = special.gammaln(count[:, 0] + 1).sum(axis=1) + special.gammaln(3)
        anything += np.log(_ODD_SHARE) - special.gammaln(total[:, 0] + 3)
        return np.logaddexp(wall, anything), np.logaddexp(likely[:, _OPEN], anything)


def observe_heights(
    rays: RaySet,
    line: Line,
    low_m: float,
    high_m: float,
    *,
    band_m: float,
    deep_m: float = expected_returns.DEEP_M,
) -> HeightProfile:
    """Return what becomes of the rays from the side of a line's normal at a stretch of it.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    low_m, high_m : float
        The stretch along the line.
    band_m : float, > 0
        Returns this near to the line are at the face.
    deep_m : float
        Those this near behind it are in the wall.
    """
    face = cast_at_face(
        *(rays, line, low_m, high_m),
        at_m=band_m,
        occluded_within_m=expected_returns.NEAR_M,
    )
    is_reaching = face.is_facing & (face.behind_m >= -band_m)
    is_reaching &= (face.along_m >= low_m) & (face.along_m <= high_m)
    state = np.select(
        [face.behind_m <= band_m, face.behind_m <= deep_m],
        [_SOLID, _RECESSED],
        _OPEN,
    )
    n_rows, n_columns = len(ROWS_M) - 1, max(int((high_m - low_m) / CELL_M), 1)
    row = np.searchsorted(ROWS_M, face.height_m, "right") - 1
    row = np.zeros_like(row) if rays.planar else row
    is_counted = is_reaching & (row >= 0) & (row < n_rows)
    column = np.clip(((face.along_m - low_m) / CELL_M).astype(np.int64), 0, n_columns - 1)
    cell = ((row * n_columns + column) * 3 + state)[is_counted]
    ends = np.bincount(cell, minlength=n_rows * n_columns * 3).astype(float)
    ends = ends.reshape(n_rows, n_columns, 3)
    lost = _count_lost(rays, face, low_m, n_columns)
    ends[:, :, _OPEN] += lost
    # some row of these is between the sill and the lintel of any window
    around_eye = slice(EYE_ROWS.start - 2, EYE_ROWS.stop + 1)
    is_open = (ends[around_eye, :, _OPEN] > ends[around_eye, :, _SOLID]).any(axis=0)
    is_on_floor = is_reaching & (state != _SOLID)
    is_on_floor &= np.abs(_heights_of_returns_m(rays, face)) <= NEAR_FLOOR_M
    return HeightProfile(
        ends.sum(axis=1), int(is_on_floor.sum()), float(is_open.mean()), float(lost.sum())
    )


def _heights_of_returns_m(rays: RaySet, face: FaceRays) -> FloatArray:
    """Return how high above the floor rays ended, by where they met the plane over the line."""
    sensor_m = rays.sensors_m[face.scan, 2] - rays.floor_z_m
    side_m = np.abs(face.views.side_m).take(face.view)
    gone = 1 + np.maximum(face.behind_m, 0.0) / side_m
    return sensor_m + gone * (face.height_m - sensor_m)


def _count_lost(rays: RaySet, face: FaceRays, low_m: float, n_columns: int) -> FloatArray:
    """Return how many rays of each row and column (r, c) reached it and never came back."""
    lost = np.zeros((len(ROWS_M) - 1, n_columns))
    if rays.planar:
        every_m = expected_returns.ALL_HEIGHTS_M
        sent = expected_returns.count_sent_rays(rays, face, low_m, n_columns, CELL_M, every_m)
        lost[0] = sent.lost()
        return lost
    # of two rows together: single ones expect too few rays
    for row in range(0, len(lost), 2):
        heights_m = ROWS_M[row], ROWS_M[min(row + 2, len(lost))]
        sent = expected_returns.count_sent_rays(rays, face, low_m, n_columns, CELL_M, heights_m)
        lost[row : row + 2] = sent.lost() / 2
    return lost
