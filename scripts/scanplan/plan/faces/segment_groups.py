"""Which wall segments are observations of the same face."""

import heapq

import numpy as np
import shapely

from scanplan.geometry.lines import end_deviation_m, extents_along_m, fit_segments_line

_MOST_ROUNDS = 100


def group_segments(segments, *, max_angle_rad, tolerance_m, reach_m):
    """Sort segments into groups, each around one line.

    Of every group, all members look the same way as its line within `max_angle_rad`, and both ends
    of each lie within `tolerance_m` of it: chords of a curve are not drawn straight, a step is not
    ramped. Groups grow from the segment that tells most about its line along what lies within
    `reach_m`, and are refitted and re-sorted until nothing changes (a mean shift over lines); then
    groups whose members fit one line after all are joined, the best first.

    Parameters
    ----------
    segments : lines.ObservedSegments
    max_angle_rad : float
    tolerance_m : float
    reach_m : float
        Longest pause along the line that a group may bridge.

    Returns
    -------
    list of (k,) int64 arrays
        Members of each group, ascending; every segment is in exactly one.
    """
    limits = {"max_angle_rad": max_angle_rad, "tolerance_m": tolerance_m, "reach_m": reach_m}
    return _join(segments, _grow(segments, **limits), **limits)


def _grow(segments, *, max_angle_rad, tolerance_m, reach_m):
    tree = shapely.STRtree(_strings(segments.start, segments.end))
    free = np.ones(len(segments.start), bool)
    groups = []
    for seed in np.argsort(-segments.weight * segments.length_m**2, kind="stable"):
        while free[seed]:
            members = _settle(segments, tree, free, seed, max_angle_rad, tolerance_m, reach_m)
            free[members] = False
            groups.append(members)
    return groups


def _settle(segments, tree, free, seed, max_angle_rad, tolerance_m, reach_m):
    """Let a group around `seed` take up and give back members until it stays as it is."""
    members = np.array([seed])
    for _ in range(_MOST_ROUNDS):
        line = fit_segments_line(segments, members)
        low, high = extents_along_m(line, segments, members)
        ends = line.at(np.array([low.min(), high.max()]))
        box = shapely.box(*(ends.min(axis=0) - reach_m), *(ends.max(axis=0) + reach_m))
        near = np.sort(tree.query(box))
        near = near[free[near]]
        near_low, near_high = extents_along_m(line, segments, near)
        taken = near[
            _fits(line, segments, near, max_angle_rad, tolerance_m)
            & (near_low <= high.max() + reach_m)
            & (near_high >= low.min() - reach_m)
        ]
        if len(taken) == 0 or np.array_equal(taken, members):
            break
        members = taken
    return _pruned(segments, members, max_angle_rad, tolerance_m)


def _fits(line, segments, members, max_angle_rad, tolerance_m):
    same_way = segments.normal[members] @ line.normal >= np.cos(max_angle_rad)
    return same_way & (end_deviation_m(line, segments, members) <= tolerance_m)


def _pruned(segments, members, max_angle_rad, tolerance_m):
    """Give back the worst member until all fit.

    Of use only where settling went round in circles.
    """
    while len(members) > 1:
        line = fit_segments_line(segments, members)
        if _fits(line, segments, members, max_angle_rad, tolerance_m).all():
            break
        members = np.delete(members, np.argmax(end_deviation_m(line, segments, members)))
    return members


def _join(segments, groups, *, max_angle_rad, tolerance_m, reach_m):
    """Join pairs of groups that fit one line, the closest fit first, until no pair does."""

    def cost(one, other):
        members = np.sort(np.concatenate([alive[one], alive[other]]))
        line = fit_segments_line(segments, members)
        if not _fits(line, segments, members, max_angle_rad, tolerance_m).all():
            return None
        gap = _gap_m(line, segments, alive[one], alive[other])
        return end_deviation_m(line, segments, members).max() if gap <= reach_m else None

    def offer(one, other):
        worst = cost(one, other)
        if worst is not None:
            heapq.heappush(offers, (worst, one, other))

    alive, offers = dict(enumerate(groups)), []
    beside = _neighbours(segments, groups, max_angle_rad, tolerance_m, reach_m)
    for one in range(len(groups)):
        for other in sorted(o for o in beside[one] if o > one):
            offer(one, other)
    while offers:
        _, one, other = heapq.heappop(offers)
        if one not in alive or other not in alive:
            continue
        joined = len(beside)
        alive[joined] = np.sort(np.concatenate([alive.pop(one), alive.pop(other)]))
        beside[joined] = {o for o in beside[one] | beside[other] if o in alive}
        for third in sorted(beside[joined]):
            beside[third].add(joined)
            offer(third, joined)
    return [alive[key] for key in sorted(alive)]


def _gap_m(line, segments, one, other):
    one_low, one_high = extents_along_m(line, segments, one)
    other_low, other_high = extents_along_m(line, segments, other)
    return max(other_low.min() - one_high.max(), one_low.min() - other_high.max())


def _neighbours(segments, groups, max_angle_rad, tolerance_m, reach_m):
    """Return for each group those that may share a line with it.

    Within reach, much the same way, in a strip.
    """
    lines = [fit_segments_line(segments, members) for members in groups]
    extents = [
        extents_along_m(line, segments, members)
        for line, members in zip(lines, groups, strict=True)
    ]
    starts = np.array([line.at(low.min()) for line, (low, _) in zip(lines, extents, strict=True)])
    ends = np.array([line.at(high.max()) for line, (_, high) in zip(lines, extents, strict=True)])
    normals = np.array([line.normal for line in lines])
    strings = _strings(starts, ends)
    pairs = np.stack(
        shapely.STRtree(strings).query(strings, predicate="dwithin", distance=reach_m), axis=1
    )
    alike = np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]]) >= np.cos(
        2 * max_angle_rad
    )
    pairs = pairs[alike & (pairs[:, 0] < pairs[:, 1])]
    pairs = pairs[_in_a_strip(starts, ends, pairs, tolerance_m)]
    beside = {number: set() for number in range(len(groups))}
    for one, other in pairs.tolist():
        beside[one].add(other), beside[other].add(one)
    return beside


def _in_a_strip(starts, ends, pairs, tolerance_m):
    """Tell which pairs of lines any common line could serve, (k,) bool.

    Some that none serves pass, too.

    Where the members of both lie within t of a common line, the ends of either own line lie within
    2 t of it. Over the longer one's length L the two lines are then 2 t apart at most, at x beyond
    its end ``2 t (1 + 2 x / L)``, and the shorter one's ends another 2 t.
    """
    length_m = np.hypot(*(ends - starts).T)
    swap = length_m[pairs[:, 0]] < length_m[pairs[:, 1]]
    longer, shorter = np.where(swap[:, None], pairs[:, ::-1], pairs).T
    along = (ends[longer] - starts[longer]) / length_m[longer][:, None]
    passes = np.ones(len(pairs), bool)
    for point in (starts[shorter] - starts[longer], ends[shorter] - starts[longer]):
        place = np.einsum("ij,ij->i", point, along)
        beyond = np.maximum(0, np.maximum(-place, place - length_m[longer]))
        offset = np.abs(along[:, 0] * point[:, 1] - along[:, 1] * point[:, 0])
        # the tenth covers that distances are taken square to slightly different lines
        passes &= offset <= 1.1 * 4 * tolerance_m * (1 + beyond / length_m[longer])
    return passes


def _strings(start, end):
    return shapely.linestrings(np.stack([start, end], axis=1))
