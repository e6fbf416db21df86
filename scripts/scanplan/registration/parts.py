"""Parts of a drive with maps of their own, and what ties them to one another.

A part goes from where the map changes to where it changes next, and is rigid. Over a change the
motion is known by odometry, or by the scans on both sides; else submaps of a part are looked for on
those of others, wherever and however turned (`drift.recognition`). A tie counts where no place that
both parts show contradicts it. What nothing ties is a map of its own.
"""

import itertools
from collections.abc import Callable, Container, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from scanplan.geometry import se3
from scanplan.registration import joins, pauses
from scanplan.registration.drift import closing, folds
from scanplan.registration.drift.submaps import Submap
from scanplan.registration.driven_map import DrivenMap
from scanplan.registration.registration_settings import DriftSettings
from scanplan.stage.witness_table import WITNESSES
from scanplan.types import FloatArray, IntArray

SCANS, RECORDED = "scans that show one place", "the localiser alone"
"""What ties a part that is recognised on another, or one after a pause that nothing contradicts."""
_MOST_PAIRS = 200  # of submaps, a fifth of a second each
_LEAST_SOURCES = 6  # that are looked for, however long the part that they are looked for on
_LEAST_FOUND = 3  # submaps of a part, 12 m of way: rooms alike are shorter, buildings are not
_RIVAL = 0.5  # of those that agree: as many that agree on another place leave both in doubt
_SAME_M, _SAME_RAD = 0.5, np.radians(5)  # what submaps of one drive differ by
_MOST_RISE_M = 1.0  # between sensors at one place: less than a storey


class Change(NamedTuple):
    """Row of the first scan after a change of the map, its cloud's pose in the one before.

    The pose is NaN where nothing knows it; `by` is what knows.
    """

    row: int
    step: FloatArray
    by: str


@dataclass(frozen=True)
class TiedParts:
    """Parts of a drive, and which of them have one map.

    Attributes
    ----------
    begins, end : (k,) int and int
        Rows of their first scans, and the row after the last scan.
    group : (k,) int
        Parts of one number have one map; 0 for that of the first scan, and so on in their order.
    motion : (k, 4, 4) float64
        From a part's map to that of the largest part of its group.
    by : tuple of str
        What ties it there; empty of the largest.
    """

    begins: IntArray
    end: int
    group: IntArray
    motion: FloatArray
    by: tuple[str, ...]

    def count_scans(self) -> IntArray:
        """Return how many scans (m,) each group has."""
        size = np.diff([*self.begins, self.end])
        return np.bincount(self.group, size).astype(np.int64)


def find_changes(driven: DrivenMap) -> list[Change]:
    """Return where the map jumps, begins anew after a pause, or contradicts what was seen before.

    Of a sound drive there is none.
    """
    unknown = np.full((4, 4), np.nan)
    found: dict[int, Change] = {}
    jumps = driven.jumps
    while new := [jump for jump in jumps if _is_change(jump) and jump.row not in found]:
        found |= {jump.row: Change(jump.row, jump.step, jump.by) for jump in new}
        # back from another map a scan fits those of the first one
        jumps = driven.find_jumps(sorted(found))
    pauses_after = pauses.find_untied(driven.scan_ids, driven.t_ns, driven.optimised)
    poses = driven.world_from_cloud
    for row in (row + 1 for row in pauses_after):
        as_it_is = se3.invert_pose(poses[row - 1]) @ poses[row]
        found.setdefault(row, Change(row, as_it_is, RECORDED))
    for seam in folds.find_seams(driven.places, sorted(found)):
        row = _find_break(driven, seam, found)
        step = unknown if driven.steps is None else driven.steps[row - 1]
        found[row] = Change(row, step, joins.ODOMETRY)
    return [found[row] for row in sorted(found)]


def tie_parts(
    driven: DrivenMap, changes: Sequence[Change], run: Callable[..., Iterator[Any]]
) -> TiedParts:
    """Tie the parts of a drive.

    Parameters
    ----------
    changes : sequence of Change
        Between them, in the order of their rows.
    run : callable
        As `workers.open_pool` gives it.
    """
    ties = _PartTies(driven, changes, run)
    size = np.diff([*ties.begins, len(driven.scan_ids)])
    placed: dict[int, tuple[int, FloatArray, str]] = {}
    for base in np.argsort(-size, kind="stable").tolist():
        if base in placed:
            continue
        motions: dict[int, FloatArray] = {base: np.eye(4)}
        placed[base] = (base, motions[base], "")
        while found := ties.find_next(motions, [p for p in range(len(size)) if p not in placed]):
            part, motion, by = found
            motions[part] = motion
            placed[part] = (base, motion, by)
    base = np.array([placed[part][0] for part in range(len(size))])
    _, first, group = np.unique(base, return_index=True, return_inverse=True)
    order = np.argsort(np.argsort(first))
    return TiedParts(
        np.array(ties.begins),
        len(driven.scan_ids),
        order[group],
        np.array([placed[part][1] for part in range(len(size))]),
        tuple(placed[part][2] for part in range(len(size))),
    )


def _is_change(jump: joins.MapJump) -> bool:
    """Return whether a jump is beyond what sound drives have."""
    limits = WITNESSES["map jump"].limit, WITNESSES["map turn"].limit
    return jump.shift_m > limits[0] or jump.turn_deg > limits[1]


def _find_break(driven: DrivenMap, seam: folds.Seam, known: Container[int]) -> int:
    """Return the row before which the map changed: after a pause, or where nothing is aligned.

    Where it is known to have changed it did not change again, unless nothing else is left.
    """
    is_tied = joins.find_tied(driven.scan_ids, driven.optimised)
    after_pauses = set(pauses.find_pauses(driven.t_ns).tolist())

    def likelihood(row: int) -> tuple[bool, bool, bool, int]:
        return row not in known, row in after_pauses, not is_tied[row], -abs(row - seam.likeliest)

    return max(range(seam.after + 1, seam.last + 1), key=likelihood)


class _PartTies:
    """What ties parts of a drive to one another."""

    def __init__(
        self, driven: DrivenMap, changes: Sequence[Change], run: Callable[..., Iterator[Any]]
    ) -> None:
        self._driven = driven
        self._changes = changes
        self._run = run
        self._seen: dict[tuple[int, int], list[tuple[int, FloatArray]]] = {}
        self.begins = [0, *(change.row for change in changes)]

    @cached_property
    def _maps(self) -> list[list[Submap]]:
        """Submaps of each part."""
        ends = [*self.begins[1:], len(self._driven.scan_ids)]
        return [
            self._driven.make_submaps(begin, end)
            for begin, end in zip(self.begins, ends, strict=True)
        ]

    def find_next(
        self, motions: dict[int, FloatArray], parts: Sequence[int]
    ) -> tuple[int, FloatArray, str] | None:
        """Return a part that something ties to a group, how it lies in its map, and what says so.

        Parameters
        ----------
        motions : dict of int to (4, 4) float64
            The parts of the group, and how they lie in its map.
        parts : sequence of int
            Those that are in none.
        """
        largest = sorted(parts, key=lambda part: (-len(self._maps[part]), part))
        steps = [
            (part, self._follow_step(part, beside, motions), self._changes[min(part, beside)].by)
            for part in parts
            for beside in (part - 1, part + 1)
            if beside in motions
        ]
        tries = itertools.chain(
            (step for step in steps if step[2] != RECORDED),
            ((part, self._recognise(part, motions), SCANS) for part in largest),
            (step for step in steps if step[2] == RECORDED),
        )
        for part, motion, by in tries:
            if motion is not None and self._fits(part, motion, motions):
                return part, motion, by
        return None

    def _follow_step(
        self, part: int, beside: int, motions: dict[int, FloatArray]
    ) -> FloatArray | None:
        """Return how a part lies by the motion over the change between it and one of a group."""
        _, step, _ = self._changes[min(part, beside)]
        row = self.begins[max(part, beside)]
        if not np.isfinite(step).all():
            return None
        poses = self._driven.world_from_cloud
        known, own = (row - 1, row) if beside < part else (row, row - 1)
        placed = motions[beside] @ poses[known]
        placed = placed @ (step if beside < part else se3.invert_pose(step))
        return se3.level_frame(placed) @ se3.invert_pose(se3.level_frame(poses[own]))

    def _fits(self, part: int, motion: FloatArray, motions: dict[int, FloatArray]) -> bool:
        """Return whether no place that a part and a group show looks different."""
        own, at = self._place_maps({part: motion})
        others, theirs = self._place_maps(motions)
        return folds.measure_lack(own, at, others, theirs) <= WITNESSES["other place"].limit

    def _place_maps(self, motions: dict[int, FloatArray]) -> tuple[list[Submap], FloatArray]:
        """Return the submaps of some parts, and their level frames (n, 4, 4) in a group's map."""
        maps = [submap for part in motions for submap in self._maps[part]]
        frames = [
            motions[part] @ self._level(submap) for part in motions for submap in self._maps[part]
        ]
        return maps, np.array(frames).reshape(-1, 4, 4)

    def _level(self, submap: Submap) -> FloatArray:
        return se3.level_frame(self._driven.world_from_cloud[submap.row])

    def _recognise(self, part: int, motions: dict[int, FloatArray]) -> FloatArray | None:
        """Return how a part lies where its submaps are found on those of a group."""
        found = [
            (source, motions[other] @ motion)
            for other in motions
            for source, motion in self._search(part, other)
        ]
        found = [(source, motion) for source, motion in found if abs(motion[2, 3]) < _MOST_RISE_M]
        agreeing = [
            [other for other, again in found if self._are_one(part, source, motion, again)]
            for source, motion in found
        ]
        counts = [len(set(sources)) for sources in agreeing]
        best = max(range(len(found)), key=counts.__getitem__, default=0)
        if not found or counts[best] < _LEAST_FOUND:
            return None
        others = {source for source, _ in found} - set(agreeing[best])
        rivals = [
            len(set(sources) - set(agreeing[best]))
            for (source, _), sources in zip(found, agreeing, strict=True)
            if source in others
        ]
        return found[best][1] if max(rivals, default=0) < _RIVAL * counts[best] else None

    def _are_one(self, part: int, source: int, one: FloatArray, other: FloatArray) -> bool:
        """Return whether two motions move a submap of a part to one place."""
        there = self._level(self._maps[part][source])
        moved, again = one @ there, other @ there
        near = np.linalg.norm((moved - again)[:2, 3]) <= _SAME_M
        return bool(near and se3.turn_between_rad(moved, again) <= _SAME_RAD)

    def _search(self, part: int, other: int) -> list[tuple[int, FloatArray]]:
        """Return which submaps of a part are found on another, and the motion that each tells."""
        if (part, other) in self._seen:
            return self._seen[part, other]
        sources, targets = self._maps[part], self._maps[other]
        n_asked = max(_LEAST_SOURCES, _MOST_PAIRS // max(len(targets), 1))
        asked = np.unique(np.linspace(0, len(sources) - 1, n_asked).round()).astype(np.int64)
        pairs = [(source, target) for source in asked[asked >= 0].tolist() for target in targets]
        window = (np.eye(4), DriftSettings.submap_m, np.pi)
        jobs = (([(sources[source], target, *window)],) for source, target in pairs)
        results = self._run(closing.recognise_pairs, jobs)
        found: list[tuple[int, FloatArray]] = []
        for (source, target), (result,) in zip(pairs, results, strict=True):
            if result is not None:
                to_target = result.fit.target_from_source
                from_source = se3.invert_pose(self._level(sources[source]))
                found.append((source, self._level(target) @ to_target @ from_source))
        self._seen[part, other] = found
        return found
