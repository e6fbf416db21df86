"""Walls seen in single scans, merged into candidates of the plan's faces, each drawn once."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

from scanplan.geometry import lines
from scanplan.geometry.tolerances import ROUNDING
from scanplan.plan.faces import candidates, segment_groups
from scanplan.plan.faces.candidates import FaceCandidate, FaceT
from scanplan.types import Columns


@dataclass(frozen=True)
class MergeSettings:
    """When segments are one face, and when a face is believed.

    Attributes
    ----------
    max_angle_deg : float, above 0, below 90
        Segments whose normals turn further from the face's are not of it.
    tolerance_m : float, > 0
        Both ends of every segment of a face lie this close to it: what registration may be wrong
        by.
    merge_distance_m : float, >= tolerance_m
        Of two faces of one side that run closer than this, the stronger is drawn.
    ghost_distance_m : float, >= 0
        Likewise up to this distance, if the weaker shows
    ghost_share : float, 0 to 1
        less than this share of the stronger one's points per metre.
    max_gap_m : float, >= 0
        A longer gap along a face stays open.
    align_gap_m : float, >= 0
        Faces on either side of a gap up to this length share one line where their segments allow
        (a door in a wall). Up to `max_gap_m` it has no effect.
    registration_sigma_m : float, > 0
        Standard deviation of a registered scan's place, for the weights of the fit.
    corner_m : float, >= 0
        Ends this close to where two faces cross are moved there.
    min_length_m : float, >= 0
        Shorter faces are dropped,
    min_points_per_m : float, >= 0
        thinner ones too,
    min_scans : int, >= 1
        and those that fewer scans show (`faces`, by the points of all of them, with those of the
        wall's other side),
    lone_length_m : float, >= 0
        unless they are this long.
    """

    max_angle_deg: float
    tolerance_m: float
    merge_distance_m: float
    ghost_distance_m: float
    ghost_share: float
    max_gap_m: float
    align_gap_m: float
    registration_sigma_m: float
    corner_m: float
    min_length_m: float
    min_points_per_m: float
    min_scans: int
    lone_length_m: float

    def __post_init__(self) -> None:
        wrong = [f.name for f in fields(self) if not 0 <= getattr(self, f.name) < math.inf]
        wrong += [
            name
            for name in ("max_angle_deg", "tolerance_m", "registration_sigma_m")
            if not getattr(self, name)
        ]
        wrong += ["max_angle_deg"] * (math.cos(math.radians(self.max_angle_deg)) < ROUNDING)
        wrong += ["ghost_share"] * (self.ghost_share > 1)
        wrong += ["merge_distance_m"] * (self.merge_distance_m < self.tolerance_m)
        if wrong:
            raise ValueError(f"merge settings out of range: {', '.join(dict.fromkeys(wrong))}")

    def remove_doubles(self, faces: Sequence[FaceT]) -> list[FaceT]:
        """Return faces without what stronger ones draw, see `candidates.remove_doubles`."""
        return candidates.remove_doubles(
            faces,
            max_angle_rad=math.radians(self.max_angle_deg),
            distance_m=self.merge_distance_m,
            ghost_distance_m=self.ghost_distance_m,
            ghost_share=self.ghost_share,
        )

    def supports(self, candidate: FaceCandidate) -> bool:
        """Return whether a candidate is long and dense enough to be observed.

        How many scans show it is better known from all their points (`tracing`).
        """
        least = max(1, self.min_points_per_m * candidate.length_m)
        return candidate.n_points >= least and candidate.length_m >= self.min_length_m


def merge_segments(walls: Columns, settings: MergeSettings) -> list[FaceCandidate]:
    """Merge the wall segments of many scans into candidates of faces on common lines.

    Segments are grouped around common lines (`segment_groups`); each group's line is cut at gaps,
    what too little supports is dropped, and so is what weaker faces draw over stronger ones
    (`candidates`). The two sides of a wall are different lines. Neither the order of the rows nor
    the place and turn of the map frame matters.

    Parameters
    ----------
    walls : dict of str to (n,) array
        The columns of `schemas.WALLS`.
    settings : MergeSettings

    Returns
    -------
    list of FaceCandidate
        Those of one group share one line.

    Raises
    ------
    ValueError
        If a number of the walls is not finite.
    """
    segments = lines.observed_segments(walls, registration_sigma_m=settings.registration_sigma_m)
    if len(segments.start) == 0:
        return []
    limits = segment_groups.GroupLimits(
        max_angle_rad=math.radians(settings.max_angle_deg),
        tolerance_m=settings.tolerance_m,
        reach_m=max(settings.max_gap_m, settings.align_gap_m),
    )
    groups = segment_groups.group_segments(segments, limits)
    supported = [
        candidate
        for members in groups
        for candidate in candidates.cut_candidates(segments, members, max_gap_m=settings.max_gap_m)
        if settings.supports(candidate)
    ]
    single = settings.remove_doubles(supported)
    return [candidate for candidate in single if settings.supports(candidate)]
