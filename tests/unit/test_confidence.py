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
MAX_SIGMA_M = 0.05


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


def rate(plan, *rows, model=COEFFICIENTS):
    return confidence.rate_elements(plan, validation(*rows), MAX_SIGMA_M, model)


def rated(table, **columns):
    found = rate(PLAN, *columns.get("rows", ()))
    of_table = found["table"] == table
    return {name: values[of_table] for name, values in found.items()}


def changed(**values):
    """The coefficients in space, some of them others."""
    return COEFFICIENTS | {"space": COEFFICIENTS["space"] | values}


def constant(odds):
    """Models of all tables that say the same of any element."""
    features = {"walls": "thing", "faces": "thing", "openings": "wide", "rooms": "walled"}
    return {
        table: {"intercept": odds, "features": {name: {"mean": 0.0, "weight": 0.0}}}
        for table, name in features.items()
    }


def weighted(table, **weights):
    """The coefficients, but for a table that these few features alone decide."""
    features = {name: {"mean": 1.0, "weight": weight} for name, weight in weights.items()}
    return changed(**{table: {"intercept": 5.0, "features": features}}, level=0.5)


def test_the_worst_span_tells_of_a_face_that_is_right_elsewhere():
    rows = [("face", 0, 0, 98, 98), ("face", 0, 1, 8, 0), ("face", 1, 0, 8, 4)]
    faces = confidence.describe_elements(PLAN, validation(*rows))["faces"]
    np.testing.assert_allclose(faces["worst_span"][:3], [np.log(1 / 9), 0, 0])


def test_rays_tell_of_a_wall_what_they_tell_of_its_faces():
    """Of wall 0 one face agrees at 99 to 9; the other, as long, is one that no ray tells of."""
    rows = [("face", 0, 0, 98, 98), ("face", 0, 1, 8, 0)]
    walls = confidence.describe_elements(PLAN, validation(*rows))["walls"]
    faces = PARTS["faces"]
    length_m = np.hypot(faces["x1_m"] - faces["x0_m"], faces["y1_m"] - faces["y0_m"])
    own = faces["wall"] == 0
    expected = np.log(99 / 9) * length_m[0] / length_m[own].sum()
    np.testing.assert_allclose(walls["agreement"][0], expected)


def test_the_model_of_the_plan_tells_of_walls_their_faces_and_openings():
    p_wall = np.linspace(0.5, 0.9, len(PARTS["walls"]["wall"]))
    walls = PARTS["walls"] | {"p_wall": p_wall, "p_solid": p_wall[::-1]}
    plan = floorplan.make_floorplan(PARTS | {"walls": walls}, 0.0, 2.5)
    found = confidence.describe_elements(plan, validation())
    odds = np.log(p_wall / (1 - p_wall))
    np.testing.assert_allclose(found["walls"]["thing"], odds)
    np.testing.assert_allclose(found["walls"]["line"], odds[::-1])
    host = PARTS["faces"]["wall"]
    np.testing.assert_allclose(found["faces"]["thing"][host >= 0], odds[host[host >= 0]])
    assert np.isnan(found["faces"]["thing"][host < 0]).all()
    hosted = plan.hosts >= 0
    np.testing.assert_allclose(found["openings"]["host"][hosted], odds[plan.hosts[hosted]])


def test_a_probability_is_the_logistic_of_what_its_features_add():
    model = {
        "intercept": 1.0,
        "features": {"scans": {"mean": 2.0, "weight": 3.0}, "length": {"mean": 0, "weight": -1}},
    }
    features = {"scans": np.array([2.0, 1.0, np.nan]), "length": np.array([1.0, 0.0, 0.0])}
    p_true, added = confidence.weigh_features(features, model)
    # what is not known adds nothing
    np.testing.assert_allclose(added, [[0, -1], [-3, 0], [0, 0]])
    np.testing.assert_allclose(p_true, 1 / (1 + np.exp([0, 2, -1])))


def test_every_element_has_a_row_and_only_doubtful_ones_a_doubt():
    for table, number in floorplan.NUMBERS.items():
        found = rated(table)
        assert found["number"].tolist() == PARTS[table][number].tolist()
        assert ((found["p_true"] >= 0) & (found["p_true"] <= 1)).all()
        is_doubted = found["doubt"] != ""
        assert is_doubted.tolist() == (found["about"] != "").tolist()
        assert is_doubted[found["verify"]].all()
        assert set(found["about"][is_doubted & ~found["verify"]]) <= {"end", "width"}


def test_rays_of_other_scans_that_pass_through_a_face_make_it_less_likely():
    good = rated("faces", rows=[("face", 0, 0, 100, 100)])["p_true"][0]
    bad = rated("faces", rows=[("face", 0, 0, 100, 10)])["p_true"][0]
    assert bad < good


def test_a_gap_that_is_not_known_is_always_to_be_verified():
    openings = PARTS["openings"]
    kinds = openings["type"].copy()
    kinds[0] = "gap"
    plan = floorplan.make_floorplan(PARTS | {"openings": openings | {"type": kinds}}, 0.0, 2.5)
    found = rate(plan)
    row = np.flatnonzero(found["table"] == "openings")[0]
    assert (found["verify"][row], found["doubt"][row]) == (True, "not known what it is")


def test_a_doubt_is_of_size_where_evidence_as_usual_leaves_it():
    """Far from any wall both rooms are doubted; with walls around the closet still would be."""
    areas = [shapely.box(100, 0, 104, 4), shapely.box(104, 0, 105, 1)]
    parts = PARTS | {"rooms": floorplan_making.rooms(areas)}
    plan = floorplan.make_floorplan(parts, 0.0, 2.5)
    found = rate(plan, model=weighted("rooms", faced=20.0, broad=20.0))
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
    found = rate(plan, model=weighted("openings", wall=9.0))
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
    np.testing.assert_array_equal(ways["leads"], np.arange(n) % 2)
    np.testing.assert_array_equal(panes["leads"], 1 - np.arange(n) % 2)


@pytest.mark.parametrize(("kind", "usual_m"), [("door", 0.75), ("window", 1.0)])
def test_an_opening_is_narrow_below_the_usual_width_of_its_kind_and_never_wide(kind, usual_m):
    n = len(PARTS["openings"]["type"])
    width_m = np.resize([usual_m / 2, usual_m, 9.0], n)
    found = described_openings(type=np.full(n, kind), width_m=width_m)
    np.testing.assert_allclose(found["wide"], np.resize([-np.log(2), 0, 0], n), atol=1e-12)


def test_of_a_passage_in_no_wall_neither_wall_nor_rays_are_asked():
    n = len(PARTS["openings"]["type"])
    nowhere = {"wall": np.full(n, -1, np.int32), "n_rays": np.full(n, 5)}
    for kind, expected in (("passage", np.nan), ("glass", 0.0)):
        found = described_openings(type=np.full(n, kind), **nowhere)
        for name in ("host", "wall", "rays"):
            np.testing.assert_array_equal(found[name], np.full(n, expected))


@pytest.mark.parametrize("survey", ["space", "plane"])
def test_the_coefficients_are_of_features_that_there_are(survey):
    models = COEFFICIENTS[survey]
    found = confidence.describe_elements(PLAN, validation())
    for table in floorplan.NUMBERS:
        assert set(models[table]["features"]) <= set(found[table]) <= set(confidence.REASONS)
    assert 0 < models["level"] < models["most"] < 1


def test_a_survey_of_one_height_is_rated_by_the_model_of_the_plane():
    """The same features as in space, at odds of one to one there and three to one in the plane."""
    one_height = {name: np.ones(len(PARTS["walls"]["wall"])) for name in ("z_min_m", "z_max_m")}
    parts = PARTS | {"walls": PARTS["walls"] | one_height}
    models = {
        name: {"level": 0.0, "most": 1.0} | constant(odds)
        for name, odds in (("space", 0.0), ("plane", np.log(3)))
    }
    for floor_z_m, plan_parts, p_true in ((0.0, PARTS, 0.5), (np.nan, PARTS, 0.5),
                                          (np.nan, parts, 0.75)):  # fmt: skip
        plan = floorplan.make_floorplan(plan_parts, floor_z_m, np.nan)
        found = rate(plan, model=models)
        walls = found["table"] == "walls"
        np.testing.assert_allclose(found["p_true"][walls], p_true)


def test_no_element_is_surer_than_the_surest_were_right():
    found = rate(PLAN, model=changed(**constant(9.0), most=0.9))
    np.testing.assert_allclose(found["p_true"], 0.9)


def test_a_wall_whose_end_is_uncertain_is_not_to_be_verified_itself():
    """Twice 0.21 m, to the tenth above; an end at the limit itself is sure enough."""
    n = len(PARTS["walls"]["wall"])
    sigma_m = np.full(n, MAX_SIGMA_M)
    sigma_m[1] = 0.21
    walls = PARTS["walls"] | {"sigma_end1_m": sigma_m, "verify": np.zeros(n, bool)}
    plan = floorplan.make_floorplan(PARTS | {"walls": walls}, 0.0, 2.5)
    found = rate(plan, model=changed(level=0.0))
    of_walls = found["table"] == "walls"
    assert found["about"][of_walls].tolist() == [confidence.END * (row == 1) for row in range(n)]
    assert "0.5 m" in found["doubt"][of_walls][1]
    assert not found["verify"][of_walls].any()


def test_an_opening_one_of_whose_jambs_was_not_seen_has_no_sure_width():
    faces = PARTS["faces"] | {"state": np.full(len(PARTS["faces"]["face"]), "inferred", object)}
    for table, expected in ((PARTS["faces"], {""}), (faces, {confidence.WIDTH})):
        plan = floorplan.make_floorplan(PARTS | {"faces": table}, 0.0, 2.5)
        found = rate(plan, model=changed(level=0.0))
        of_openings = found["table"] == "openings"
        assert set(found["about"][of_openings]) == expected
        assert not found["verify"][of_openings].any()


@pytest.mark.parametrize(("feature", "about"), [("thing", "kind"), ("agreement", "existence")])
def test_what_speaks_most_against_an_element_says_what_of_it_is_doubtful(feature, about):
    model = {"intercept": -9.0, "features": {feature: {"mean": 9.0, "weight": 1.0}}}
    found = rate(PLAN, model=changed(walls=model))
    of_walls = found["table"] == "walls"
    assert set(found["about"][of_walls]) == {about}
    assert set(found["doubt"][of_walls]) == {confidence.REASONS[feature]}


@pytest.mark.parametrize("floor_z_m", [np.nan, 0.0])
def test_where_no_ray_was_recorded_nothing_is_likely_or_not(floor_z_m):
    """What was learned with rays says nothing then; weak walls and unknown gaps stay doubted."""
    kinds = np.full(len(PARTS["openings"]["type"]), "glass", object)
    parts = PARTS | {"openings": PARTS["openings"] | {"type": kinds}}
    doubted = doubts.Doubts(rayless=("a cloud alone",))
    plan = floorplan.make_floorplan(parts, floor_z_m, np.nan, doubted=doubted)
    found = rate(plan)
    assert np.isnan(found["p_true"]).all()
    walls, openings = (found["table"] == table for table in ("walls", "openings"))
    assert (found["verify"][walls] == PARTS["walls"]["verify"]).all()
    assert found["verify"][openings].all()


def test_what_a_person_corrected_is_neither_rated_nor_to_be_verified():
    by_hand = np.where(PARTS["openings"]["opening"] == 1, "changed by hand", "").astype(object)
    openings = PARTS["openings"] | {"corrected": by_hand}
    openings["type"] = np.full(len(by_hand), "gap", object)
    plan = floorplan.make_floorplan(PARTS | {"openings": openings}, 0.0, 2.5)
    found = rate(plan)
    rows = found["table"] == "openings"
    np.testing.assert_array_equal(found["verify"][rows], by_hand == "")
    np.testing.assert_array_equal(np.isnan(found["p_true"][rows]), by_hand != "")


def test_a_room_whose_outline_is_not_closed_is_to_be_verified_unless_somebody_looked():
    rooms = {**PARTS["rooms"], "closed": np.zeros(len(PARTS["rooms"]["room"]), bool)}
    sure = changed(level=0.0)
    open_ = (True, confidence.NOT_CLOSED)
    for corrected, expected in (
        ("", open_),
        ("changed by hand", open_),  # who names a room says nothing of its sides
        ("checked by hand, A. Bee", (False, "")),
    ):
        rooms["corrected"] = np.full(len(rooms["room"]), corrected, object)
        plan = floorplan.make_floorplan(PARTS | {"rooms": rooms}, 0.0, 2.5)
        found = rate(plan, model=sure)
        rows = np.flatnonzero(found["table"] == "rooms")
        assert [(found["verify"][row], found["doubt"][row]) for row in rows] == [expected] * len(
            rows
        )


def test_a_room_is_to_be_verified_where_most_of_its_walls_are():
    """The second room is 3 m square: its wall in the east counts for a fourth, with those in the
    south and north, which the first room shares, for three fourths.
    """
    sure = changed(level=0.0)
    for doubtful, expected in (([1], ["", ""]), ([0, 1, 2], ["", confidence.OF_DOUBTFUL_WALLS])):
        walls = PARTS["walls"] | {"verify": np.isin(PARTS["walls"]["wall"], doubtful)}
        plan = floorplan.make_floorplan(PARTS | {"walls": walls}, 0.0, 2.5)
        found = rate(plan, model=sure)
        is_room = found["table"] == "rooms"
        assert found["doubt"][is_room].tolist() == expected
        assert found["verify"][is_room].tolist() == [bool(doubt) for doubt in expected]
