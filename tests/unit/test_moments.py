import numpy as np
import pytest

from scanplan.geometry import moments


@pytest.mark.parametrize("d", [2, 3])
def test_the_same_axes_as_numpy(d):
    draw = np.random.default_rng(d)
    groups = [
        draw.normal(size=(20, d)) * np.r_[draw.uniform(0.5, 2, d - 1), 0.01] for _ in range(50)
    ]
    turns = [np.linalg.qr(draw.normal(size=(d, d)))[0] for _ in groups]
    points = np.concatenate(
        [g @ t.T + draw.uniform(-20, 20, d) for g, t in zip(groups, turns, strict=True)]
    )
    owner = np.repeat(np.arange(50), 20)
    axes = moments.least_variance_direction(moments.group_moments(points, owner, 50)).T
    for group, axis in enumerate(axes):
        expected = np.linalg.eigh(np.cov(points[owner == group].T))[1][:, 0]
        assert abs(axis @ expected) == pytest.approx(1, abs=1e-9)
        assert np.linalg.norm(axis) == pytest.approx(1)


@pytest.mark.parametrize(
    "points",
    [
        np.zeros((9, 3)),
        np.outer(np.arange(9), (1, 2, 3)),
        np.random.default_rng(1).normal(size=(5, 3)) * (1, 1, 0),
        np.random.default_rng(1).normal(size=(50, 3)),
    ],
    ids=["a point", "a line", "too few", "a ball"],
)
def test_no_axis_where_none_is_clearly_the_least(points):
    sums = moments.group_moments(points.astype(float), np.zeros(len(points), int), 1)
    assert np.isnan(moments.least_variance_direction(sums)).all()
