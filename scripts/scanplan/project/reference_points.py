"""Reference points held against one another: whether one rigid motion can lay the map onto them.

Standard library only: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from collections.abc import Sequence

from scanplan.errors import StageError

Place = tuple[float, float]

_LEAST_APART_M = 2.0
"""Between the two farthest: nearer ones give no direction, each is known to centimetres at best."""
_MOST_OFF_M = 1.0
"""By which distances in the map and outside may differ: places are clicked by hand, and heard of
satellites indoors."""
_MOST_OFF_SHARE = 0.02
"""The same, as a share of the distance: maps drift, and projections stretch by a thousandth."""


def check_points(entries: Sequence[str], at_m: Sequence[Place], world_m: Sequence[Place]) -> None:
    """Refuse reference points that disagree, or that give no direction.

    All are held against two, the first and the one farthest from it.

    Parameters
    ----------
    entries : sequence of str
        The file and the number of each, for messages; at least two.
    at_m, world_m : sequences of (float, float)
        Where each lies in the map, and outside: east and north.

    Raises
    ------
    StageError
        Naming the entry, the distances and the limit.
    """
    inside_m = [complex(*place) for place in at_m]
    outside_m = [complex(*place) for place in world_m]
    apart_m = [abs(place - inside_m[0]) for place in inside_m]
    far = apart_m.index(max(apart_m))
    if apart_m[far] < _LEAST_APART_M:
        fault = f"all reference points lie within {apart_m[far]:.2g} m of one another"
        remedy = f"give two that are at least {_LEAST_APART_M:g} m apart, better as far as can be"
        raise StageError(f"{entries[far]}: {fault} and give no direction; {remedy}")
    for i, entry in enumerate(entries):
        for base in (0, far):
            in_map_m = abs(inside_m[i] - inside_m[base])
            in_world_m = abs(outside_m[i] - outside_m[base])
            most_m = _most_off_m(in_map_m)
            if abs(in_map_m - in_world_m) > most_m:
                other = entries[base].rpartition(": ")[2]
                fault = f"lies {in_map_m:.6g} m from {other} by `at`, {in_world_m:.6g} m by `world`"
                remedy = f"they may differ by {most_m:.1f} m; measure again, both in metres"
                raise StageError(f"{entry}: {fault}; {remedy}")
        left_m, world_left_m = (_left_m(places, i, far) for places in (inside_m, outside_m))
        if left_m * world_left_m < 0 and abs(left_m - world_left_m) > 2 * _most_off_m(apart_m[far]):
            sides = "lies to the left of others by `at` and to the right by `world`, or the reverse"
            raise StageError(f"{entry}: {sides}; give `world` as [east, north]")


def _most_off_m(apart_m: float) -> float:
    return _MOST_OFF_M + _MOST_OFF_SHARE * apart_m


def _left_m(places_m: Sequence[complex], i: int, far: int) -> float:
    """Return how far a place lies to the left of the line from the first to the farthest."""
    along = places_m[far] - places_m[0]
    across = (places_m[i] - places_m[0]) * along.conjugate()
    return across.imag / abs(along)
