"""What holds for every extractor of ours."""

import numpy as np
import pytest

from helpers import toy_rooms
from helpers.extracting import SETTINGS, extract, values
from helpers.upright import returns
from scanplan.extraction.extractors import EXTRACTORS, select_settings
from scanplan.extraction.segments import SegmentLimits

OURS = [name for name, extractor in EXTRACTORS.items() if extractor.drops_clutter]
pytestmark = pytest.mark.parametrize("name", OURS)
EITHER = pytest.mark.parametrize("planar", [False, True])


def room(planar, **more):
    return toy_rooms.laser(**more) if planar else toy_rooms.vlp16(**more)


@EITHER
def test_the_same_walls_again_and_in_any_order_of_points(name, planar):
    points = room(planar)
    first = values(extract(name, points, planar=planar))
    shuffled = np.random.default_rng(0).permutation(points)
    assert len(first) == 6
    assert (first == values(extract(name, points, planar=planar))).all()
    assert (first == values(extract(name, shuffled, planar=planar))).all()


@EITHER
def test_a_map_far_from_its_origin(name, planar):
    points, shift = room(planar), np.array([1e6, -1e6, 0])
    near = extract(name, points, planar=planar)
    far = extract(name, points + shift, toy_rooms.SENSOR + shift, planar=planar)
    # its points are rounded to a ten-millionth of a metre there, and random draws may differ
    assert far.start_m - shift[:2] == pytest.approx(near.start_m, abs=0.01)
    assert far.end_m - shift[:2] == pytest.approx(near.end_m, abs=0.01)


@EITHER
@pytest.mark.parametrize(
    "points",
    [
        np.empty((0, 3)),
        [(1, 2, 3)],
        [(1, 2, 3), (2, 2, 3)],
        [(1, 2, 3)] * 500,
        [(0, 0, 0)] * 50,
        np.random.default_rng(1).uniform(1, 6, (2, 3)),
    ],
)
def test_no_wall_in_next_to_nothing(name, points, planar):
    assert len(extract(name, points, (0, 0, 0), planar=planar)) == 0


def test_a_line_of_points_is_a_wall_in_the_plane_alone(name):
    line = np.column_stack([np.linspace(-2, 2, 400), np.full(400, 2.0), np.full(400, 0.7)])
    assert len(extract(name, line, (0, 0, 0.5))) == 0
    found = extract(name, line, (0, 0, 0.5), planar=True)
    assert found.start_m == pytest.approx(np.array([(2, 2)]))
    assert found.end_m == pytest.approx(np.array([(-2, 2)]))


def test_a_floor_is_no_wall(name):
    x, y = np.meshgrid(np.arange(-4, 4, 0.05), np.arange(-4, 4, 0.05))
    z = np.random.default_rng(1).normal(0, 0.01, x.size)
    assert len(extract(name, np.column_stack([x.ravel(), y.ravel(), z]), (0, 0, 0.8))) == 0


def test_one_beam_in_space_shows_no_upright_surface(name):
    assert len(extract(name, toy_rooms.laser(beams=1800))) == 0


def test_duplicate_points_are_more_points(name):
    assert len(extract(name, np.repeat(toy_rooms.vlp16(), 2, axis=0))) == 6


def test_points_must_be_finite(name):
    points = toy_rooms.vlp16()
    points[17, 1] = np.nan
    with pytest.raises(ValueError, match="finite"):
        extract(name, points)


def test_what_scatters_more_than_walls_do_is_none(name):
    points = returns([(4, -1, 4, 1, 0, 2.6)])
    rough = points + np.random.default_rng(1).normal(0, 0.03, points.shape) * (1, 0, 0)
    found = extract(name, rough, (0, 0, 0), max_rmse_m=np.inf, inlier_m=0.1)
    assert len(found) > 0 and found.rmse_m.max() > 0.025
    assert len(extract(name, rough, (0, 0, 0), inlier_m=0.1)) < len(found)
    half_m = found.rmse_m.min() / 2
    assert len(extract(name, rough, (0, 0, 0), max_rmse_m=half_m, inlier_m=0.1)) == 0


def test_settings_are_picked_from_more(name):
    kind = EXTRACTORS[name].settings
    assert issubclass(kind, SegmentLimits)
    every = SETTINGS[name] | toy_rooms.FURNITURE | {"other": 1}
    assert vars(select_settings(kind, every)) == SETTINGS[name]
    with pytest.raises(KeyError, match="seed"):
        select_settings(kind, {key: value for key, value in every.items() if key != "seed"})
