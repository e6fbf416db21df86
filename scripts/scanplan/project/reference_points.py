"""Reference points held against one another: whether one rigid motion can lay the map onto them.

Where none can, the usual mistakes are tried: axes exchanged, other units, one point that is off.

Standard library only: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from scanplan.errors import MOST_NAMED, StageError
from scanplan.project.reference_systems import find_zone

Place = tuple[float, float]

_LEAST_APART_M = 2.0
"""Between the two farthest: nearer ones give no direction, each is known to centimetres at best."""
_MOST_OFF_M = 1.0
"""By which distances in the map and outside may differ: places are clicked by hand, and heard of
satellites indoors."""
_MOST_OFF_SHARE = 0.02
"""The same, as a share of the distance: maps drift, and projections stretch by a thousandth."""
_EASTERN_M = 1_000_000.0
"""Beyond all eastings of zones of UTM, which have 500 km in their middle and 167 to 833 km."""
_UNITS = {1000.0: "millimetres", 100.0: "centimetres", 1 / 0.3048: "feet", 1 / 0.0254: "inches"}
"""How many of a metre."""
_NEAR_UNIT = 0.03
"""Of a scale, relative: places are off by as much of what lies between them."""


def check_points(entries: Sequence[str], at_m: Sequence[Place], world_m: Sequence[Place]) -> None:
    """Refuse reference points that disagree, or that give no direction.

    Parameters
    ----------
    entries : sequence of str
        The file and the number of each, for messages; at least two.
    at_m, world_m : sequences of (float, float)
        Where each lies in the map, and outside: east and north.

    Raises
    ------
    StageError
        Naming the entry, how far it is off, the limit, and what is wrong with them.
    """
    inside_m = [complex(*place) for place in at_m]
    outside_m = [complex(*place) for place in world_m]
    apart_m = [abs(place - inside_m[0]) for place in inside_m]
    far = apart_m.index(max(apart_m))
    if apart_m[far] < _LEAST_APART_M:
        fault = f"all reference points lie within {apart_m[far]:.2g} m of one another"
        remedy = f"give two that are at least {_LEAST_APART_M:g} m apart, better as far as can be"
        raise StageError(f"{entries[far]}: {fault} and give no direction; {remedy}")
    most_m = _most_off_m(inside_m)
    off_m = measure_off_m(inside_m, outside_m)
    if max(off_m) <= most_m:
        return
    worst = off_m.index(max(off_m))
    fault = (
        f"lies {off_m[worst]:.6g} m from where a rigid motion lays the reference points (by entry:"
        f" {_list_off(entries, off_m)}; at most {most_m:.1f} m)"
    )
    raise StageError(f"{entries[worst]}: {fault}; {_explain(entries, inside_m, outside_m)}")


def check_zone(entry: str, crs: str, world_m: Place) -> None:
    """Refuse a place that lies in no zone of UTM, where it is to be in one.

    Raises
    ------
    StageError
        Naming the entry, and whether its axes are exchanged.
    """
    east_m, north_m = world_m
    if find_zone(crs) is None or abs(east_m) <= _EASTERN_M:
        return
    fault = f"{entry}: world lies {east_m:,.0f} m east, {crs} ends before {_EASTERN_M:,.0f} m"
    is_exchanged = abs(north_m) <= _EASTERN_M
    remedy = "give `world` as [east, north]" if is_exchanged else "give it in metres of the system"
    raise StageError(f"{fault}; {remedy}")


def measure_off_m(
    inside_m: Sequence[complex], outside_m: Sequence[complex], scale: float = 1.0
) -> list[float]:
    """Return how far each point lies from where the best rigid motion lays it.

    Parameters
    ----------
    inside_m, outside_m : (n,) complex
        The same points in the map and outside, x or east the real part.
    scale : float
        That the map is enlarged by before.
    """
    middle_m, world_m = (sum(places) / len(places) for places in (inside_m, outside_m))
    inner = [scale * (place - middle_m) for place in inside_m]
    outer = [place - world_m for place in outside_m]
    turn = sum(a.conjugate() * b for a, b in zip(inner, outer, strict=True))
    turn = turn / abs(turn) if turn else 1.0
    return [abs(b - turn * a) for a, b in zip(inner, outer, strict=True)]


def fits_mirrored(at_m: Sequence[Place], world_m: Sequence[Place]) -> bool:
    """Return whether points agree as well with a mirror image of the map: exchanged axes are one.

    Such as two points do, and all on one line.
    """
    inside_m, outside_m = ([complex(*place) for place in places] for places in (at_m, world_m))
    mirrored = [_exchange(place) for place in outside_m]
    return max(measure_off_m(inside_m, mirrored)) <= _most_off_m(inside_m)


def _explain(
    entries: Sequence[str], inside_m: Sequence[complex], outside_m: Sequence[complex]
) -> str:
    """Return which usual mistake the points are laid onto one another without, and the remedy."""
    most_m = _most_off_m(inside_m)

    def fits(change: Callable[[complex], complex], scale: float = 1.0) -> bool:
        off_m = measure_off_m(inside_m, [change(place) for place in outside_m], scale)
        return max(off_m) <= scale * most_m

    exchanged = "east and north are exchanged: give `world` as [east, north]"
    if fits(_exchange):
        return exchanged
    scale = _spread_m(outside_m) / _spread_m(inside_m)
    if scale > 0 and fits(_keep, scale):
        return f"{_name_scale(scale)}: give both in metres"
    if scale > 0 and fits(_exchange, scale):
        return f"{exchanged}; besides {_name_scale(scale)}: give both in metres"
    others = _find_outliers(inside_m, outside_m)
    if len(others) == 1:
        left_out = entries[others[0]].rpartition(": ")[2]
        return f"the others agree without {left_out}: measure that again, or leave it out"
    return "measure them again, both in metres"


def _find_outliers(inside_m: Sequence[complex], outside_m: Sequence[complex]) -> list[int]:
    """Return the points without which the others agree; of three any two might."""
    found = []
    for i in range(len(inside_m)):
        inner, outer = ([*p[:i], *p[i + 1 :]] for p in (inside_m, outside_m))
        if _spread_m(inner) > 0 and max(measure_off_m(inner, outer)) <= _most_off_m(inner):
            found.append(i)
    return found


def _name_scale(scale: float) -> str:
    """Return in words how much longer ways are by `world` than by `at`."""
    for many, unit in _UNITS.items():
        for which, of in (("world", many), ("at", 1 / many)):
            if abs(scale / of - 1) <= _NEAR_UNIT:
                return f"`{which}` seems to be in {unit}"
    return f"all distances by `world` are {scale:.4g} times those by `at`"


def _list_off(entries: Sequence[str], off_m: Sequence[float]) -> str:
    named = [
        f"{entry.rpartition(' ')[2]}: {off:.4g} m"
        for entry, off in zip(entries, off_m, strict=True)
    ]
    return ", ".join(named[:MOST_NAMED]) + (" and more" if len(named) > MOST_NAMED else "")


def _keep(place: complex) -> complex:
    return place


def _exchange(place: complex) -> complex:
    """Return a place of exchanged coordinates; a turn apart it is any mirror image."""
    return complex(place.imag, place.real)


def _spread_m(places_m: Sequence[complex]) -> float:
    """Return how far places lie from their middle, as the root of the mean square."""
    middle_m = sum(places_m) / len(places_m)
    return (sum(abs(place - middle_m) ** 2 for place in places_m) / len(places_m)) ** 0.5


def _most_off_m(inside_m: Sequence[complex]) -> float:
    """Return how far a point may be off: half of what a distance may, as two err in it."""
    farthest_m = max(abs(place - inside_m[0]) for place in inside_m)
    return (_MOST_OFF_M + _MOST_OFF_SHARE * farthest_m) / 2
