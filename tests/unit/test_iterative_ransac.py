from functools import partial

import numpy as np
import pytest

from helpers import extracting, toy_rooms
from reference import ransac as literal
from scanplan.extraction import iterative_ransac

# per face: normal towards the sensor, normal . xy
FACES = [((0, 1), 0), ((0, -1), -4), ((1, 0), 0), ((-1, 0), -6), ((-1, 0), -6), ((-1, 0), -9)]


extract = partial(extracting.extract, "iterative_ransac")


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_every_wall_of_the_room(planar, seed):
    found = extract(
        toy_rooms.laser(seed=seed) if planar else toy_rooms.vlp16(seed=seed), planar=planar
    )
    assert len(found) == len(FACES)
    left = list(FACES)
    for middle_m, normal in zip((found.start_m + found.end_m) / 2, found.normal, strict=True):
        match = next(
            f for f in left if f[0] @ normal > 0.9999 and abs(middle_m @ f[0] - f[1]) < 0.01
        )
        left.remove(match)
    assert not left


def test_moved_room_has_moved_walls():
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    found = extract(toy_rooms.laser(), planar=True)
    moved = extract(
        toy_rooms.laser() @ turn.T + (5, -7, 0), turn @ toy_rooms.SENSOR + (5, -7, 0), planar=True
    )
    assert len(moved) == len(found)
    offsets = (found.start_m * found.normal).sum(axis=1)
    moved_offsets = ((moved.start_m - (5, -7)) * moved.normal).sum(axis=1)
    assert np.sort(moved_offsets) == pytest.approx(np.sort(offsets), abs=0.01)


def test_an_upright_pole_is_no_wall():
    pole = np.column_stack([np.full(300, 2.0), np.full(300, 1.0), np.linspace(0, 2, 300)])
    assert len(extract(pole, (0, 0, 1))) == 0


def test_in_99_percent_of_outliers_there_is_no_wall():
    """A pair of the wall's points is one in 10,000.

    No number of trials that is worth its time finds it.
    """
    draw = np.random.default_rng(1)
    wall = np.column_stack(
        [np.full(400, 3.0), draw.uniform(-1.5, 1.5, 400), draw.uniform(-0.8, 0.8, 400)]
    )
    points = np.vstack([wall, draw.uniform(-20, 20, (39_600, 3)) * (1, 1, 0.1)])
    assert len(extract(points, (0, 0, 0))) == 0


def test_rounds_are_limited():
    assert len(extract(toy_rooms.laser(), planar=True, max_planes=1)) == 1


def test_the_same_lines_as_the_literal_algorithm():
    points = toy_rooms.laser(segments=toy_rooms.ROOM[:3], beams=240)
    rng = np.random.default_rng(1)
    models = literal.repeated(
        (points - toy_rooms.SENSOR)[:, :2],
        model="line",
        inlier_m=0.05,
        min_consensus=20,
        draw_samples=lambda n: literal.draw(n, 2, 60, rng),
    )
    lines = [literal.normal_form(centre, direction) for centre, direction, _ in models]
    found = extract(points, planar=True)
    assert len(found) == len(lines) == 3
    for start_m, normal in zip(found.start_m, found.normal, strict=True):
        offset_m = normal @ (start_m - toy_rooms.SENSOR[:2])
        assert any(-n @ normal > 0.9999 and abs(d + offset_m) < 0.01 for n, d in lines)


def test_largest_plane_is_the_same_on_every_call():
    draw = np.random.default_rng(1)
    points = np.vstack(
        [draw.uniform(-2, 2, (400, 3)) * (1, 1, 0.001), draw.uniform(-2, 2, (300, 3))]
    )
    results = [
        iterative_ransac.find_largest_plane(points, inlier_m=0.02, trials=100, seed=3)
        for _ in range(3)
    ]
    assert all((r[0] == results[0][0]).all() and (r[1] == results[0][1]).all() for r in results)
    assert abs(results[0][0][2]) > 0.99
    assert results[0][1][:400].all()
