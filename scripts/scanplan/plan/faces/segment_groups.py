"""Which wall segments are observations of the same face."""

import heapq
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry.lines import (
    Line,
    ObservedSegments,
    end_deviation_m,
    extents_along_m,
    fit_segments_line,
)
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_STRAIGHT_M = 0.01
"""ASSUME of a wall: what is plastered or tiled of it is flat within so much."""
_MOST_ROUNDS = 100  # bounds the time of groups that settle in circles


@dataclass(frozen=True)
class GroupLimits:
    """What segments of one group have in common.

    Attributes
    ----------
    max_angle_rad : float
        From a segment's way to that of the group's line.
    tolerance_m : float
        From a segment's ends to the line.
    reach_m : float
        Longest gap along the line that a group may bridge.
    """

    max_angle_rad: float
    tolerance_m: float
    reach_m: float


def group_segments(segments: ObservedSegments, limits: GroupLimits) -> list[IntArray]:
    """Sort segments into groups, each around one line.

    Of every group, all members look the same way as its line within `max_angle_rad`, and both ends
    of each lie within `tolerance_m` of it: chords of a curve are not drawn straight, a step is not
    ramped. Groups grow from the segment that fixes its line best along what lies within
    `reach_m`, and are refitted and re-sorted until nothing changes (a mean shift over lines); then
    groups whose members fit one line after all are joined, the best first.

    Returns
    -------
    list of (k,) int64 arrays
        Members of each group, ascending; every segment is in exactly one.
    """
    return _join(segments, _grow(segments, limits), limits)


def _grow(segments: ObservedSegments, limits: GroupLimits) -> list[IntArray]:
    """Return groups that settle around the heaviest segments in none yet."""
    tree = shapely.STRtree(_linestrings(segments.start, segments.end))
    free = np.ones(len(segments.start), bool)
    groups = []
    for seed in np.argsort(-segments.weight * segments.length_m**2, kind="stable").tolist():
        while free[seed]:
            members = _settle(segments, tree, free, seed, limits)
            free[members] = False
            groups.append(members)
    return groups


def _settle(
    segments: ObservedSegments,
    tree: shapely.STRtree,
    free: BoolArray,
    seed: int,
    limits: GroupLimits,
) -> IntArray:
    """Return the free segments of a group around `seed` that stay it, once it takes them up."""
    members = np.array([seed])
    for _ in range(_MOST_ROUNDS):
        line = fit_segments_line(segments, members)
        low_m, high_m = extents_along_m(line, segments, members)
        ends_m = line.at(np.array([low_m.min(), high_m.max()]))
        reach_m = limits.reach_m
        box = shapely.box(*(ends_m.min(axis=0) - reach_m), *(ends_m.max(axis=0) + reach_m))
        near = np.sort(tree.query(box))
        near = near[free[near]]
        near_low_m, near_high_m = extents_along_m(line, segments, near)
        is_member = (
            _fits(line, segments, near, limits)
            & (near_low_m <= high_m.max() + reach_m)
            & (near_high_m >= low_m.min() - reach_m)
        )
        refitted = near[is_member]
        if len(refitted) == 0 or np.array_equal(refitted, members):
            break
        members = refitted
    return _prune(segments, members, limits)


def _fits(
    line: Line,
    segments: ObservedSegments,
    members: IntArray,
    limits: GroupLimits,
) -> BoolArray:
    """Return which members (k,) look the line's way, with both ends near it."""
    same_way = segments.normal[members] @ line.normal >= np.cos(limits.max_angle_rad)
    return same_way & (end_deviation_m(line, segments, members) <= limits.tolerance_m)


def _prune(segments: ObservedSegments, members: IntArray, limits: GroupLimits) -> IntArray:
    """Return the members without the worst ones, given back one by one until all fit.

    Of use only where settling went round in circles.
    """
    while len(members) > 1:
        line = fit_segments_line(segments, members)
        if _fits(line, segments, members, limits).all():
            break
        members = np.delete(members, np.argmax(end_deviation_m(line, segments, members)))
    return members


def _join(
    segments: ObservedSegments, groups: list[IntArray], limits: GroupLimits
) -> list[IntArray]:
    """Join pairs of groups that fit one line, the closest fit first, until no pair does."""
    alive = dict(enumerate(groups))
    offers: list[tuple[float, int, int]] = []

    def offer(one: int, other: int) -> None:
        worst_m = _joint_deviation_m(segments, alive[one], alive[other], limits)
        if worst_m is not None:
            heapq.heappush(offers, (worst_m, one, other))

    beside = _find_neighbours(segments, groups, limits)
    for one in range(len(groups)):
        for other in sorted(number for number in beside[one] if number > one):
            offer(one, other)
    while offers:
        _, one, other = heapq.heappop(offers)
        if one not in alive or other not in alive:
            continue
        joined = len(beside)
        alive[joined] = np.sort(np.concatenate([alive.pop(one), alive.pop(other)]))
        beside[joined] = {number for number in beside[one] | beside[other] if number in alive}
        for third in sorted(beside[joined]):
            beside[third].add(joined)
            offer(third, joined)
    return [alive[number] for number in sorted(alive)]


def _joint_deviation_m(
    segments: ObservedSegments, one: IntArray, other: IntArray, limits: GroupLimits
) -> float | None:
    """Return the largest distance of two groups' ends from their line; None if they fit none."""
    members = np.sort(np.concatenate([one, other]))
    line = fit_segments_line(segments, members)
    if not _fits(line, segments, members, limits).all():
        return None
    gap_m = _gap_m(line, segments, one, other)
    if gap_m > limits.reach_m or (gap_m > 0 and _are_two(segments, line, one, other)):
        return None
    return end_deviation_m(line, segments, members).max()


def _are_two(segments: ObservedSegments, joint: Line, one: IntArray, other: IntArray) -> bool:
    """Return whether two groups are likelier on a line each than on their joint one.

    Each segment is a witness, and errs by what those of a line differ by, and by what a wall is not
    straight; a further line is worth its two parameters (Schwarz 1978, Estimating the dimension of
    a model).
    """
    own_m2 = sum(_spread_m2(fit_segments_line(segments, of), segments, of) for of in (one, other))
    joint_m2 = sum(_spread_m2(joint, segments, of) for of in (one, other))
    count = len(one) + len(other)
    variance_m2 = own_m2 / count + _STRAIGHT_M**2
    return bool((joint_m2 - own_m2) / (2 * variance_m2) > np.log(count))


def _spread_m2(line: Line, segments: ObservedSegments, members: IntArray) -> float:
    """Return the sum of the mean squares of how far each member is off a line along its length."""
    start_m, end_m = line.offset_m(segments.start[members]), line.offset_m(segments.end[members])
    return float((start_m**2 + start_m * end_m + end_m**2).sum() / 3)


def _gap_m(line: Line, segments: ObservedSegments, one: IntArray, other: IntArray) -> float:
    """Return how far two groups are apart along a line; negative where they overlap."""
    one_low_m, one_high_m = extents_along_m(line, segments, one)
    other_low_m, other_high_m = extents_along_m(line, segments, other)
    return max(other_low_m.min() - one_high_m.max(), one_low_m.min() - other_high_m.max())


def _find_neighbours(
    segments: ObservedSegments, groups: list[IntArray], limits: GroupLimits
) -> dict[int, set[int]]:
    """Return for each group those that may share a line with it.

    Within reach, much the same way.
    """
    lines = [fit_segments_line(segments, members) for members in groups]
    normals = np.array([line.normal for line in lines])
    starts = []
    ends = []
    for line, members in zip(lines, groups, strict=True):
        low_m, high_m = extents_along_m(line, segments, members)
        starts.append(line.at(low_m.min()))
        ends.append(line.at(high_m.max()))
    strings = _linestrings(np.array(starts), np.array(ends))
    near = shapely.STRtree(strings).query(strings, predicate="dwithin", distance=limits.reach_m)
    cosine = np.einsum("ij,ij->i", normals[near[0]], normals[near[1]])
    pairs = near.T[(cosine >= np.cos(2 * limits.max_angle_rad)) & (near[0] < near[1])]
    beside: dict[int, set[int]] = {number: set() for number in range(len(groups))}
    for one, other in pairs.tolist():
        beside[one].add(other)
        beside[other].add(one)
    return beside


def _linestrings(start_m: FloatArray, end_m: FloatArray) -> Array:
    return np.asarray(shapely.linestrings(np.stack([start_m, end_m], axis=1)), object)
