"""From where to where above the floor openings reach, as usual where the scans do not show it."""

import numpy as np

from scanplan.plan.floorplan import FloorPlan

LEAF_M = 0.04
"""Thickness of a door leaf and a window, usual; nothing thinner is drawn."""


def vertical_extent_m(plan: FloorPlan, row: int) -> tuple[float, float]:
    """Return from where to where above the floor an opening reaches, as usual where not known."""
    columns = plan.openings
    kind = columns["type"][row]
    sill_m = columns["sill_m"][row]
    lintel_m = columns["lintel_m"][row]
    host = plan.hosts[row]
    _, storey_m = plan.storey_m
    wall_m = float(plan.heights_m[host]) if host >= 0 else storey_m
    # ASSUME a usual balustrade and clear height; where there is no leaf the wall's height
    usual_m = {"window": (0.9, 2.0), "door": (0.0, 2.0)}
    usual_low_m, usual_high_m = usual_m.get(kind, (0.0, wall_m))
    low_m = max(sill_m if np.isfinite(sill_m) else usual_low_m, 0.0)
    high_m = min(lintel_m if np.isfinite(lintel_m) else usual_high_m, wall_m)
    if high_m > low_m + LEAF_M:
        return float(low_m), float(high_m)
    return 0.0, float(wall_m)
