"""From where to where above the floor openings reach, as usual where the scans do not show it."""

import numpy as np

from scanplan.plan.floorplan import FloorPlan

LEAF_M = 0.04
"""Thickness of a door leaf and a window, usual; nothing thinner is drawn."""
# ASSUME where the scans show no lintel or sill, metres above the floor
_DOOR_M = 2.0  # a usual door's clear height
_SILL_M = 0.9  # a usual balustrade's height


def vertical_extent_m(plan: FloorPlan, row: int) -> tuple[float, float]:
    """Return from where to where above the floor an opening reaches, as usual where not known."""
    columns = plan.openings
    kind = columns["type"][row]
    sill_m = columns["sill_m"][row]
    lintel_m = columns["lintel_m"][row]
    host = plan.hosts[row]
    _, storey_m = plan.storey_m
    wall_m = float(plan.heights_m[host]) if host >= 0 else storey_m
    usual_low_m = _SILL_M if kind == "window" else 0.0
    usual_high_m = _DOOR_M if kind in ("door", "window") else wall_m
    low_m = max(sill_m if np.isfinite(sill_m) else usual_low_m, 0.0)
    high_m = min(lintel_m if np.isfinite(lintel_m) else usual_high_m, wall_m)
    if high_m > low_m + LEAF_M:
        return float(low_m), float(high_m)
    return 0.0, float(wall_m)
