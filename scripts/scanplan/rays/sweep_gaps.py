"""Directions in which a scan in space sent no rays: where the sweep of a sensor that turned began.

A sweep's end and its beginning are as far apart as the sensor turned in the meantime. What is
nearer than a sensor measures, and masks of what carries it, leave such gaps, too.
"""

import numpy as np

from scanplan.types import FloatArray

_LEAST_RAD = np.radians(1)
_WIDEST_RAD = np.radians(10)
"""ASSUME of a sensor that turns by 100 degrees a second and sweeps ten times a second; wider gaps
may be openings that nothing came back from."""
_USUAL_SHARE, _TIMES = 0.99, 3.0
"""Gaps of a sweep are so many times as wide as nearly all steps between its rays."""


def find_sweep_gaps(azimuth_rad: FloatArray) -> FloatArray:
    """Return where gaps of a scan begin, and how wide they are: (g, 2) float64, radians.

    Parameters
    ----------
    azimuth_rad : (n,) float64
        Of all returns at any height, increasing, -pi to pi.
    """
    steps_rad = np.diff(azimuth_rad, append=azimuth_rad[:1] + 2 * np.pi)
    (wide,) = np.nonzero((steps_rad > _LEAST_RAD) & (steps_rad <= _WIDEST_RAD))
    if len(wide):
        apart_rad = steps_rad[steps_rad > 0]
        usual_rad = np.quantile(apart_rad, _USUAL_SHARE, method="lower")
        wide = wide[steps_rad[wide] > _TIMES * usual_rad]
    return np.column_stack([azimuth_rad[wide], steps_rad[wide]])
