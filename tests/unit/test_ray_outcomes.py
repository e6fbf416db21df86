import numpy as np
import pytest

from helpers import floorplan_making, ray_making
from scanplan.validation import drawn_surfaces, ray_outcomes

SENSOR = (2.0, 1.5, 1.0)
TOLERANCE_M = 0.05


def judged(*ends, plan=None, planar=False, sensor=SENSOR):
    """Return each ray's outcome, and the kinds, numbers and verdicts that it speaks of."""
    surfaces = drawn_surfaces.list_surfaces(plan or floorplan_making.plan(), 1.0, planar=planar)
    rays = ray_making.rays((sensor, ends), planar=planar)
    found = ray_outcomes.cast_rays(rays, surfaces, TOLERANCE_M)
    order = [int(np.flatnonzero((rays.xyz_m == end).all(axis=1))[0]) for end in np.array(ends)]
    names = np.array(ray_outcomes.OUTCOMES)
    kinds, numbers = (surfaces.elements[name][found.element] for name in ("kind", "number"))
    said = list(zip(kinds.tolist(), numbers.tolist(), names[found.verdict].tolist(), strict=True))
    spoken = [
        {said[i][:2]: said[i][2] for i in np.flatnonzero(found.row == row).tolist()}
        for row in order
    ]
    return names[found.outcome][order].tolist(), spoken


@pytest.mark.parametrize(
    ("end", "outcome", "spoken"),
    [
        ((4.0, 2.5, 1.0), "explained", {("face", 5): "explained"}),
        ((3.96, 2.5, 1.0), "explained", {("face", 5): "explained"}),
        ((4.04, 2.5, 1.0), "explained", {("face", 5): "explained"}),
        # 0.07 m before the face, square to it
        ((3.93, 2.5, 1.0), "stopped", {}),
        ((3.0, 1.0, 1.0), "stopped", {}),
        # through the partition
        ((5.0, 2.7, 1.0), "passed", {("face", 5): "passed"}),
        # through the door, to the east face
        ((7.1, 1.5, 1.0), "explained", {("opening", 1): "explained", ("face", 1): "explained"}),
        # a leaf stands in the door
        ((4.05, 1.5, 1.0), "stopped", {("opening", 1): "stopped"}),
        # above the lintel, and onto the wall there
        ((6.0, 1.5, 3.6), "passed", {("opening", 1): "passed"}),
        ((4.0, 1.5, 2.3), "explained", {("opening", 1): "explained"}),
        # out of the window, and onto its parapet
        ((1.3, -5.0, 1.5), "outside", {("opening", 2): "explained"}),
        ((1.6, 0.0, 0.5), "explained", {("opening", 2): "explained"}),
        # onto the door's reveal, across the wall
        ((4.05, 1.9, 1.0), "explained", {}),
    ],
)
def test_what_becomes_of_a_ray(end, outcome, spoken):
    assert judged(end) == ([outcome], [spoken])


def test_a_tolerance_is_square_to_the_surface():
    # 2 m along the wall y = 0 it errs by 0.04 m square to it, and by 0.9 m along the ray
    assert judged((3.1, 0.04, 1.0), sensor=(0.5, 0.15, 1.0))[0] == ["explained"]


def test_what_passes_within_what_an_end_errs_by_speaks_not_against_it():
    # the loose face from (2, 2) to (3, 2): its end may be 0.1 m off
    ends = [(2.95, 3.0, 1.0), (2.5, 3.0, 1.0)]
    sensor = (2.95, 1.0, 1.0)
    outcomes, spoken = judged(*ends, sensor=sensor)
    assert outcomes == ["explained", "passed"]
    assert ("face", 8) not in spoken[0] and spoken[1] == {("face", 8): "passed"}


def without_face(number):
    rows = [row for row in floorplan_making.FACES if row != floorplan_making.FACES[number]]
    return floorplan_making.plan(faces=floorplan_making.faces(rows))


def test_a_wall_that_is_not_drawn_stops_rays_in_the_outline():
    # the north side of the small room and what is behind it: nothing further on is drawn
    plan = without_face(2)
    ends = [(5.5, 3.0, 1.0), (5.5, 4.0, 1.0)]
    outcomes, spoken = judged(*ends, plan=plan, sensor=(5.5, 1.5, 1.0))
    assert outcomes == ["beyond", "beyond"]
    assert spoken == [{("outline", 1): "stopped"}, {("outline", 1): "explained"}]


def test_rays_end_at_a_front_of_glass_or_go_through_it():
    """It is the north side of the small room; nothing further on is drawn."""
    pane = ((4.2, 3.0, 7.1, 3.0), -1, "glass", np.nan, np.nan, 1, -1)
    openings = floorplan_making.openings([*floorplan_making.OPENINGS, pane])
    rows = [row for row in floorplan_making.FACES if row != floorplan_making.FACES[2]]
    plan = floorplan_making.plan(faces=floorplan_making.faces(rows), openings=openings)
    ends = [(5.5, 2.5, 1.0), (5.5, 3.0, 1.0), (5.5, 4.0, 1.0)]
    outcomes, spoken = judged(*ends, plan=plan, sensor=(5.5, 1.5, 1.0))
    number = len(floorplan_making.OPENINGS)
    assert outcomes == ["stopped", "explained", "outside"]
    assert spoken == [{}, *[{("opening", number): "explained"}] * 2]


def test_a_planar_sensor_has_no_heights():
    # in space this ray would meet the parapet, and that one the lintel
    ends = [(1.6, -3.0, 0.5), (6.9, 1.5, 2.4)]
    assert judged(*ends, planar=True)[0] == ["outside", "stopped"]


def test_faces_are_cut_into_spans_between_openings():
    surfaces = drawn_surfaces.list_surfaces(floorplan_making.plan(), 1.0, planar=False)
    elements = surfaces.elements
    of_west = (elements["kind"] == "face") & (elements["number"] == 4)
    # 3 m of face less a door of 1 m in its middle
    np.testing.assert_allclose(np.sort(elements["y0_m"][of_west]), [1.0, 3.0])
    of_north = (elements["kind"] == "face") & (elements["number"] == 3)
    assert elements["span"][of_north].tolist() == [0, 1, 2, 3]
    np.testing.assert_allclose(elements["x1_m"][of_north], [3.0, 2.0, 1.0, 0.0])
    assert elements["span"][of_west].tolist() == [0, 1]
    assert not (elements["kind"] == "outline").any()


def test_an_opening_at_the_end_of_a_face_leaves_no_part_without_a_length():
    # of the face from (0, 3) to (0, 0) all but the last rounding of its begin
    entrance = ((-0.1, 1.0, -0.1, np.nextafter(3.0, 0)), 4, "door", 0.0, 2.0, 0, -1)
    openings = floorplan_making.openings([entrance, *floorplan_making.OPENINGS[1:]])
    plan = floorplan_making.plan(openings=openings)
    surfaces = drawn_surfaces.list_surfaces(plan, 1.0, planar=False)
    length_m = np.hypot(*(surfaces.ends_m[:, 1] - surfaces.ends_m[:, 0]).T)
    assert length_m.min() > 0.01
    assert judged((4.0, 2.5, 1.0), plan=plan)[0] == ["explained"]


def test_low_walls_end_at_their_top():
    walls = floorplan_making.walls()
    walls["top_m"] = np.where(walls["wall"] == 5, 1.2, np.nan)
    openings = floorplan_making.openings([])
    plan = floorplan_making.plan(walls=walls, openings=openings)
    # 1.0 m and, at the wall, 1.6 m high: the second goes over
    assert judged((6.0, 1.5, 1.0), (7.1, 1.5, 2.5), plan=plan)[0] == ["passed", "explained"]


def test_an_opening_in_no_wall_cuts_no_face_in_no_wall():
    pane = ((2.2, 9.0, 2.8, 9.0), -1, "glass", np.nan, np.nan, 0, -1)
    plan = floorplan_making.plan(openings=floorplan_making.openings([pane]))
    elements = drawn_surfaces.list_surfaces(plan, 1.0, planar=False).elements
    loose = (elements["kind"] == "face") & (elements["number"] == 8)
    assert (elements["x0_m"][loose].tolist(), elements["x1_m"][loose].tolist()) == ([2.0], [3.0])
