"""Cubes, thinning and rays of clouds, beside what they are by definition."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hn

from scanplan.recordings.merged import storeys
from scanplan.recordings.merged.lattice import (
    REACH,
    Lattice,
    ThinnedCloud,
    pack_cells,
    unpack_keys,
)
from scanplan.recordings.merged.views import RayCaster

CELLS = hn.arrays(
    np.int64, st.tuples(st.integers(1, 30), st.just(3)), elements=st.integers(-REACH, REACH - 1)
)
NEAR = hn.arrays(np.int64, st.tuples(st.integers(1, 40), st.just(3)), elements=st.integers(-9, 9))


@given(CELLS)
def test_keys_tell_cubes_and_sort_as_they_do(cells):
    keys = pack_cells(cells)
    np.testing.assert_array_equal(unpack_keys(keys), cells)
    np.testing.assert_array_equal(np.argsort(keys, kind="stable"), np.lexsort(cells.T[::-1]))


@given(NEAR, st.integers(1, 7))
def test_the_first_point_of_each_cube_is_kept_however_they_come(halves, n_parts):
    xyz_m = halves * 0.5 + 0.25
    cloud = ThinnedCloud(Lattice(np.zeros(3), 1.0), 1000)
    for part in np.array_split(xyz_m, n_parts):
        assert cloud.add(part) == 0
    first = {}
    for point in xyz_m.tolist():
        first.setdefault(tuple(np.floor(point).astype(int).tolist()), point)
    assert list(map(tuple, unpack_keys(cloud.keys).tolist())) == sorted(first)
    np.testing.assert_allclose(cloud.xyz_m, [first[cell] for cell in sorted(first)])


@given(NEAR)
def test_cubes_of_twice_the_size_are_those_of_the_points(cells):
    cloud = ThinnedCloud(Lattice(np.zeros(3), 1.0), 1000)
    cloud.add(cells + 0.5)
    cloud.coarsen()
    other = ThinnedCloud(Lattice(np.zeros(3), 2.0), 1000)
    other.add(cells + 0.5)
    assert cloud.lattice.edge_m == 2.0
    np.testing.assert_array_equal(cloud.keys, other.keys)


def test_a_plane_has_four_cubes_in_one_of_twice_the_size():
    cloud = ThinnedCloud(Lattice(np.zeros(3), 1.0), 1000)
    cloud.add(np.argwhere(np.ones((8, 8, 1))) + 0.5)
    assert cloud.count_in_larger() == 4


def first_entered(cells, begin, way):
    """Return how far along a ray the first cube is that it enters, by the six sides of each."""
    sides = np.sort([(cells - begin) / way, (cells + 1 - begin) / way], axis=0)
    low, high = sides[0].max(axis=1), sides[1].min(axis=1)
    return np.where((low <= high) & (low >= 0), low, np.inf).min()


@settings(max_examples=50)
@given(NEAR, st.integers(0, 2**32 - 1))
def test_a_ray_ends_at_the_first_cube_that_it_enters(cells, seed):
    cells = unpack_keys(np.unique(pack_cells(cells * 5)))
    rng = np.random.default_rng(seed)
    begin = rng.uniform(50, 60, 3) * rng.choice([-1, 1], 3)
    # some go at a cube, which a ray at random seldom meets
    way = np.concatenate([rng.normal(size=(5, 3)), cells[:5] + rng.uniform(0, 1, 3) - begin])
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    ends = RayCaster(pack_cells(cells), 0.1).cast(begin * 0.1, way, 100.0)
    for end, one in zip(ends.tolist(), way, strict=True):
        first = first_entered(cells, begin, one)
        # what it hardly touches it may pass: then neither is wrong
        inner = first_entered(cells + 0.005, begin, one) if np.isfinite(first) else first
        entered = np.inf if end < 0 else first_entered(cells[[end]], begin, one)
        assert entered == first or abs(inner - first) > 0.05 or abs(entered - first) < 0.01


def test_a_ray_goes_no_farther_than_its_reach():
    caster = RayCaster(pack_cells(np.array([[50, 0, 0]])), 0.1)
    way = np.array([[1.0, 0.0, 0.0]])
    begin_m = np.array([0.05, 0.05, 0.05])
    assert caster.cast(begin_m, way, 5.5)[0] == 0 and caster.cast(begin_m, way, 4.5)[0] == -1


@pytest.mark.parametrize(("width", "length"), [(8, 60), (30, 50)])
def test_places_lie_farther_apart_than_what_stands_beside_them(width, length):
    """A floor of so many cells of 10 cm, a wall around it and nothing else."""
    floor = np.argwhere(np.ones((width, length)))
    cells = np.column_stack([floor, np.zeros(len(floor), int)])
    ceiling = cells + np.array([0, 0, 25])
    keys = np.sort(pack_cells(np.concatenate([cells, ceiling])))
    columns = storeys.find_floor(keys, unpack_keys(keys)[:, 2] * 0.1)
    assert columns.is_floor.sum() == width * length
    places = storeys.choose_places(columns, storeys.Storey(0.0, 0.01 * width * length, np.nan))
    clear_m = np.minimum(places, np.array([width, length]) * 0.1 - places).min(axis=1)
    assert (clear_m >= 0.25 - 0.05).all() and len(places) > 0
    apart_m = np.linalg.norm(places[:, None] - places[None], axis=2)
    needed_m = np.minimum(clear_m[:, None] + clear_m[None], 1.5)
    np.fill_diagonal(apart_m, np.inf)
    assert (apart_m >= needed_m - 0.11).all()
