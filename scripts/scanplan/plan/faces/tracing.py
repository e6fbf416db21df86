"""The faces of the plan.

Lines that segments agree on, cut to what the points and rays of the chosen scans show.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import shapely

from scanplan.geometry.lines import Line
from scanplan.plan.faces import candidates, intervals, trimming
from scanplan.plan.faces.candidates import FaceCandidate
from scanplan.plan.faces.face_tree import FaceTree
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.faces.merging import MergeSettings
from scanplan.plan.faces.owned_points import owned_intervals
from scanplan.plan.tolerances import END_M, FACE_M
from scanplan.plan.wall_pairs import PairSettings
from scanplan.rays.face_observation import FaceObservation, RaySettings
from scanplan.rays.ray_set import RaySet


@dataclass(frozen=True, eq=False)
class TracedFaces:
    """Faces traced, and how many lines were dropped.

    Attributes
    ----------
    faces : list of intervals.FaceInterval
    n_lines : int
    n_dropped : int
        Lines of which nothing is left: too little seen, or drawn by a stronger one.
    """

    faces: list[FaceInterval]
    n_lines: int
    n_dropped: int


def trace_faces(
    face_candidates: Sequence[FaceCandidate],
    rays: RaySet,
    merging: MergeSettings,
    reading: RaySettings,
    pairing: PairSettings,
) -> TracedFaces:
    """Trace the faces along the lines of candidates.

    The passes, and why they are in this order:

    1. Observe (`_observe_lines`): each common line is refitted to the points at it, once; every
       later pass reads this observation.
    2. First intervals (`_FaceSelection.select_walls`): the solid intervals of each line, whatever
       crosses it. Those too little supported, with what may be the wall's other side, go first, so
       that none of them takes away from others; then doubles. Only what stays may own points of
       another line.
    3. Owned points (`owned_intervals`): where those faces cross other lines, the points at a
       crossing are theirs.
    4. Second intervals (`select_walls` again): the observations are cut anew, without the owned
       points. So what pass 2 removed is back, and intervals begin and end elsewhere: support and
       doubles are asked of these once more.
    5. Trim (`trim`): chords of a curve where they overshoot each other, then tails of stray points
       behind crossing faces, then stubs that are left. Before corners, since an end moves no
       farther than `corner_m`: it must first be where the face ends.
    6. Meet (`meet_at_corners`): ends are moved to where lines cross. Some faces reach the line
       that they end at only now, so tails are trimmed a second time; extents and points per metre
       have changed, so doubles are removed a third time, which also leaves the strongest face
       first. Stubs that are left go last.

    Parameters
    ----------
    face_candidates : list of candidates.FaceCandidate
        Those of one group share their line.
    rays : ray_set.RaySet
    merging : merging.MergeSettings
    reading : face_observation.RaySettings
    pairing : wall_pairs.PairSettings

    Returns
    -------
    TracedFaces
        Its faces meet at corners, none beside a stronger one.
    """
    selection = _FaceSelection(merging, pairing)
    find_intervals = partial(
        intervals.find_face_intervals,
        door_height_m=reading.door_height_m,
        max_gap_m=reading.max_gap_m,
    )
    observations = _observe_lines(face_candidates, rays, reading)
    owners = selection.select_walls(find_intervals(observation) for observation in observations)
    owned_m = owned_intervals(observations, owners)
    walls = selection.select_walls(
        find_intervals(observation, foreign_m=spans_m)
        for observation, spans_m in zip(observations, owned_m, strict=True)
    )
    faces = selection.meet_at_corners(selection.trim(walls))
    n_traced = len({face.observation for face in faces})
    return TracedFaces(
        faces=faces,
        n_lines=len(observations),
        n_dropped=len(observations) - n_traced,
    )


def _observe_lines(
    face_candidates: Iterable[FaceCandidate], rays: RaySet, reading: RaySettings
) -> list[FaceObservation]:
    """Return the observation of each line that candidates share, from the first to the last."""
    of_line: dict[Line, list[FaceCandidate]] = {}
    for candidate in face_candidates:
        of_line.setdefault(candidate.line, []).append(candidate)

    def observe_line(group: Sequence[FaceCandidate]) -> FaceObservation:
        low_m = min(candidate.low_m for candidate in group)
        high_m = max(candidate.high_m for candidate in group)
        return intervals.observe_along(
            rays,
            group[0].line,
            low_m,
            high_m,
            band_m=reading.band_m,
            reach_m=reading.reach_m,
        )

    # one after the other: two threads would wait for each other's many short steps
    return [observe_line(group) for group in of_line.values()]


@dataclass(frozen=True)
class _FaceSelection:
    """Which intervals are faces of walls, and how much of each."""

    merging: MergeSettings
    pairing: PairSettings

    def select_walls(self, of_lines: Iterable[Sequence[FaceInterval]]) -> list[FaceInterval]:
        """Return the intervals, listed by line, that are walls.

        Supported, none beside a stronger one.
        """
        dense = [self._find_dense(of_line) for of_line in of_lines]
        found = FaceTree(
            [i for of_line in dense for i in of_line if i.length_m >= self.merging.min_length_m]
        )
        supported = [interval for of_line in dense for interval in self._supported(of_line, found)]
        return self.merging.remove_doubles(supported)

    def trim(self, walls: Sequence[FaceInterval]) -> list[FaceInterval]:
        """Return intervals without overshoots, tails and stubs."""
        trimmed = trimming.trim_overshoots(walls)
        return _without_stubs(trimming.trim_tails(trimmed, share=self.merging.ghost_share))

    def meet_at_corners(self, walls: Sequence[FaceInterval]) -> list[FaceInterval]:
        """Return intervals that end at corners, the strongest first, without what that leaves."""
        met = candidates.meet_at_corners(walls, corner_m=self.merging.corner_m)
        # some faces reach the line that they end at only now
        met = trimming.trim_tails(met, share=self.merging.ghost_share)
        return _without_stubs(self.merging.remove_doubles(met))

    def _find_dense(self, of_line: Iterable[FaceInterval]) -> list[FaceInterval]:
        """Return the intervals of one line that have enough points for their length."""
        least = self.merging.min_points_per_m
        return [interval for interval in of_line if interval.n_points >= least * interval.length_m]

    def _supported(self, of_line: Sequence[FaceInterval], found: FaceTree) -> list[FaceInterval]:
        """Return the intervals of one line that enough scans show, with their walls' other sides.

        Where one is sure, short ones beside it stay, too.
        """
        is_sure = any(
            interval.length_m >= self.merging.min_length_m and self._is_shown(interval, found)
            for interval in of_line
        )
        if not is_sure:
            return []
        return _without_stubs(of_line)

    def _is_shown(self, interval: FaceInterval, found: FaceTree) -> bool:
        """Return whether an interval is long, or enough scans show it or the wall's other side."""
        # its ends may have been left to faces that cross it there
        is_long = interval.length_m + 2 * FACE_M >= self.merging.lone_length_m
        if is_long or interval.n_scans >= self.merging.min_scans:
            return True
        reach_m = self.pairing.max_gap_m + self.pairing.max_thickness_m
        near = found.within(shapely.LineString(interval.ends), reach_m)
        sides = (other for other in near if self.pairing.may_be_sides(interval, other))
        scans = [interval.scans, *(other.scans for other in sides)]
        return len(np.unique(np.concatenate(scans))) >= self.merging.min_scans


def _without_stubs(found: Iterable[FaceInterval]) -> list[FaceInterval]:
    """Return the intervals that are no noise at an end, and still shown once they were cut."""
    return [i for i in found if i.length_m >= END_M and i.n_points > 0]
