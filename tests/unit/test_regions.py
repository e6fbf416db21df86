import numpy as np
import pytest
import shapely
from shapely import box

from helpers.hull_making import scattered
from scanplan.selection.union_area import regions


def test_inside_a_box_the_region_is_the_union_of_all_that_is_covered():
    polygons = shapely.get_parts(np.array(scattered(50)))
    # of all sizes, so that windows are too
    factors = np.geomspace(0.02, 3, len(polygons))
    polygons = np.array(
        [shapely.affinity.scale(p, f, f) for p, f in zip(polygons, factors, strict=True)]
    )
    around, union = regions.Regions(polygons), shapely.Polygon()
    for chosen in np.random.default_rng(1).permutation(len(polygons))[:40].reshape(8, 5):
        around.cover(polygons[chosen], shapely.difference(polygons[chosen], union))
        union = shapely.union_all([union, *polygons[chosen]])
        found = shapely.difference(polygons, around.around(np.arange(len(polygons))))
        assert shapely.area(found) == pytest.approx(
            shapely.area(shapely.difference(polygons, union)), abs=1e-9
        )


def test_far_ones_are_not_looked_at():
    polygons = np.array([box(0, 0, 1, 1), box(0.5, 0, 1.5, 1), box(1000, 0, 1001, 1)])
    around = regions.Regions(polygons)
    around.cover(polygons[[1, 2]], polygons[[1, 2]])
    near, far = around.around(np.array([0, 2]))
    assert near.equals(polygons[1])
    assert far.equals(polygons[2])
