"""What the rays of one scan show of a face.

How high it is, what passes over and through it, which expected returns are missing.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.rays.expected_returns import count_sent_rays
from scanplan.rays.face_raster import BELOW_CEILING_M, SCAN_COLUMN_M, rasterise_rays
from scanplan.rays.face_rays import ON_M, SKIRTING_M, cast_at_face
from scanplan.rays.ray_set import RaySet

BEHIND_M = 0.15  # a return farther behind a face is not its own: noise of ranges
_EDGE_ON_M = 1e-3  # a face nearer to the sensor is seen edge on
_GOOD_SHARE = 0.15  # of rays: fewer may be stray


@dataclass(frozen=True)
class FaceEvidence:
    """What rays show of a face.

    Attributes
    ----------
    top_m : float
        Height above the floor up to which it is seen over a good part of its length.
    over : float
        How surely it ends at some height, see `face_raster.FaceRaster.over_share`.
    through : float
        Rays through it below its top, per ray that ends at it.
    missing : float
        Share of the returns expected within its outline that are nowhere.
    """

    top_m: float
    over: float
    through: float
    missing: float


def weigh_face(
    rays: RaySet, line: Line, span_m: tuple[float, float], heights_m: tuple[float, float]
) -> FaceEvidence:
    """Return what one scan's rays show of a face.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    span_m : (float, float)
        The face along the line.
    heights_m : (float, float)
        Of its returns, above the floor.
    """
    face = cast_at_face(rays, line, *span_m, at_m=ON_M, least_side_m=_EDGE_ON_M)
    is_on = face.is_occupied
    is_beyond = face.is_free(BEHIND_M)
    is_raised = face.height_m > SKIRTING_M
    raster = rasterise_rays(
        (face.along_m[is_on], face.height_m[is_on]),
        (face.along_m[is_beyond], face.height_m[is_beyond]),
        (np.empty(0), np.empty(0)),
        span_m=span_m,
        column_m=SCAN_COLUMN_M,
        high_m=BELOW_CEILING_M,
    )
    top_m = raster.seen_top_m()
    n_through = (is_beyond & is_raised & (face.height_m < top_m)).sum()
    sent = count_sent_rays(rays, face, span_m[0], len(raster), raster.column_m, heights_m)
    through = n_through / max((is_on & is_raised).sum(), 1)
    return FaceEvidence(top_m, raster.over_share(), through, sent.missing_share)


def gap_leads_on(rays: RaySet, line: Line, span_m: tuple[float, float], depth_m: float) -> bool:
    """Return whether a gap in a wall leads on, as a door does and a niche does not.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    span_m : (float, float)
        The gap along the line.
    depth_m : float
        A niche is no deeper.

    Returns
    -------
    bool
        Whether a good part of the rays through it get deeper; true if there are none.
    """
    face = cast_at_face(rays, line, *span_m, at_m=ON_M, least_side_m=_EDGE_ON_M)
    behind_m = face.behind_m[face.is_free(BEHIND_M) & (face.height_m > SKIRTING_M)]
    return not len(behind_m) or bool(np.mean(behind_m > depth_m) > _GOOD_SHARE)
