"""How accurate a plan is, as a class that surveyors know."""

from dataclasses import dataclass

import numpy as np

from scanplan.exports.sheet.locale import ENGLISH, Locale
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.stage.witness_table import PLAN
from scanplan.validation.verdict import judge_plan

CLASSES_M = {"LOA50": 0.001, "LOA40": 0.005, "LOA30": 0.015, "LOA20": 0.05}
"""Levels of accuracy (USIBD LOA specification, after DIN 18710): greatest error of 95 %, metres."""
CLOCKS_SIGMA = 0.0002
"""Of the scale of ranges, as a share: clocks of sensors are off by a ten-thousandth."""

_MOST_DOUBTED = 0.5  # of the walls' length: beyond it most errors are not those that are known


@dataclass(frozen=True)
class SensorErrors:
    """What a sensor's ranges may be wrong by, standard deviations.

    Attributes
    ----------
    offset_m : float
        Of a constant that is in all of them.
    scale : float
        Of their scale, as a share.
    """

    offset_m: float = 0.0
    scale: float = 0.0


def state_accuracy(
    plan: FloorPlan, sensor: SensorErrors = SensorErrors(), locale: Locale = ENGLISH
) -> str:
    """Return the class of a plan's walls by the standard deviations of their offsets.

    Their mean square counts, by length of wall: of errors of such spread 95 % are below the limit.
    What all ranges are off by comes to it, and their scale over half of the plan's longer side.
    None is stated of what is not a plan, or whose walls are in doubt for the most part.
    """
    verdict = judge_plan(plan)
    if verdict.worth != PLAN:
        return f"none stated of {verdict.worth.replace('not a', 'what is no')}"
    lines_m = centrelines_m(plan.walls)
    lengths_m = plan.lengths_m
    sigmas_m = np.asarray(plan.walls["sigma_offset_m"], float)
    is_known = np.isfinite(sigmas_m)
    if not is_known.any():
        return "not known"
    is_doubted = np.asarray(plan.walls.get("verify", np.zeros(len(lengths_m))), bool)
    if lengths_m[is_doubted].sum() > _MOST_DOUBTED * lengths_m.sum():
        return "none stated, as most of the walls are to be verified"
    square_m2 = np.average(sigmas_m[is_known] ** 2, weights=lengths_m[is_known])
    reach_m = float(np.ptp(lines_m.reshape(-1, 2), axis=0).max()) / 2
    sensor_m2 = sensor.offset_m**2 + (sensor.scale * reach_m) ** 2
    # 95 % of a normal distribution lie within as many standard deviations
    error_m, of_sensor_m = 1.96 * np.sqrt([square_m2 + sensor_m2, sensor_m2])
    name = next((n for n, limit_m in CLASSES_M.items() if error_m <= limit_m), "LOA10")
    error, of_sensor = map(locale.error, (error_m, of_sensor_m))
    return f"{name}: walls ± {error} (95 %), of which the sensor ± {of_sensor}"
