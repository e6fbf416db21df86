import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan


def test_solid_walls_have_the_area_that_is_worked_out_on_paper():
    east = 3.4 * 0.1
    # cut off square where the single face begins, and half-way across the end of the partition
    inferred = (3.0 + 3.05) / 2 * 0.1 + 3.05 * 0.1
    cut = 1.0 * 0.2 + 0.9 * 0.1 + 1.2 * 0.2
    assert plan().solid("inferred").area == pytest.approx(inferred, abs=1e-3)
    assert plan().solid("observed").area == pytest.approx(
        floorplan_making.FOOTPRINT_M2 - east - inferred - cut, abs=1e-3
    )


def test_openings_are_cut_through():
    walls = shapely.union(plan().solid("observed"), plan().solid("inferred"))
    for line in ((-1, 1.5, 1, 1.5), (3, 1.5, 5, 1.5), (1.5, -1, 1.5, 1)):
        assert not shapely.LineString(np.reshape(line, (2, 2))).intersects(walls)
    assert shapely.LineString([(3, 2.5), (5, 2.5)]).intersects(walls)


def test_single_faces_end_at_the_surfaces_of_the_walls_they_meet():
    east, loose = sorted(plan().single("observed"), key=lambda line: -line.length)
    assert east.bounds == pytest.approx((7.1, 0, 7.1, 3), abs=1e-3)
    assert loose.bounds == (2, 2, 3, 2)
    assert len(plan().single("inferred")) == 0


def test_a_surface_that_runs_on_beyond_a_corner_is_cut_there():
    rows = [
        ((-4.0, 0.0, 0.25, 0.0), np.nan, 0, -1, "observed"),
        ((0.0, -0.25, 0.0, 3.0), np.nan, 1, -1, "observed"),
    ]
    drawn = plan(
        faces=floorplan_making.faces([(-4, 0, 0.25, 0, 0), (0, -0.25, 0, 3, 1)]),
        walls=floorplan_making.walls(rows),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms([]),
    )
    assert sorted(line.length for line in drawn.single("observed")) == pytest.approx([3, 4])


def test_what_is_assumed_lies_behind_the_face():
    assert plan().bodies[1].bounds == pytest.approx((7.1, -0.2, 7.2, 3.2))
    turned = floorplan_making.walls()
    turned["face_left"][1], turned["face_right"][1] = -1, 1
    assert plan(walls=turned).bodies[1].bounds[:3:2] == pytest.approx((7.0, 7.1))


@pytest.mark.parametrize(
    ("perhaps", "reaches_m"),
    [((False, False), (3.1, 2.9)), ((False, True), (3.0, 3.0)), ((True, False), (3.1, 2.9))],
)
def test_what_may_be_furniture_cuts_no_corner_off_a_wall(perhaps, reaches_m):
    rows = [((0, 0, 3, 0), 0.2, 0, 1, "observed"), ((3, 0, 3, 2), 0.2, 2, 3, "observed")]
    walls = {**floorplan_making.walls(rows), "perhaps": np.array(perhaps)}
    body = plan(walls=walls, openings=floorplan_making.openings([])).bodies[0]
    # mitred with the second wall, it ends at 45 degrees
    sides = [shapely.LineString([(0, y_m), (9, y_m)]) for y_m in (-0.099, 0.099)]
    ends_m = [side.intersection(body).bounds[2] for side in sides]
    assert ends_m == pytest.approx(reaches_m, abs=0.002)


def test_a_plan_of_faces_alone_has_lines_only():
    assert bare().solid("observed").is_empty
    assert [line.length for line in bare().single("observed")] == [5, 2]
    np.testing.assert_allclose(bare().bounds_m, [(0, 0), (10, 3)])


def test_the_storey_reaches_from_the_floor_to_the_ceiling():
    assert plan(floor_z_m=-0.1, ceiling_z_m=2.6).storey_m == pytest.approx((-0.1, 2.7))


def test_without_a_ceiling_it_is_as_high_as_the_highest_wall():
    walls = floorplan_making.walls()
    walls["z_min_m"] -= 1
    walls["z_min_m"][3] = np.nan
    walls["z_max_m"][5] = 0.7
    assert plan(walls=walls).storey_m == (-1, floorplan_making.HEIGHT_M + 1)
    assert plan(walls=walls, floor_z_m=0.0).storey_m == (0, floorplan_making.HEIGHT_M)


def test_without_a_ceiling_it_is_no_lower_than_assumed():
    walls = floorplan_making.walls() | {"z_max_m": np.full(6, 1.4)}
    low, high = plan(walls=walls, floor_z_m=0.0), plan(floor_z_m=0.0, assumed_height_m=2.2)
    assert (low.storey_m, low.height_from) == ((0.0, 2.5), "assumed")
    assert (high.storey_m, high.height_from) == ((0.0, floorplan_making.HEIGHT_M), "walls")
    assert plan(floor_z_m=-0.1, ceiling_z_m=2.6).height_from == "ceiling"


def test_walls_end_at_the_ceiling_or_where_they_were_seen_to():
    walls = floorplan_making.walls() | {
        "top_m": np.array([np.nan, 1.5, np.nan, np.nan, 3.0, np.nan])
    }
    drawn = plan(walls=walls, floor_z_m=-0.1, ceiling_z_m=2.6)
    assert drawn.low.tolist() == [False, True, False, False, False, False]
    assert drawn.heights_m == pytest.approx([2.7, 1.6, 2.7, 2.7, 2.7, 2.7])


@pytest.mark.parametrize("z_m", [0.3, np.nan])
def test_the_height_of_a_planar_survey_is_assumed(z_m):
    walls = floorplan_making.walls() | {"z_min_m": np.full(6, z_m), "z_max_m": np.full(6, z_m)}
    assert plan(walls=walls, assumed_height_m=3.0).storey_m == (np.nan_to_num(z_m), 3.0)
    assert bare().storey_m == (0.0, 2.5)


def test_rooms_are_at_least_as_high_as_walls_were_seen():
    low = floorplan_making.walls() | {"z_max_m": np.full(6, 1.4)}
    # lower than what the storey is assumed to be
    assert plan(walls=low, floor_z_m=0.0).least_height_m == pytest.approx(1.4)
    assert plan(floor_z_m=-0.1, ceiling_z_m=2.6).least_height_m == pytest.approx(2.7)
    planar = low | {"z_min_m": np.full(6, np.nan), "z_max_m": np.full(6, np.nan)}
    assert np.isnan(plan(walls=planar).least_height_m)
