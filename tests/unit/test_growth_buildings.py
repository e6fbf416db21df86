"""Buildings of the growth bench are as large as they are asked for."""

from collections import Counter

import shapely

from benchmarks.growth_buildings import draw_corridor, draw_glass_hall


def shapes(plan, kind):
    found = [f for f in plan.features if f["properties"]["kind"] == kind]
    return [shapely.geometry.shape(f["geometry"]) for f in found]


def test_rooms_along_a_corridor_have_a_way_each_and_are_as_long_as_asked_for():
    plan = draw_corridor(3, 5.0)
    assert len(shapes(plan, "opening")) == 3 and len(shapes(plan, "room")) == 4
    assert shapely.union_all(shapes(plan, "wall")).bounds == (0, 0, 15, 6)


def test_a_hall_of_glass_differs_by_the_ground_around_it_alone():
    bare, around = draw_glass_hall(has_ground=False), draw_glass_hall(has_ground=True)
    assert bare.features == around.features[: len(bare.features)]
    kinds = Counter(f["properties"]["kind"] for f in around.features[len(bare.features) :])
    assert set(kinds) == {"ground", "furniture"} and kinds["furniture"] > 200
    (ground,) = shapes(around, "ground")
    hall = shapely.box(*shapely.union_all(shapes(bare, "wall")).bounds)
    assert ground.bounds == (-25, -25, 43, 35)
    assert min(tuft.distance(hall) for tuft in shapes(around, "furniture")) > 0
