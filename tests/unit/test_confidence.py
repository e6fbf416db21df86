"""Probabilities of a plan's elements, by models whose sums are known on paper."""

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from scanplan.plan import floorplan
from scanplan.store import doubts, schemas
from scanplan.validation import confidence
from scanplan.validation.confidence_coefficients import COEFFICIENTS

PARTS = {
    name: getattr(floorplan_making, name)()
    for name in ("faces", "walls", "openings", "rooms", "free")
}
PLAN = floorplan.make_floorplan(PARTS, 0.0, 2.5)


def validation(*rows):
    """Rows are kind, number, span, rays, explained."""
    rows = [*rows, ("plan_rays", 0, 0, 1, 1)]
    columns = {name: np.zeros(len(rows)) for name in schemas.VALIDATION.columns}
    kinds, numbers, spans, rays, good = zip(*rows, strict=True)
    return columns | {
        "kind": np.array(kinds, object),
        "number": np.array(numbers),
        "span": np.array(spans),
        "n_rays": np.array(rays),
        "n_explained": np.array(good),
    }


def rated(table, **columns):
    found = confidence.rate_elements(PLAN, validation(*columns.get("rows", ())))
    of_table = found["table"] == table
    return {name: values[of_table] for name, values in found.items()}


def weighted(table, **weights):
    """The coefficients, but for a table that these few features alone decide."""
    features = {
        name: known | {"weight": weights.get(name, 0.0)}
        for name, known in COEFFICIENTS[table]["features"].items()
    }
    return COEFFICIENTS | {table: {"intercept": 5.0, "features": features}}


def test_the_worst_span_tells_of_a_face_that_is_right_elsewhere():
    rows = [("face", 0, 0, 98, 98), ("face", 0, 1, 8, 0), ("face", 1, 0, 8, 4)]
    faces = confidence.describe_elements(PLAN, validation(*rows))["faces"]
    np.testing.assert_allclose(faces["agreement"][:3], [np.log(99 / 9), 0, 0])
    np.testing.assert_allclose(faces["worst_span"][:3], [np.log(1 / 9), 0, 0])


def test_rays_that_end_at_two_faces_speak_for_none_of_them():
    rows = [(0, 0, 4, 0, 0), (0, 0.1, 4, 0.1, 0), (0, 3, 4, 3, 0)]
    faces = floorplan_making.faces(rows)
    plan = floorplan.make_floorplan(PARTS | {"faces": faces}, 0.0, 2.5)
    rows = [("face", number, 0, 98, 98) for number in faces["face"].tolist()]
    found = confidence.describe_elements(plan, validation(*rows))["faces"]
    np.testing.assert_allclose(found["agreement"], [0, 0, np.log(99)])
    rows = [("face", number, 0, 98, 0) for number in faces["face"].tolist()]
    found = confidence.describe_elements(plan, validation(*rows))["faces"]
    np.testing.assert_allclose(found["agreement"], -np.log(99))


def test_a_probability_is_the_logistic_of_what_its_features_add():
    model = {
        "intercept": 1.0,
        "features": {"scans": {"mean": 2.0, "weight": 3.0}, "length": {"mean": 0, "weight": -1}},
    }
    features = {"scans": np.array([2.0, 1.0]), "length": np.array([1.0, 0.0])}
    p_true, added = confidence.weigh_features(features, model)
    np.testing.assert_allclose(added, [[0, -1], [-3, 0]])
    np.testing.assert_allclose(p_true, 1 / (1 + np.exp([0, 2])))


def test_every_element_has_a_row_and_only_doubtful_ones_a_doubt():
    for table, number in floorplan.NUMBERS.items():
        found = rated(table)
        assert found["number"].tolist() == PARTS[table][number].tolist()
        assert ((found["p_true"] >= 0) & (found["p_true"] <= 1)).all()
        assert [bool(words) for words in found["doubt"]] == found["verify"].tolist()


def test_rays_of_other_scans_that_pass_through_a_face_make_it_less_likely():
    good = rated("faces", rows=[("face", 0, 0, 100, 100)])["p_true"][0]
    bad = rated("faces", rows=[("face", 0, 0, 100, 10)])["p_true"][0]
    assert bad < good


def test_a_gap_that_is_not_known_is_always_to_be_verified():
    openings = PARTS["openings"]
    kinds = openings["type"].copy()
    kinds[0] = "gap"
    plan = floorplan.make_floorplan(PARTS | {"openings": openings | {"type": kinds}}, 0.0, 2.5)
    found = confidence.rate_elements(plan, validation())
    row = np.flatnonzero(found["table"] == "openings")[0]
    assert (found["verify"][row], found["doubt"][row]) == (True, "not known what it is")


def test_a_doubt_is_of_size_where_evidence_as_usual_leaves_it():
    """Far from any wall both rooms are doubted; with walls around the closet still would be."""
    areas = [shapely.box(100, 0, 104, 4), shapely.box(104, 0, 105, 1)]
    parts = PARTS | {"rooms": floorplan_making.rooms(areas)}
    plan = floorplan.make_floorplan(parts, 0.0, 2.5)
    found = confidence.rate_elements(plan, validation(), weighted("rooms", faced=20.0, broad=20.0))
    rooms = found["table"] == "rooms"
    assert found["verify"][rooms].tolist() == [True, True]
    assert found["needs_person"][rooms].tolist() == [False, True]


@pytest.mark.parametrize(("in_wall", "needs_person"), [(True, False), (False, True)])
def test_a_pane_in_no_wall_needs_a_person(in_wall, needs_person):
    """A wall that rays contradict may yet be seen to stand, none may not."""
    openings = PARTS["openings"]
    n = len(openings["opening"])
    unknown = {"sill_m": np.full(n, np.nan), "lintel_m": np.full(n, np.nan)}
    panes = openings | unknown | {"type": np.full(n, "glass", object)}
    if not in_wall:
        panes["wall"] = np.full(n, -1)
    plan = floorplan.make_floorplan(PARTS | {"openings": panes}, 0.0, 2.5)
    found = confidence.rate_elements(plan, validation(), weighted("openings", wall=9.0))
    rows = np.flatnonzero((found["table"] == "openings") & found["verify"])
    assert len(rows) > 0
    assert (found["needs_person"][rows] == needs_person).all()


def described_openings(**columns):
    openings = PARTS["openings"] | columns
    plan = floorplan.make_floorplan(PARTS | {"openings": openings}, 0.0, 2.5)
    return confidence.describe_elements(plan, validation())["openings"]


def test_ways_lead_between_rooms_and_windows_out_of_them():
    n = len(PARTS["openings"]["type"])
    room_a, room_b = np.zeros(n, int), np.arange(n) % 2 * 2 - 1
    ways = described_openings(type=np.full(n, "door"), room_a=room_a, room_b=room_b)
    panes = described_openings(type=np.full(n, "glass"), room_a=room_a, room_b=room_b)
    np.testing.assert_array_equal(ways["usual"], np.arange(n) % 2)
    np.testing.assert_array_equal(panes["usual"], 1 - np.arange(n) % 2)


def test_a_way_that_was_driven_through_may_lead_anywhere():
    n = len(PARTS["openings"]["type"])
    out = {"room_a": np.zeros(n, int), "room_b": np.full(n, -1), "type": np.full(n, "door")}
    sure = np.where(np.arange(n) == 0, 0.99, 0.9)
    ways = described_openings(**out, p_kind=sure)
    np.testing.assert_array_equal(ways["usual"], np.arange(n) == 0)
    panes = described_openings(**out | {"room_b": np.ones(n, int), "type": np.full(n, "glass")})
    assert not panes["usual"].any()


def test_floor_seen_beyond_a_way_out_speaks_for_it():
    n = len(PARTS["openings"]["type"])
    out = {"type": np.full(n, "door"), "room_a": np.zeros(n, int), "room_b": np.full(n, -1)}
    # the only known room lies elsewhere, so that both sides of each are beyond
    parts = PARTS | {
        "openings": PARTS["openings"] | out,
        "rooms": floorplan_making.rooms([shapely.box(200, 200, 204, 204)]),
    }
    nothing = floorplan_making.free([shapely.box(200, 200, 204, 204)])
    around = floorplan_making.free([shapely.box(-50, -50, 50, 50)])
    shares = []
    for floor in (nothing, around):
        plan = floorplan.make_floorplan(parts | {"free": floor}, 0.0, 2.5)
        found = confidence.describe_elements(plan, validation())["openings"]
        shares.append(found["usual"])
        np.testing.assert_allclose(found["kind"], np.log(19))
    np.testing.assert_allclose(shares[0], 0)
    np.testing.assert_allclose(shares[1], 1)


def test_a_kind_that_was_weighed_is_no_surer_than_one_that_need_not_be():
    n = len(PARTS["openings"]["type"])
    weighed = np.array([0.8, 0.9999, np.nan, *[0.5] * (n - 3)])
    kinds = described_openings(p_kind=weighed, type=np.full(n, "window"))["kind"]
    np.testing.assert_allclose(kinds[:3], np.log([4, 19, 19]))


@pytest.mark.parametrize("table", list(floorplan.NUMBERS))
def test_the_coefficients_are_of_features_that_there_are(table):
    features = confidence.describe_elements(PLAN, validation())[table]
    assert list(COEFFICIENTS[table]["features"]) == list(features)
    assert set(features) <= set(confidence.REASONS)
    assert 0 < COEFFICIENTS["level"] < 1


@pytest.mark.parametrize(("floor_z_m", "rayless"), [(np.nan, ()), (0.0, ("a cloud alone",))])
def test_where_no_height_or_no_ray_is_seen_nothing_is_likely_or_not(floor_z_m, rayless):
    """What was learned with both says nothing then; weak walls and unknown gaps stay doubted."""
    doubted = doubts.Doubts(rayless=rayless)
    plan = floorplan.make_floorplan(PARTS, floor_z_m, np.nan, doubted=doubted)
    found = confidence.rate_elements(plan, validation())
    walls = found["table"] == "walls"
    assert np.isnan(found["p_true"][walls]).all()
    assert (found["verify"][walls] == PARTS["walls"]["verify"]).all()
    assert not found["verify"][found["table"] == "rooms"].any()


@pytest.mark.parametrize(
    ("floor_z_m", "rayless", "is_unknown"),
    [(0.0, (), False), (np.nan, (), True), (0.0, ("a cloud alone",), True)],
)
def test_glass_in_one_plane_or_without_rays_may_be_a_way_out(floor_z_m, rayless, is_unknown):
    kinds = np.full(len(PARTS["openings"]["type"]), "glass", object)
    parts = PARTS | {"openings": PARTS["openings"] | {"type": kinds}}
    doubted = doubts.Doubts(rayless=rayless)
    plan = floorplan.make_floorplan(parts, floor_z_m, 2.5, doubted=doubted)
    found = confidence.rate_elements(plan, validation(), COEFFICIENTS | {"level": 0.0})
    of_openings = found["table"] == "openings"
    assert (found["verify"][of_openings] == is_unknown).all()


def test_what_a_person_corrected_is_neither_rated_nor_to_be_verified():
    by_hand = np.where(PARTS["openings"]["opening"] == 1, "changed by hand", "").astype(object)
    openings = PARTS["openings"] | {"corrected": by_hand}
    openings["type"] = np.full(len(by_hand), "gap", object)
    plan = floorplan.make_floorplan(PARTS | {"openings": openings}, 0.0, 2.5)
    found = confidence.rate_elements(plan, validation())
    rows = found["table"] == "openings"
    np.testing.assert_array_equal(found["verify"][rows], by_hand == "")
    np.testing.assert_array_equal(np.isnan(found["p_true"][rows]), by_hand != "")


@pytest.mark.parametrize("floor_z_m", [0.0, np.nan], ids=["rated", "no heights"])
def test_a_room_whose_outline_is_not_closed_is_to_be_verified_unless_it_was_corrected(floor_z_m):
    rooms = {**PARTS["rooms"], "closed": np.zeros(len(PARTS["rooms"]["room"]), bool)}
    sure = {"level": 0.0}
    for corrected, expected in (("", (True, confidence.NOT_CLOSED)), ("name", (False, ""))):
        rooms["corrected"] = np.full(len(rooms["room"]), corrected, object)
        plan = floorplan.make_floorplan(PARTS | {"rooms": rooms}, floor_z_m, 2.5)
        found = confidence.rate_elements(plan, validation(), COEFFICIENTS | sure)
        rows = np.flatnonzero(found["table"] == "rooms")
        assert [(found["verify"][row], found["doubt"][row]) for row in rows] == [expected] * len(
            rows
        )


@pytest.mark.parametrize("floor_z_m", [0.0, np.nan], ids=["rated", "no heights"])
def test_a_room_is_to_be_verified_where_most_of_its_walls_are(floor_z_m):
    """The second room is 3 m square: its wall in the east counts for a fourth, with those in the
    south and north, which the first room shares, for three fourths.
    """
    sure = COEFFICIENTS | {"level": 0.0}
    for doubtful, expected in (([1], ["", ""]), ([0, 1, 2], ["", confidence.OF_DOUBTFUL_WALLS])):
        walls = PARTS["walls"] | {"verify": np.isin(PARTS["walls"]["wall"], doubtful)}
        plan = floorplan.make_floorplan(PARTS | {"walls": walls}, floor_z_m, 2.5)
        found = confidence.rate_elements(plan, validation(), sure)
        is_room = found["table"] == "rooms"
        assert found["doubt"][is_room].tolist() == expected
        assert found["verify"][is_room].tolist() == [bool(doubt) for doubt in expected]
