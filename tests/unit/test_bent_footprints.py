"""How long walls are, straight and curved."""

import numpy as np
import pytest

from scanplan.plan.curves.bent_footprints import WallShapes


def test_a_straight_wall_is_as_long_as_its_line_and_a_curved_one_as_its_arc():
    """Of 3 m by 4 m, and a quarter turn at 2 m around the origin."""
    lines_m = np.array([[(1.0, 1.0), (4.0, 5.0)], [(2.0, 0.0), (0.0, 2.0)]])
    centres_m = np.array([(np.nan, np.nan), (0.0, 0.0)])
    walls = WallShapes(lines_m, np.zeros(2), np.zeros(2), centres_m)
    assert walls.measure_lengths_m() == pytest.approx([5.0, np.pi])
