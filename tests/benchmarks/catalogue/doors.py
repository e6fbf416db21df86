"""Doors and passages: where they are, how wide, how their leaves hang and stand."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from .plan import Plan, Xy

ANGLES = ("shut", "ajar", "open", "back")
# so that of all doors some 20 % are shut, 15 % ajar, 50 % open and 15 % back at the wall
_SHARES = {False: (0.25, 0.35, 0.3, 0.1), True: (0.0, 0.0, 0.72, 0.28)}
_APPROACH_M = 0.9  # kept free before and behind a door
_PLAY_M = 0.005  # between a leaf and its frame
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
    slack_m = length_m - 2 * margin_m - wide_m
    if slack_m < -1e-9:
        return False
    corner_m = margin_m + float(np.abs(plan.rng.normal(0.05, 0.1)))
    tries = [margin_m + slack_m * float(share) for share in plan.rng.uniform(0, 1, 12)]
    if at_m is None:
        ends = [min(corner_m, margin_m + slack_m)]
        ends.append(length_m - wide_m - ends[0])
        plan.rng.shuffle(ends)
        tries = [*ends, *tries]
    else:
        tries = [at_m]
    lintel = style.lintel_m if lintel_m is None else lintel_m
    if leaf is None:
        return _draw_passage(plan, a, b, tries, wide_m, lintel)
    angle = draw_angle(plan.rng, driven=driven) if open_deg is None else open_deg
    if recess_m is not None:
        angle = min(angle, 95.0)  # behind the wall's face a leaf meets the jamb
    share = round(float(plan.rng.uniform(0.85, 1.0)), 2) if driven else 0.0
    wanted = None if into is None else _side(a, b, into)
    for try_deg in dict.fromkeys((angle, min(angle, 90.0))):
        for begin_m in tries:
            near = "start" if begin_m + wide_m / 2 < length_m / 2 else "end"
            far = "end" if near == "start" else "start"
            sides = [wanted] if wanted else list(plan.rng.permutation(["left", "right"]))
            for side in sides:
                for jamb in [hinge] if hinge else (near, far):
                    hung = _Hung(a, b, begin_m, wide_m, leaf, try_deg, jamb, str(side), share)
                    if _hang(plan, hung, style, lintel, recess_m):
                        return True
    return False


@dataclass(frozen=True)
class _Hung:
    """A leaf, or two, in a stretch of a wall."""

    a: Xy
    b: Xy
    begin_m: float
    width_m: float
    leaf: str
    open_deg: float
    hinge: str
    side: str
    open_share: float = 0.0

    def at(self, along_m: float, left_m: float = 0.0) -> Xy:
        """Return the place so far along the stretch, and so far to its left."""
        way = np.subtract(self.b, self.a) / np.hypot(*np.subtract(self.b, self.a))
        x, y = np.asarray(self.a) + along_m * way + left_m * np.array([-way[1], way[0]])
        return float(x), float(y)


def _hang(
    plan: Plan,
    hung: _Hung,
    style: DoorStyle,
    lintel_m: float,
    recess_m: float | None,
) -> bool:
    """Draw a door if its leaf and the ground before it are free."""
    ends = [hung.at(hung.begin_m), hung.at(hung.begin_m + hung.width_m)]
    half_m = plan.thickness_at(hung.at(hung.begin_m + hung.width_m / 2)) / 2
    approach = _approach(ends, half_m)
    swept = _swept(hung, half_m)
    standing = shapely.union_all([leaf.buffer(0.02) for leaf in _standing(hung, half_m)])
    ground = shapely.union_all([swept, approach])
    blocked = any(other.intersects(ground) for other in plan.taken)
    crossed = shapely.union_all([standing, swept])
    clash = any(other.intersects(standing) for other in plan.kept) or any(
        wall.intersection(crossed).area > _SLIVER_M2 for wall in _crossing_walls(plan, hung)
    )
    own = _own(ends, half_m)
    if blocked or clash or any(other.intersects(own) for other in plan.kept):
        return False
    sliding = hung.leaf == "sliding"
    plan.add(
        "opening",
        "LineString",
        [list(np.round(end, 4).tolist()) for end in ends],
        type="door",
        sill_m=0.0,
        lintel_m=lintel_m,
        leaf=hung.leaf,
        open_deg=None if sliding else hung.open_deg,
        open_share=hung.open_share if sliding else None,
        hinge=hung.hinge,
        side=hung.side,
        leaf_thickness_m=style.leaf_m,
        leaf_glass=style.glass or None,
        frame_m=style.frame_m or None,
        recess_m=recess_m,
    )
    plan.kept += [approach, swept]
    return True


def _crossing_walls(plan: Plan, hung: _Hung) -> list[BaseGeometry]:
    """Return the walls on the floor but those in line with a door's own and no thicker."""
    line = LineString([hung.at(-100.0), hung.at(100.0)])
    own_m = plan.thickness_at(hung.at(hung.begin_m + hung.width_m / 2))
    return [
        wall.line_m.buffer(wall.thickness_m / 2, cap_style="flat")
        for wall in plan.walls
        if wall.thickness_m > own_m + 0.005
        or any(shapely.Point(xy).distance(line) > 0.05 for xy in wall.line_m.coords)
    ]


def _draw_passage(
    plan: Plan, a: Xy, b: Xy, tries: list[float], width_m: float, lintel_m: float
) -> bool:
    """Draw an opening without a leaf."""
    for begin_m in tries:
        hung = _Hung(a, b, begin_m, width_m, "", 0.0, "start", "left")
        ends = [hung.at(begin_m), hung.at(begin_m + width_m)]
        half_m = plan.thickness_at(hung.at(begin_m + width_m / 2)) / 2
        approach = _approach(ends, half_m)
        own = _own(ends, half_m)
        if any(o.intersects(approach) for o in plan.taken) or any(
            o.intersects(own) for o in plan.kept
        ):
            continue
        rounded = [np.round(end, 4).tolist() for end in ends]
        values = {"type": "passage", "sill_m": 0.0, "lintel_m": lintel_m}
        plan.add("opening", "LineString", rounded, **values)
        plan.kept.append(approach)
        return True
    return False


def _own(ends: list[Xy], half_m: float) -> Polygon:
    return Polygon(LineString(ends).buffer(half_m, cap_style="flat")).buffer(-0.02)


def _approach(ends: list[Xy], half_m: float) -> Polygon:
    """Return the ground before and behind an opening."""
    return Polygon(LineString(ends).buffer(half_m + _APPROACH_M, cap_style="flat"))


def _leaves(hung: _Hung) -> list[tuple[float, float, int]]:
    """Return the hinges of leaves: along the stretch, the leaf's length, and its direction."""
    low_m, high_m = hung.begin_m, hung.begin_m + hung.width_m
    if hung.leaf == "double":
        return [(low_m, hung.width_m / 2, 1), (high_m, hung.width_m / 2, -1)]
    if hung.hinge == "start":
        return [(low_m, hung.width_m, 1)]
    return [(high_m, hung.width_m, -1)]


def _standing(hung: _Hung, half_m: float) -> list[LineString]:
    """Return where leaves stand, hinge first; a sliding one before the wall beside its opening."""
    sign = 1 if hung.side == "left" else -1
    if hung.leaf == "sliding":
        slid_m = hung.open_share * hung.width_m
        low_m = hung.begin_m + (-slid_m if hung.hinge == "start" else slid_m)
        off_m = sign * (half_m + 0.03)
        return [LineString([hung.at(low_m, off_m), hung.at(low_m + hung.width_m, off_m)])]
    lines = []
    for hinge_m, length_m, way in _leaves(hung):
        turn = np.radians(hung.open_deg)
        reach_m = (length_m - 2 * _PLAY_M) * np.array([way * np.cos(turn), np.sin(turn)])
        tip = hung.at(hinge_m + reach_m[0], sign * (half_m + reach_m[1]))
        lines.append(LineString([hung.at(hinge_m, sign * half_m), tip]))
    return lines


def _swept(hung: _Hung, half_m: float) -> Polygon:
    """Return the ground that leaves sweep between shut and as far as they stand, 90 at least."""
    if hung.leaf == "sliding":
        return Polygon(_standing(hung, half_m)[0].buffer(0.06, cap_style="flat"))
    sign = 1 if hung.side == "left" else -1
    pieces = []
    for hinge_m, length_m, way in _leaves(hung):
        turns = np.radians(np.linspace(0, max(hung.open_deg, 90.0), 13))
        rim = [
            hung.at(hinge_m + way * length_m * np.cos(t), sign * (half_m + length_m * np.sin(t)))
            for t in turns
        ]
        pieces.append(Polygon([hung.at(hinge_m, sign * half_m), *rim]).buffer(0))
    return shapely.union_all(pieces)


def _side(a: Xy, b: Xy, place: Xy) -> str:
    """Return on which side of the way from a to b a place is."""
    cross = (b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0])
    return "left" if cross > 0 else "right"
