"""The experiments beyond the thesis's, in the order of their page."""

from thesis.beyond.shown import (
    connected_scans,
    disturbed_scans,
    equal_points,
    floors,
    good_plans,
    live_scans,
    turning_claims,
)

EXPERIMENTS = {
    "budgets": equal_points.EXPERIMENT,
    "quality_times": good_plans.EXPERIMENT,
    "floors": floors.EXPERIMENT,
    "outliers": disturbed_scans.EXPERIMENT,
    "registrability": connected_scans.EXPERIMENT,
    "live_choice": live_scans.EXPERIMENT,
    "sensitivity": turning_claims.EXPERIMENT,
}
"""By the stems of their tables."""
