"""Latitude and longitude of places in zones of UTM.

Other systems are left alone: their parameters are in the EPSG's registry, which no package of the
environment holds.
"""

import cmath
import math

from scanplan.project.reference_systems import find_zone

_A_M, _FLATTENING = 6378137.0, 1 / 298.257222101
"""Of GRS 80; the ellipsoid of WGS 84 differs by a tenth of a millimetre."""
_SCALE, _EAST_M, _SOUTH_M = 0.9996, 500_000.0, 10_000_000.0
"""On the central meridian; what is added to eastings, and to northings of the south."""


def find_geographic(crs: str | None, east_m: float, north_m: float) -> tuple[float, float] | None:
    """Return latitude and longitude of a place, degrees; None outside of UTM.

    By Krüger's series to the fourth order, a hundredth of a millimetre within a zone.

    >>> tower = find_geographic("EPSG:32617", 630084.0, 4833438.0)  # CN Tower, Toronto
    >>> [round(angle, 4) for angle in tower]
    [43.6426, -79.3871]
    >>> find_geographic("EPSG:31467", 3500000.0, 5400000.0) is None
    True
    """
    zone = find_zone(crs)
    if zone is None:
        return None
    number, is_south = zone
    n = _FLATTENING / (2 - _FLATTENING)
    radius_m = _SCALE * _A_M / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    north_m -= _SOUTH_M if is_south else 0.0
    place = complex(north_m, east_m - _EAST_M) / radius_m
    to_sphere = (
        n / 2 - 2 * n**2 / 3 + 37 * n**3 / 96 - n**4 / 360,
        n**2 / 48 + n**3 / 15 - 437 * n**4 / 1440,
        17 * n**3 / 480 - 37 * n**4 / 840,
        4397 * n**4 / 161280,
    )
    of_sphere = place - sum(
        beta * cmath.sin(2 * order * place) for order, beta in enumerate(to_sphere, 1)
    )
    conformal_rad = math.asin(math.sin(of_sphere.real) / math.cosh(of_sphere.imag))
    east_rad = math.atan2(math.sinh(of_sphere.imag), math.cos(of_sphere.real))
    to_ellipsoid = (
        2 * n - 2 * n**2 / 3 - 2 * n**3 + 116 * n**4 / 45,
        7 * n**2 / 3 - 8 * n**3 / 5 - 227 * n**4 / 45,
        56 * n**3 / 15 - 136 * n**4 / 35,
        4279 * n**4 / 630,
    )
    latitude_rad = conformal_rad + sum(
        delta * math.sin(2 * order * conformal_rad) for order, delta in enumerate(to_ellipsoid, 1)
    )
    meridian_deg = 6 * number - 183
    return math.degrees(latitude_rad), meridian_deg + math.degrees(east_rad)
