"""A prior that can be switched off: most walls of a building run along few directions square to each other.

Which these are is told by the lines themselves. A line is turned to one only where its own points leave that open: a
wall that is truly oblique is known too well to be turned.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry.lines import Line

_SQUARE_RAD = math.pi / 2
_WINDOW_RAD = math.radians(1)
_MOST_ROUNDS = 20


@dataclass(frozen=True)
class RightAnglePrior:
    """When a line is turned.

    Attributes
    ----------
    max_turn_deg : float, >= 0
        Lines further off are oblique; 0 turns none.
    sigmas : float, >= 0
        Nor are lines turned further than so many standard deviations of their direction.
    min_share : float, 0 to 1
        Least share of the length of all lines along a direction, or square to it, for it to be one of the building's.
    registration_sigma_m : float, > 0
        Standard deviation of a registered scan's place.
    """

    max_turn_deg: float
    sigmas: float
    min_share: float
    registration_sigma_m: float


def turn_lines(lines, prior):
    """Turn lines to the directions of the building where their points allow.

    Parameters
    ----------
    lines : list of face_profile.FaceObservation
    prior : Prior

    Returns
    -------
    list of face_profile.FaceObservation
        In the order given; each turned about the middle of its points.
    """
    if not prior.max_turn_deg or not lines:
        return lines
    angle = np.array([math.atan2(*s.line.direction[::-1]) for s in lines])
    length_m = np.array([np.ptp(s.hit_m) if len(s.hit_m) else 0.0 for s in lines])
    found = main_directions(angle, length_m, min_share=prior.min_share)
    if len(found) == 0:
        return lines
    off = _apart(found[:, None], angle)
    turn = off[np.abs(off).argmin(axis=0), np.arange(len(lines))]
    sigma = np.array([_sigma_rad(s, prior.registration_sigma_m) for s in lines])
    free = (length_m > 0) & (
        np.abs(turn) <= np.minimum(prior.sigmas * sigma, math.radians(prior.max_turn_deg))
    )
    return [
        _turned(s, t) if f else s
        for s, t, f in zip(lines, turn.tolist(), free.tolist(), strict=True)
    ]


def main_directions(angle_rad, length_m, *, min_share):
    """Return the directions (k,) of a building, radians, each standing for those square to it.

    The fullest window of one degree to either side, by length, then the next, as long as one holds `min_share` of all.

    Parameters
    ----------
    angle_rad : (n,) float
        Directions of lines.
    length_m : (n,) float
    min_share : float
    """
    found, left = [], np.ones(len(angle_rad), bool)
    for _ in range(_MOST_ROUNDS):
        near = (np.abs(_apart(angle_rad[:, None], angle_rad)) <= _WINDOW_RAD) & left
        held_m = near @ length_m
        best = int(held_m.argmax())
        if not held_m[best] or held_m[best] < min_share * length_m.sum():
            break
        # long lines know their direction best: the variance of a slope falls with the square of the length
        weight = length_m[near[best]] ** 3
        found.append(
            angle_rad[best]
            + np.average(_apart(angle_rad[near[best]], angle_rad[best]), weights=weight)
        )
        left &= ~near[best]
    return np.array(found)


def _apart(one, other):
    """Return by how much one direction is turned from another or from what is square to it, -45 to 45 degrees."""
    return (one - other + _SQUARE_RAD / 2) % _SQUARE_RAD - _SQUARE_RAD / 2


def _sigma_rad(seen, registration_sigma_m):
    """Return the standard deviation of a line's direction: each scan shows its part of the line a little off."""
    scan, index, count = np.unique(seen.hit_scan, return_inverse=True, return_counts=True)
    if len(scan) == 0:
        return 0.0
    middle_m = np.bincount(index, seen.hit_m) / count
    spread_m2 = np.bincount(index, seen.hit_m**2) / count - middle_m**2
    off_m = np.bincount(index, seen.hit_off_m) / count
    sigma_m = math.hypot(registration_sigma_m, float(np.sqrt(np.average(off_m**2, weights=count))))
    # slope of a straight line through the scans' parts, each of them as free to turn as to shift
    information = ((middle_m - middle_m.mean()) ** 2 + spread_m2).sum()
    return math.atan(sigma_m / math.sqrt(information)) if information > 0 else 0.0


def _turned(seen, turn_rad):
    line, middle_m = seen.line, float(np.median(seen.hit_m))
    cos, sin = math.cos(turn_rad), math.sin(turn_rad)
    new = Line(line.at(middle_m), cos * line.normal - sin * line.direction)
    xy_m = line.at(seen.hit_m) + seen.hit_off_m[:, None] * line.normal
    return replace(
        seen,
        line=new,
        # turned by a degree or two, no point moves along the line by more than a millimetre
        hit_m=seen.hit_m - middle_m,
        hit_off_m=new.offset_m(xy_m),
        pass_m=seen.pass_m - middle_m,
        foot_m=seen.foot_m - middle_m,
        panes_m=seen.panes_m - middle_m,
        profiles={},
    )
