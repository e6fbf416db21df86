"""Doubts go from table to table, and into summary and sheet."""

from types import SimpleNamespace

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from scanplan.registration import contradictions as of_registration
from scanplan.store import doubts, schemas, tables
from scanplan.validation import contradictions

ROW = {"t_ns": [1], "piece": [0], "time_scale": [1.0], "time_shift_s": [0.0]}
POSE = {name: [1.0] for name in (*schemas.XYZ, *schemas.QUAT)}


def test_what_a_table_is_told_it_hands_on(tmp_path):
    crossed = doubts.Finding("way through walls", 1.5, "walls are crossed", "doors", "look")
    found = doubts.Doubts().add(["half is lost"], [crossed]).add(["half is lost"], [crossed])
    path = tmp_path / "motion.parquet"
    tables.write_table(path, schemas.MOTION, ROW | POSE, notes=found.as_notes())
    assert doubts.read_doubts(path, schemas.MOTION) == found
    assert found.damage == ("half is lost",) and not found.rayless
    assert found.contradictions == ("walls are crossed: doors; look",)


def test_that_there_are_no_rays_is_handed_on(tmp_path):
    path = tmp_path / "motion.parquet"
    found = doubts.Doubts(rayless=("a map alone",)).join(doubts.Doubts(damage=("half is lost",)))
    tables.write_table(path, schemas.MOTION, ROW | POSE, notes=found.as_notes())
    assert doubts.read_doubts(path, schemas.MOTION) == found
    assert found.rayless == ("a map alone",) and found.damage == ("half is lost",)


def test_a_table_without_doubts_has_no_note(tmp_path):
    path = tmp_path / "motion.parquet"
    tables.write_table(path, schemas.MOTION, ROW | POSE, notes=doubts.NO_DOUBT.as_notes())
    assert not doubts.read_doubts(path, schemas.MOTION) and doubts.NO_DOUBT.as_notes() == {}


def verdicts(n_kept, n_rejected, n_empty=0):
    reasons = ["kept"] * n_kept + ["icp_diverged"] * n_rejected + ["too_few_points"] * n_empty
    return [SimpleNamespace(kept=reason == "kept", reason=reason) for reason in reasons]


@pytest.mark.parametrize(
    ("kept", "rejected", "empty", "is_doubted"),
    [(18, 3, 0, False), (16, 4, 0, True), (18, 3, 50, False), (0, 0, 5, False), (3, 1, 0, False)],
)
def test_scans_that_do_not_fit_are_doubted(kept, rejected, empty, is_doubted):
    found = of_registration.measure_misfit(verdicts(kept, rejected, empty))
    assert found.is_beyond == is_doubted
    assert found.more["n_kept"] == kept and found.more["n_asked"] == kept + rejected


@pytest.mark.parametrize(
    ("moved_m", "rejected", "is_doubted"), [(0.0, 2, True), (0.0, 0, False), (0.01, 2, False)]
)
def test_scans_that_do_not_fit_where_the_sensor_is_said_to_stand_are_doubted(
    moved_m, rejected, is_doubted
):
    priors = np.tile(np.eye(4), (6, 1, 1))
    priors[2, 0, 3] = moved_m
    priors[3] = np.nan
    found = of_registration.measure_standstill(priors, verdicts(6 - rejected, rejected))
    assert found.is_beyond == is_doubted and found.value == rejected * is_doubted
    assert not is_doubted or "input.pose_topic" in found.finding.cause


def rays_at(xy_m):
    xyz_m = np.column_stack([xy_m, np.ones(len(xy_m))])
    sensors_m, first = np.array([(2.0, 1.5, 1.0)]), np.array([0, len(xyz_m)])
    return SimpleNamespace(xyz_m=xyz_m, sensors_m=sensors_m, first=first, planar=True, scan_ids=[0])


def points_on(plan, share, n=100):
    """Points of which a share lies on the faces of a plan, and the others 50 m away."""
    line = shapely.linestrings(contradictions.centrelines_m(plan.faces)[0])
    on = shapely.get_coordinates(shapely.line_interpolate_point(line, np.linspace(0, 1, n), True))
    on[int(share * n) :] += 50
    return rays_at(on)


@pytest.mark.parametrize(("share", "is_doubted"), [(0.5, False), (0.1, True)])
def test_returns_beside_the_walls_are_doubted(share, is_doubted):
    plan = floorplan_making.plan()
    rays = points_on(plan, share)
    off, through = contradictions.measure_drawn_walls(plan, rays, np.zeros((1, 2)))
    assert off.is_beyond == is_doubted and not through.is_beyond
    assert off.more["near"] == pytest.approx(share, abs=0.02)


def test_what_lies_behind_a_pane_is_not_asked():
    """Half of the returns end at a front of glass across the room, a half far behind it."""
    pane = ((0.0, 2.5, 4.0, 2.5), -1, "glass", np.nan, np.nan, 0, 0)
    openings = floorplan_making.openings([pane])
    plan = floorplan_making.plan(openings=openings)
    x_m = np.linspace(1.0, 3.0, 50)
    ends_m = [np.column_stack([x_m, np.full(50, y_m)]) for y_m in (2.5, 40.0)]
    rays = rays_at(np.concatenate(ends_m))
    assert contradictions.measure_share_on_walls(plan, rays) == 1.0
    without = floorplan_making.plan(openings=floorplan_making.openings([]))
    assert contradictions.measure_share_on_walls(without, rays) == 0.0


def test_a_way_through_walls_is_doubted():
    plan = floorplan_making.plan()
    middle = contradictions.centrelines_m(plan.walls)[0].mean(axis=0)
    there_and_back = np.tile([middle - 0.2, middle + 0.2], (6, 1))
    share = contradictions.measure_share_through_walls(plan, there_and_back)
    beside = contradictions.measure_share_through_walls(plan, there_and_back + 1000)
    assert share == 1.0 and beside == 0.0


def test_a_line_between_scans_far_apart_is_no_way_that_was_driven():
    plan = floorplan_making.plan()
    middle = contradictions.centrelines_m(plan.walls)[0].mean(axis=0)
    far_apart = np.tile([middle - 0.9, middle + 0.9], (20, 1))
    assert contradictions.measure_share_through_walls(plan, far_apart) == 0.0


def test_of_few_steps_nothing_is_said():
    plan = floorplan_making.plan()
    middle = contradictions.centrelines_m(plan.walls)[0].mean(axis=0)
    few = np.tile([middle - 0.2, middle + 0.2], (5, 1))
    assert contradictions.measure_share_through_walls(plan, few) == 0.0
