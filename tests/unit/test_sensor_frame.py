import numpy as np
import pytest

from scanplan.rays import sensor_frame


def test_order_of_points_depends_on_the_points_alone():
    points = np.random.default_rng(1).normal(size=(50, 3)).round(1)
    shuffled = np.random.default_rng(2).permutation(points)
    assert (
        sensor_frame.centre_in_order(points, (1, 2, 3))
        == sensor_frame.centre_in_order(shuffled, (1, 2, 3))
    ).all()


def test_points_are_relative_to_the_sensor_in_the_order_given():
    points = np.random.default_rng(1).normal(size=(50, 3))
    np.testing.assert_array_equal(
        sensor_frame.centre_on_sensor(points, (1, 2, 3)), points - np.array((1, 2, 3))
    )


@pytest.mark.parametrize(
    ("xyz_m", "sensor"),
    [
        ([(0, 0, np.nan)], (0, 0, 0)),
        ([(0, np.inf, 0)], (0, 0, 0)),
        ([(0, 0, 0)], (0, np.nan, 0)),
        ([(0, 0)], (0, 0, 0)),
        ([(0, 0, 0)], (0, 0)),
    ],
)
def test_points_must_be_finite_and_in_space(xyz_m, sensor):
    with pytest.raises(ValueError, match=r"finite|points"):
        sensor_frame.centre_on_sensor(xyz_m, sensor)
