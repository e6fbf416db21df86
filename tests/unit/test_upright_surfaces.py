import numpy as np
import pytest

from helpers import toy_rooms
from scanplan.extraction import normals, upright_surfaces

REACH_DEG = 3.5
PIECE_M = 0.125


def find(xyz_m):
    return upright_surfaces.find_in_space(
        xyz_m, reach_deg=REACH_DEG, max_tilt_deg=15.0, max_length_m=PIECE_M
    )


def wall(distance_m, length_m=6.0, spacing_m=0.02):
    """A wall across the x axis, 2 m high, as a sensor 1 m above the floor would see it."""
    y, z = np.meshgrid(np.arange(-length_m / 2, length_m / 2, spacing_m), np.arange(-1, 1, 0.05))
    return np.column_stack([np.full(y.size, float(distance_m)), y.ravel(), z.ravel()])


@pytest.mark.parametrize("distance_m", [2, 5, 10, 20])
def test_pieces_cover_a_wall_evenly_and_stand_for_all_of_its_returns(distance_m):
    xyz_m = wall(distance_m)
    found = find(xyz_m)
    assert found.n_points.sum() == pytest.approx(len(xyz_m))
    np.testing.assert_allclose(
        found.normal, np.tile((-1.0, 0.0), (len(found.normal), 1)), atol=1e-6
    )
    np.testing.assert_allclose(found.xy_m[:, 0], distance_m, atol=1e-6)
    metres = np.histogram(found.xy_m[:, 1], np.arange(-3, 3.5), weights=found.n_points)[0]
    np.testing.assert_allclose(metres, len(xyz_m) / 6, rtol=0.15)
    # a piece for every stretch of its length, and none beyond the ends
    assert np.diff(np.sort(found.xy_m[:, 1])).max() <= PIECE_M + 0.02
    assert np.abs(found.xy_m[:, 1]).max() <= 3.0


@pytest.mark.parametrize("distance_m", [2, 10])
def test_pieces_reach_as_high_and_as_low_as_their_returns(distance_m):
    found = find(wall(distance_m))
    assert (found.z_m + found.half_height_m).max() == pytest.approx(0.95, abs=0.03)
    assert (found.z_m - found.half_height_m).min() == pytest.approx(-1.0, abs=0.03)


def test_pieces_show_as_much_of_every_wall_as_single_returns_do():
    xyz_m = toy_rooms.vlp16() - toy_rooms.SENSOR
    normal = normals.estimate_surface_normals(xyz_m, reach_deg=REACH_DEG)
    upright = np.abs(normal[:, 2]) <= np.sin(np.deg2rad(15.0))
    found = find(xyz_m)
    for axis in (0, 1):
        for sign in (-1, 1):
            alone = upright & (sign * normal[:, axis] > 0.9)
            together = sign * found.normal[:, axis] > 0.9
            bins = np.arange(-8, 8.5, 0.5)
            of_returns = np.histogram(xyz_m[alone, 1 - axis], bins)[0]
            of_pieces = np.histogram(
                found.xy_m[together, 1 - axis], bins, weights=found.n_points[together]
            )[0]
            assert of_pieces.sum() == pytest.approx(of_returns.sum(), rel=0.01)
            assert np.abs(of_pieces - of_returns).sum() < 0.1 * of_returns.sum()


def test_what_lies_level_or_is_too_little_is_no_upright_surface():
    x, y = np.meshgrid(np.arange(1, 4, 0.03), np.arange(-2, 2, 0.03))
    floor = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, -0.8)])
    for nothing in (floor, np.empty((0, 3)), np.ones((3, 3))):
        found = find(nothing)
        assert found.xy_m.shape == found.normal.shape == (0, 2)
        assert len(found.n_points) == len(found.z_m) == len(found.half_height_m) == 0


def test_in_the_plane_every_return_is_a_piece_without_height():
    y = np.arange(-2, 2, 0.02)
    found = upright_surfaces.find_in_the_plane(
        np.column_stack([np.full(len(y), 3.0), y]), reach_deg=REACH_DEG
    )
    assert len(found.xy_m) == len(y)
    assert (found.n_points == 1).all() and not found.half_height_m.any()
    np.testing.assert_allclose(np.abs(found.normal[:, 0]), 1.0)
