"""Experiments beyond the thesis's, on inputs small enough for paper."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from scanplan.errors import StageError
from scanplan.lab.buildings import drawing_file, drawn_floor
from scanplan.stage import run_times
from thesis.beyond import (
    generated_floor,
    outliers,
    point_budgets,
    quality_times,
    registrability,
    room_counts,
)
from thesis.beyond.measurements import Measurement, mean_by_level
from thesis.beyond.shown import case_lines, connected_scans, equal_points, good_plans
from thesis.beyond.shown.experiments import EXPERIMENTS


def as_table(rows):
    return pd.DataFrame([Measurement(*row)._asdict() for row in rows]).assign(survey=0)


# --- equal bytes
def test_scans_are_affordable_as_long_as_their_points_fit():
    order, n_points = np.array([2, 0, 1]), np.array([10, 20, 30])
    assert point_budgets.affordable_scans(order, n_points, 40).tolist() == [2, 0]
    assert point_budgets.affordable_scans(order, n_points, 29).tolist() == []


def test_the_voxel_keeps_the_share_asked_for():
    # a line of 1000 points a centimetre apart: a tenth of them with voxels of 0.1 m
    cloud = np.column_stack([0.005 + 0.01 * np.arange(1000), np.zeros((1000, 2))])
    voxel_m = point_budgets.find_voxel([cloud], 0.1, planar=False)
    kept = point_budgets.thin_by_voxels(voxel_m, False, 0, cloud)
    assert voxel_m == pytest.approx(0.1, rel=0.03) and 97 <= len(kept) <= 101


def test_points_at_random_are_the_same_each_time_and_others_of_another_scan():
    cloud = np.arange(3000.0).reshape(1000, 3)
    first, again, other = (point_budgets.thin_at_random(0.3, 7, scan, cloud) for scan in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert len(first) != len(other) or (first != other).any()
    assert 240 < len(first) < 360


def test_a_wall_needs_points_in_proportion_but_three():
    settings = SimpleNamespace(min_points=30, min_points_planar=6)
    search = SimpleNamespace(settings=settings, change=lambda **changed: changed)
    assert point_budgets.lower_limits(search, 0.2) == {"min_points": 6, "min_points_planar": 3}


# --- time to quality
def test_plans_are_made_until_one_is_good():
    made = []

    def measure_plan(rows):
        made.append(len(rows))
        return min(1.0, len(rows) / 20), 0.5 * len(rows)

    truth = SimpleNamespace(registered=SimpleNamespace(scan_ids=np.arange(50)))
    survey = SimpleNamespace(truth=truth, measure_plan=measure_plan)
    orders = {"distance": (3.0, np.arange(50))}
    rows = quality_times.time_to_quality(survey, orders, [5, 10, 20, 40], recorded_s=2.0)
    table = as_table(row for of_order in rows for row in of_order)
    # the fourth is not needed; all scans are always measured
    assert made == [5, 10, 20, 50]
    seconds = table[table["quantity"] == quality_times.SECONDS].set_index(["case", "level"])[
        "value"
    ]
    assert seconds["distance", 20] == 2.0 + 3.0 + 10.0
    assert seconds[quality_times.ALL_SCANS, 50] == 2.0 + 25.0
    sentence = good_plans.conclude_quality_times(table)
    assert sentence.index("farthest next 15 s with 20 scans") < sentence.index("all scans 27 s")


def test_seconds_of_the_processor_are_read_by_name(tmp_path):
    file = tmp_path / "a.tsv"
    file.write_text("s\th:m:s\tcpu_time\n2.5\t0:00:02\t4.25\n")
    assert run_times.read_job_seconds(file) == 2.5
    assert run_times.read_job_seconds(file, "cpu_time") == 4.25
    with pytest.raises(StageError, match="no benchmark file"):
        run_times.read_job_seconds(file, "mean_load")


# --- scans per room
@pytest.mark.parametrize("n_rooms", [2, 5, 16, 33])
@pytest.mark.parametrize("seed", [1, 2])
def test_a_floor_has_as_many_rooms_as_are_asked_for(n_rooms, seed):
    plan = drawing_file.parse_drawing(generated_floor.draw_floor(n_rooms, seed), "floor.geojson")
    # the hallways are one room more: they open into one another
    assert len(drawn_floor.floor_rooms(plan)) == n_rooms + 1
    assert len(plan.openings) == n_rooms


def test_floors_are_the_same_by_their_seed_alone():
    first, again, other = (generated_floor.draw_floor(9, seed) for seed in (1, 1, 2))
    assert first == again != other


def test_the_first_scans_are_counted_that_find_a_share():
    # metres of four pieces of wall: 4, 3, 2, 1; the third scan finds nothing new
    found = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 0, 0], [0, 0, 1, 1]], bool)
    length_m, order = np.array([4.0, 3, 2, 1]), np.arange(4)
    counts = [room_counts.count_first(found, length_m, order, share=s) for s in (0.4, 0.7, 0.71)]
    assert counts == [1, 2, 4]


# --- outliers
CIRCLE = 4 * np.column_stack(
    [np.cos(np.arange(3600) * np.pi / 1800), np.sin(np.arange(3600) * np.pi / 1800), np.zeros(3600)]
)


@pytest.mark.parametrize("kind", outliers.KINDS)
def test_outliers_stay_on_their_rays_and_are_about_as_many_as_asked_for(kind):
    changed = outliers.KINDS[kind](CIRCLE, 0.3, np.random.default_rng(5))
    moved = np.abs(np.linalg.norm(changed, axis=1) - 4) > 1e-9
    np.testing.assert_allclose(np.cross(changed, CIRCLE), 0, atol=1e-9)
    assert 0.15 < moved.mean() < 0.45
    ranges_m = np.linalg.norm(changed[moved], axis=1)
    limits = {"stray returns": (0, 4), "glass": (4, 12), "people": (1, 2.5)}[kind]
    assert ranges_m.min() >= limits[0] - 1e-9 and ranges_m.max() <= limits[1] + 1e-9


def test_people_behind_a_wall_are_not_seen():
    near = CIRCLE / 8
    np.testing.assert_array_equal(outliers.put_people(near, 1.0, np.random.default_rng(1)), near)


def test_without_outliers_nothing_changes():
    for change in outliers.KINDS.values():
        np.testing.assert_array_equal(change(CIRCLE, 0.0, np.random.default_rng(1)), CIRCLE)


# --- registrability
def test_the_largest_part_is_that_which_most_pairs_connect():
    assert registrability.largest_part(5, [(0, 1), (1, 2), (3, 4)]) == 3 / 5
    assert registrability.largest_part(4, []) == 1 / 4


def test_a_survey_of_next_to_no_scans_is_said_to_show_nothing():
    """Of one that has fewer scans than the fewest to choose, only all scans are measured."""
    rows = [
        {"survey": 0, "level": 4.0, "case": "every_nth", "quantity": quantity, "value": 1.0}
        for quantity in (registrability.ALIGNED, registrability.PAIRS_ALIGNED)
    ]
    assert "enough" in connected_scans.conclude_registrability(pd.DataFrame(rows))


def test_pairs_are_judged_among_the_chosen_alone():
    asked = []

    def judge_pair(one, other):
        asked.append((one, other))
        return True, abs(one - other) == 1

    places_m = np.column_stack([np.arange(6.0), np.zeros(6)])
    rows = registrability.measure_registrability(
        SimpleNamespace(judge_pair=judge_pair), places_m, {"random": np.array([0, 1, 4, 5])}, [4, 9]
    )
    values = {row.quantity: row.value for row in rows}
    # six pairs of four scans overlap, but only 0-1 and 4-5 can be aligned
    assert len(asked) == 6 and {n for pair in asked for n in pair} == {0, 1, 4, 5}
    assert values == {
        registrability.OVERLAPPING: 1.0,
        registrability.ALIGNED: 0.5,
        registrability.PAIRS_ALIGNED: pytest.approx(2 / 6),
    }


# --- the page
def test_means_are_over_items_and_surveys():
    table = as_table([("a", 1, 0, "x", 2.0), ("a", 1, 1, "x", 4.0), ("a", 1, 0, "y", 9.0)])
    assert mean_by_level(table, "x").loc[1, "a"] == 3.0


@pytest.mark.wording
def test_the_sentence_on_budgets_names_the_best_of_either_kind():
    found = point_budgets.FOUND_SHARE
    rows = [("every_nth", 5, 0, found, 0.2), ("wall_length", 5, 0, found, 0.3)]
    rows += [
        (point_budgets.VOXELS, 5, 0, found, 0.25),
        (point_budgets.RANDOM_POINTS, 5, 0, found, 0.4),
    ]
    sentence = equal_points.conclude_budgets(as_table(rows))
    assert "30.0 % of the walls by whole scans (greedy by wall length)" in sentence
    assert f"40.0 % by {point_budgets.RANDOM_POINTS}" in sentence


def test_numbers_of_several_surveys_are_told_with_their_range():
    assert case_lines.tell_number(pd.Series([3.0, 5.0])) == "4 (3 to 5)"
    assert case_lines.tell_share(pd.Series([0.5])) == "50.0 %"


def test_good_plans_are_counted_survey_by_survey():
    measured = []
    for survey, f1 in enumerate((0.97, 0.90)):
        rows = [("distance", 10, 0, quality_times.F1, f1)]
        rows += [("distance", 10, 0, quality_times.SECONDS, 7.0 + survey)]
        rows += [("distance", 10, 0, quality_times.SELECTING, 0.5)]
        measured.append(as_table(rows).assign(survey=survey))
    sentence = good_plans.conclude_quality_times(pd.concat(measured))
    assert "7 s with 10 scans (selection 0.5 s, in 1 of 2 surveys)" in sentence


def test_every_experiment_says_what_it_does():
    for experiment in EXPERIMENTS.values():
        assert experiment.how.endswith(".") and experiment.caption.endswith(".")
