"""A plan of two rooms is tested by the scans that did not make it."""

from pathlib import Path

import numpy as np
import pytest

from assemble_plan import assemble_plan
from helpers import house_making
from scanplan.plan import floorplan, floorplan_files, planning
from scanplan.project import code_files
from scanplan.report import validation_figure
from scanplan.store import schemas, tables
from scanplan.validation import prediction
from validate_plan import validate_plan

ROOT = Path(__file__).resolve().parents[2]
SETTINGS = {
    "max_scans": 100,
    "max_rays": 20_000,
    "span_m": 1.0,
    "place_m": 1.0,
    "registration_sigma_m": 0.02,
    "max_sigma_m": 0.05,
    "seed": 1,
}
PARTS = ("faces", "walls", "openings", "rooms", "free")


def make_plan(folder, sensors=house_making.SENSORS):
    folder.mkdir()
    inputs = house_making.write(folder, house_making.segments(), sensors)
    paths = {name: folder / f"plan_{name}.parquet" for name in planning.TABLES}
    assemble_plan(*inputs, paths, settings=house_making.PLAN, n_scans=None)
    further = dict(zip(("selection", "scans", "registration"), inputs[1:], strict=True))
    return {name: paths[name] for name in PARTS} | further


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    return make_plan(tmp_path_factory.mktemp("house") / "made")


def validated(house, folder, *, settings=SETTINGS, n_scans=2):
    folder.mkdir(exist_ok=True)
    outputs = {name: folder / f"{name}.parquet" for name in ("elements", "rays", "confidence")}
    validate_plan(house, outputs, settings=settings, n_scans=n_scans)
    elements = tables.read_table(outputs["elements"], schemas.VALIDATION)
    rays = tables.read_table(outputs["rays"], schemas.VALIDATION_RAYS, allow_empty=True)
    absent = tables.read_note(outputs["elements"], schemas.VALIDATION, "absent")
    return elements, rays, absent, outputs


def test_a_right_plan_predicts_other_scans(house, tmp_path):
    elements, rays, absent, _ = validated(house, tmp_path)
    assert elements["kind"][-2:].tolist() == ["plan_length", "plan_rays"] and absent == ""
    # room A's second scan and room B's, 4 m by 4 m each and empty
    assert elements["share"][-1] > 0.98
    assert elements["share"][-2] > 0.98
    assert elements["share_low"][-1] <= elements["share"][-1] <= elements["share_high"][-1]
    assert set(rays["scan_id"].tolist()) == {1, 3}
    assert len(rays["ray"]) <= SETTINGS["max_rays"]
    assert elements["n_rays"][-1] == (rays["outcome"] != "outside").sum()
    assert np.nanmin(elements["share"][elements["kind"] == "face"]) > 0.9
    figure = validation_figure.draw_validation_figure(elements, rays, "a title")
    assert figure.get_suptitle() == "a title"


def test_the_seed_alone_draws(house, tmp_path):
    few = SETTINGS | {"max_rays": 500}
    _, once, _, _ = validated(house, tmp_path / "once", settings=few)
    _, again, _, _ = validated(house, tmp_path / "again", settings=few)
    _, other, _, _ = validated(house, tmp_path / "other", settings=few | {"seed": 2})
    np.testing.assert_array_equal(once["x_m"], again["x_m"])
    assert len(once["ray"]) == 500 and not np.array_equal(once["x_m"], other["x_m"])


def test_without_a_scan_left_out_the_share_is_absent(house, tmp_path):
    elements, rays, absent, _ = validated(house, tmp_path, n_scans=None)
    assert absent == "all scans make the plan, none is left to test it"
    assert elements["n_rays"][-1] == len(rays["ray"]) == 0
    assert np.isnan(elements["share"]).all() and np.isnan(elements["share_high"]).all()
    assert validation_figure.draw_validation_figure(elements, rays, absent).axes


def test_each_absence_has_its_reason():
    columns = {"share": np.array([np.nan]), "n_rays": np.array([0])}
    unknown = prediction.Validation(columns, {}, 0.04)
    reasons = [prediction.explain_absence(unknown, *n) for n in ((1, 0), (5, 0), (5, 2))]
    assert reasons == [
        "the only registered scan makes the plan, none is left to test it",
        "all scans make the plan, none is left to test it",
        "no ray of the scans left out ends between floor and ceiling",
    ]


def test_from_one_place_the_share_is_absent(tmp_path):
    # the two scans left out are taken 0.1 m apart
    sensors = [(2, 2, 0.9), (1, 3, 0.9), (6, 2.2, 0.9), (1.1, 3, 0.9)]
    elements, _, absent, _ = validated(make_plan(tmp_path / "made", sensors), tmp_path)
    assert absent == "all scans left out were taken at one place"
    assert elements["n_rays"][-1] > 1000 and np.isnan(elements["share"]).all()


def test_every_element_of_a_plan_is_rated(house, tmp_path):
    _, _, _, outputs = validated(house, tmp_path)
    plan = floorplan_files.read_floorplan(house | {"confidence": outputs["confidence"]})
    for table in floorplan.NUMBERS:
        columns = getattr(plan, table)
        # the toy's scans see neither floor nor ceiling
        assert ((columns["p_true"] >= 0) & (columns["p_true"] < 1)).all()
        assert ((columns["doubt"] != "") == (columns["about"] != "")).all()
        assert (columns["doubt"][columns["verify"]] != "").all()
    assert np.isnan(floorplan_files.read_floorplan(house).walls.get("p_true", np.nan))


def test_no_truth_is_read():
    """Neither is it an input of the rule, nor does the stage import what reads truths."""
    rules = (ROOT / "workflow/rules/plan.smk").read_text()
    rule = rules.partition("rule validate_plan:")[2].partition("\nrule ")[0]
    assert "rooms=" in rule and "truth" not in rule and "evaluation" not in rule
    helpers = code_files.list_helpers(ROOT / "scripts/validate_plan.py")
    folders = [path.relative_to(ROOT).parts for path in helpers]
    assert len(folders) > 5 and not any("lab" in parts for parts in folders)


def share_of(plan, rays):
    found = prediction.validate_by_rays(plan, rays, prediction.ValidationSettings(**SETTINGS))
    return found.elements["share"][-1], found.elements


def place(elements, kind, at_m):
    """Return the element of a kind nearest to a place, as a row."""
    middle_m = floorplan.centrelines_m(elements).mean(axis=1)
    apart_m = np.hypot(*(middle_m - at_m).T)
    apart_m[elements["kind"] != kind] = np.inf
    return {name: values[np.nanargmin(apart_m)] for name, values in elements.items()}


@pytest.fixture(scope="module")
def tested(house):
    """The plan, and rays from sixteen other places."""
    plan = floorplan_files.read_floorplan(house)
    sensors = [(x, y, 0.9) for x in (1, 3, 5, 7.2) for y in (0.6, 1.4, 2.6, 3.4)]
    return plan, house_making.looked(sensors=sensors, columns=300)


def with_faces(plan, faces):
    parts = {name: getattr(plan, name) for name in ("walls", "openings", "rooms", "free")}
    return floorplan.FloorPlan(name="", faces=faces, floor_z_m=plan.floor_z_m, **parts)


def test_a_removed_wall_of_a_metre_is_seen_in_its_outline(tested):
    plan, rays = tested
    before, _ = share_of(plan, rays)
    south = np.flatnonzero((np.abs(plan.faces["y0_m"]) < 0.1) & (np.abs(plan.faces["y1_m"]) < 0.1))
    row = south[np.argmin(plan.faces["x0_m"][south])]
    twice = {name: np.append(values, values[row]) for name, values in plan.faces.items()}
    ends = np.sort([twice["x0_m"][row], twice["x1_m"][row]])
    twice["x0_m"][row], twice["x1_m"][row] = ends[0], 1.5
    twice["x0_m"][-1], twice["x1_m"][-1] = 2.5, ends[1]
    twice["face"] = np.arange(len(twice["face"]), dtype=np.int32)
    after, elements = share_of(with_faces(plan, twice), rays)
    own = place(elements, "outline", (2.0, 0.0))
    assert after < before - 0.01
    assert own["n_rays"] > 100 and own["share_high"] < 0.5


def test_an_invented_wall_of_a_metre_is_passed_through(tested):
    plan, rays = tested
    before, _ = share_of(plan, rays)
    more = {name: np.append(values, values[0]) for name, values in plan.faces.items()}
    for name, value in {"x0_m": 2.0, "y0_m": 2.0, "x1_m": 3.0, "y1_m": 2.0, "wall": -1}.items():
        more[name][-1] = value
    more["face"] = np.arange(len(more["face"]), dtype=np.int32)
    after, elements = share_of(with_faces(plan, more), rays)
    own = place(elements, "face", (2.5, 2.0))
    assert after < before - 0.01
    assert own["n_rays"] > 100 and own["share_high"] < 0.5
