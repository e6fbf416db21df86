"""Doors and passages: where they are, how wide, how their leaves hang and stand."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely import LineString
from shapely.geometry.base import BaseGeometry

from .hanging import Hanging, side_towards
from .plan import Plan, Xy

ANGLES = ("shut", "ajar", "open", "back")
# so that of all doors some 20 % are shut, 15 % ajar, 50 % open and 15 % back at the wall
_SHARES = {False: (0.25, 0.35, 0.3, 0.1), True: (0.0, 0.0, 0.72, 0.28)}
_SLIVER_M2 = 0.001  # what buffers may overlap by


@dataclass(frozen=True)
class DoorStyle:
    """What the doors of a building have in common.

    Attributes
    ----------
    width_m, lintel_m : float
    frame_m : float
        Of the frame at jambs and lintel.
    leaf_m : float
        Thickness of a leaf.
    glass : bool
        Whether leaves are panes.
    """

    width_m: float = 0.9
    lintel_m: float = 2.05
    frame_m: float = 0.03
    leaf_m: float = 0.04
    glass: bool = False


def draw_style(rng: np.random.Generator) -> DoorStyle:
    """Draw what common doors are like: steel or wooden frames, lintels of 2.0 to 2.1 m."""
    return DoorStyle(
        width_m=float(rng.choice([0.85, 0.9, 0.95, 1.0])),
        lintel_m=float(rng.choice([2.0, 2.05, 2.1])),
        frame_m=float(rng.choice([0.0, 0.02, 0.03, 0.04])),
        leaf_m=float(rng.choice([0.038, 0.04, 0.045])),
    )


def draw_angle(rng: np.random.Generator, *, driven: bool) -> float:
    """Draw how far a leaf stands open, degrees: wide where somebody is to go through."""
    state = str(rng.choice(ANGLES, p=_SHARES[driven]))
    spans = {"shut": (0, 0), "ajar": (5, 30), "open": (70, 95), "back": (172, 180)}
    low, high = spans[state]
    if driven and state == "open":
        low = 82  # so that the free width is not the leaf's
    return round(float(rng.uniform(low, high)), 1)


def door(
    plan: Plan,
    a: Xy,
    b: Xy,
    style: DoorStyle,
    *,
    at_m: float | None = None,
    width_m: float | None = None,
    leaf: str | None = "hinged",
    into: Xy | None = None,
    driven: bool = True,
    open_deg: float | None = None,
    hinge: str | None = None,
    lintel_m: float | None = None,
    recess_m: float | None = None,
    margin_m: float = 0.12,
) -> bool:
    """Draw a door in a stretch of a wall, where its leaf has room; return whether there is any.

    Parameters
    ----------
    plan : Plan
    a, b : (x, y)
        The stretch, the lesser end first.
    style : DoorStyle
    at_m : float or None
        From `a` to the opening's first jamb; drawn if None: most doors stand near a corner.
    width_m, lintel_m : float or None
        Of the opening; the style's if None.
    leaf : {"hinged", "double", "sliding", None}
        None: an opening with nothing in it, a `passage`.
    into : (x, y) or None
        A place on the side that the leaf opens to; one of both at random if None.
    driven : bool
        Whether somebody shall be able to go through.
    open_deg : float or None
        Drawn if None.
    hinge : {"start", "end", None}
        The jamb nearer to a corner if None.
    recess_m : float or None
        As in the drawing.
    margin_m : float
        From the stretch's ends to the opening at least, half of the crossing wall included.
    """
    wide_m = style.width_m if width_m is None else width_m
    length_m = float(np.hypot(b[0] - a[0], b[1] - a[1]))
    if length_m - 2 * margin_m - wide_m < -1e-9:
        return False
    places = [at_m] if at_m is not None else _places(plan, length_m, wide_m, margin_m)
    lintel = style.lintel_m if lintel_m is None else lintel_m
    bare = [_opening_at(plan, a, b, place, wide_m) for place in places]
    if leaf is None:
        return any(_draw_passage(plan, opening, lintel) for opening in bare)
    angle = draw_angle(plan.rng, driven=driven) if open_deg is None else open_deg
    share = round(float(plan.rng.uniform(0.85, 1.0)), 2) if driven else 0.0
    if recess_m is not None:
        angle = min(angle, 95.0)  # behind the wall's face a leaf meets the jamb
    # what cannot lie back at the wall stands at a right angle
    for turn in dict.fromkeys((angle, min(angle, 90.0))):
        hung = [replace(h, leaf=leaf, open_deg=turn, open_share=share) for h in bare]
        for hanging in _ways_to_hang(plan, hung, length_m, into, hinge):
            if _hang(plan, hanging, style, lintel, recess_m):
                return True
    return False


def _opening_at(plan: Plan, a: Xy, b: Xy, begin_m: float, wide_m: float) -> Hanging:
    """Return an opening in a stretch, with what the wall there is thick."""
    opening = Hanging(a, b, 0.0, begin_m, wide_m)
    half_m = plan.thickness_at(opening.at(begin_m + wide_m / 2)) / 2
    return replace(opening, half_m=half_m)


def _places(plan: Plan, length_m: float, wide_m: float, margin_m: float) -> list[float]:
    """Return where a door may begin: near either end of the stretch, then anywhere."""
    slack_m = length_m - 2 * margin_m - wide_m
    corner_m = margin_m + float(np.abs(plan.rng.normal(0.05, 0.1)))
    anywhere = [margin_m + slack_m * float(share) for share in plan.rng.uniform(0, 1, 12)]
    ends = [min(corner_m, margin_m + slack_m)]
    ends.append(length_m - wide_m - ends[0])
    plan.rng.shuffle(ends)
    return [*ends, *anywhere]


def _ways_to_hang(
    plan: Plan, hung: list[Hanging], length_m: float, into: Xy | None, hinge: str | None
) -> Iterator[Hanging]:
    """Yield the sides and jambs that leaves may hang at, the jamb nearer to a corner first."""
    for door_there in hung:
        is_low = door_there.begin_m + door_there.width_m / 2 < length_m / 2
        jambs = ("start", "end") if is_low else ("end", "start")
        sides = [str(side) for side in plan.rng.permutation(["left", "right"])]
        if into is not None:
            sides = [side_towards(door_there.a, door_there.b, into)]
        for side in sides:
            for jamb in (hinge,) if hinge else jambs:
                yield replace(door_there, side=side, hinge=jamb)


def _hang(
    plan: Plan, hanging: Hanging, style: DoorStyle, lintel_m: float, recess_m: float | None
) -> bool:
    """Draw a door if its leaf and the ground before it are free."""
    approach, swept = hanging.approach, hanging.swept
    standing = shapely.union_all([leaf.buffer(0.02) for leaf in hanging.standing])
    ground, crossed = swept.union(approach), standing.union(swept)
    if any(other.intersects(ground) for other in plan.taken):
        return False
    if any(other.intersects(standing) or other.intersects(hanging.hole) for other in plan.kept):
        return False
    walls = _crossing_walls(plan, hanging)
    if any(wall.intersection(crossed).area > _SLIVER_M2 for wall in walls):
        return False
    slides = hanging.leaf == "sliding"
    _draw_opening(
        *(plan, hanging, "door", lintel_m),
        leaf=hanging.leaf,
        open_deg=None if slides else hanging.open_deg,
        open_share=hanging.open_share if slides else None,
        hinge=hanging.hinge,
        side=hanging.side,
        leaf_thickness_m=style.leaf_m,
        leaf_glass=style.glass or None,
        frame_m=style.frame_m or None,
        recess_m=recess_m,
    )
    plan.kept += [approach, swept]
    return True


def _crossing_walls(plan: Plan, hanging: Hanging) -> list[BaseGeometry]:
    """Return the walls on the floor but those in line with a door's own and no thicker."""
    line = LineString([hanging.at(-100.0), hanging.at(100.0)])
    return [
        wall.line_m.buffer(wall.thickness_m / 2, cap_style="flat")
        for wall in plan.walls
        if wall.thickness_m > 2 * hanging.half_m + 0.005
        or any(shapely.Point(xy).distance(line) > 0.05 for xy in wall.line_m.coords)
    ]


def _draw_passage(plan: Plan, opening: Hanging, lintel_m: float) -> bool:
    """Draw an opening without a leaf where the ground before it is free."""
    approach, hole = opening.approach, opening.hole
    if any(other.intersects(approach) for other in plan.taken):
        return False
    if any(other.intersects(hole) for other in plan.kept):
        return False
    _draw_opening(plan, opening, "passage", lintel_m)
    plan.kept.append(approach)
    return True


def _draw_opening(
    plan: Plan, hanging: Hanging, kind: str, lintel_m: float, **values: float | str | None
) -> None:
    span = [[round(x, 4), round(y, 4)] for x, y in hanging.ends]
    values = {"type": kind, "sill_m": 0.0, "lintel_m": lintel_m, **values}
    plan.add("opening", "LineString", span, **values)
