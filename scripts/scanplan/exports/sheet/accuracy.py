"""How accurate a plan is, as a class that surveyors know."""

import numpy as np

from scanplan.plan.floorplan import FloorPlan, centrelines_m

CLASSES_M = {"LOA50": 0.001, "LOA40": 0.005, "LOA30": 0.015, "LOA20": 0.05}
"""Levels of accuracy (USIBD LOA specification, after DIN 18710): greatest error of 95 %, metres."""


def state_accuracy(plan: FloorPlan) -> str:
    """Return the class of a plan's walls by the standard deviations of their offsets.

    Their mean square counts, by length of wall: of errors of such spread 95 % are below the limit.
    What the sensor's scale or the localiser's map is wrong by is not in it.
    """
    lines_m = centrelines_m(plan.walls)
    lengths_m = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T)
    sigmas_m = np.asarray(plan.walls["sigma_offset_m"], float)
    is_known = np.isfinite(sigmas_m)
    if not is_known.any():
        return "not known"
    square_m2 = np.average(sigmas_m[is_known] ** 2, weights=lengths_m[is_known])
    # 95 % of a normal distribution lie within as many standard deviations
    error_m = 1.96 * float(np.sqrt(square_m2))
    name = next((n for n, limit_m in CLASSES_M.items() if error_m <= limit_m), "LOA10")
    places = 1 if error_m < 0.01 else 0
    return f"{name}: walls ± {1000 * error_m:.{places}f} mm (95 %), relative"
