"""Every claim of the thesis is judged by made-up results whose verdict is known."""

import numpy as np
import pandas as pd
import pytest

from helpers import claim_making as made
from thesis import judging
from thesis.claim_measures import MARGIN
from thesis.stated_claims import CLAIMS

pytestmark = pytest.mark.wording


def judged(kind, tables):
    rows = judging.judge_claims(kind, "seed 1", tables)
    verdicts = {row["claim"]: row["holds"] for row in rows}
    return verdicts, {(row["claim"], row["quantity"]): row["value"] for row in rows}


def rooms(**changes):
    return judged(judging.ROOMS, made.rooms(**changes))


def drive(**changes):
    return judged(judging.DRIVE, made.drive(**changes))


def test_every_claim_is_measured_once():
    found = [*rooms()[0], *drive()[0]]
    assert sorted(found) == sorted(claim.name for claim in CLAIMS)


def test_a_number_without_a_criterion_has_no_verdict():
    verdicts = rooms()[0] | drive()[0]
    for claim in CLAIMS:
        if claim.name in verdicts:
            assert (verdicts[claim.name] in ("yes", "no")) == bool(claim.criterion), claim.name


def test_the_poorest_order_is_told():
    verdicts, values = rooms()
    assert verdicts["sequential_poorest"] == "yes"
    assert values["sequential_poorest", "sequential"] > values["sequential_poorest", "random"]
    better = made.evaluation(sequential=made.FOUND["cluster_hull"], random=made.FOUND["sequential"])
    assert rooms(rooms_walls=better)[0]["sequential_poorest"] == "no"


def test_correct_matches_are_another_measure():
    # the fewer walls, the fewer can be false: the order that finds least matches best
    walls = made.evaluation()
    is_recorded = walls["method"] == "sequential"
    walls["correct_match"] = np.where(is_recorded, 0.99, 0.97)
    verdicts, _ = rooms(rooms_walls=walls)
    assert (verdicts["sequential_poorest"], verdicts["sequential_poorest_match"]) == ("yes", "no")


def test_how_similar_the_others_are():
    assert rooms()[0]["others_similar"] == "yes"
    apart = made.evaluation(hull=[0.8 * share for share in made.FOUND["sequential"]])
    assert rooms(rooms_walls=apart)[0]["others_similar"] == "no"


def test_numbers_of_another_building_have_no_verdict():
    verdicts, values = rooms(rooms_hull=made.growing(31))
    assert verdicts["full_hull_99"] == verdicts["cluster_hull_99"] == ""
    assert values["full_hull_99", "scans for 99 %"] == 31


def test_which_area_converges_sooner():
    verdicts, values = rooms()
    assert verdicts["full_hull_sooner"] == "yes" and values["full_hull_sooner", MARGIN] == 22
    assert rooms(rooms_hull=made.growing(31))[0]["full_hull_sooner"] == "no"


def test_areas_against_what_is_seen():
    verdicts, values = rooms()
    assert verdicts["full_hull_overestimates"] == verdicts["cluster_hull_closer"] == "yes"
    assert values["full_hull_overestimates", "hull per seen area, median"] == 3
    small = made.rooms()["rooms_areas"].assign(full_hull_m2=9.0)
    assert rooms(rooms_areas=small)[0]["full_hull_overestimates"] == "no"


@pytest.mark.parametrize(("area_m2", "holds"), [(19.0, "yes"), (21.0, "no"), (1.0, "yes")])
def test_much_closer_is_half_of_the_error_of_the_area_whatever_the_shape(area_m2, holds):
    # of 10 m2 seen one hull makes 30: cluster hulls may be off by 10
    areas = made.rooms()["rooms_areas"].assign(cluster_hull_m2=area_m2, cluster_hull_iou=0.1)
    verdicts, values = rooms(rooms_areas=areas)
    assert verdicts["cluster_hull_closer"] == holds
    error = values["cluster_hull_closer", "error of the area, cluster hulls, median"]
    assert error == pytest.approx(abs(area_m2 / 10 - 1))
    assert values["cluster_hull_closer", "intersection over union, cluster hulls, median"] == 0.1


@pytest.mark.parametrize(("added", "holds"), [(0.04, "yes"), (0.06, "no")])
def test_a_stray_return_may_add_half_of_what_it_adds_to_one_hull(added, holds):
    areas = made.rooms()["rooms_areas"]
    areas["cluster_hull_stray_m2"] = (1 + added) * areas["cluster_hull_m2"]
    verdicts, values = rooms(rooms_areas=areas)
    assert verdicts["outliers_harm_one_hull"] == holds
    quantity = "area added by one stray return, one hull"
    assert values["outliers_harm_one_hull", quantity] == pytest.approx(0.1)


def test_premises_hold_by_nine_tenths():
    verdicts, values = rooms()
    assert verdicts["utility_submodular"] == verdicts["clusters_are_walls"] == "yes"
    assert values["utility_submodular", MARGIN] == pytest.approx(0.1)
    low = made.premises(0.85, **{"walls found": 1.5, "F1 of walls": 0.8})
    verdicts, _ = rooms(rooms_premises=low)
    assert verdicts["utility_submodular"] == verdicts["clusters_are_walls"] == "no"
    unknown = made.premises(np.nan, **{"walls found": np.nan, "F1 of walls": 1.0})
    verdicts, _ = rooms(rooms_premises=unknown)
    assert verdicts["utility_submodular"] == verdicts["clusters_are_walls"] == ""


@pytest.mark.parametrize(("seen_m2", "holds"), [(10.0, "yes"), (31.0, "no"), (2.0, "no")])
def test_an_area_that_can_be_adjusted_lies_on_both_sides_of_the_true_one(seen_m2, holds):
    # by one cluster a scan's hulls have 30 m2, by ten 3 m2
    areas = made.rooms()["rooms_areas"].assign(seen_m2=seen_m2)
    assert rooms(rooms_areas=areas)[0]["area_adjustable"] == holds


@pytest.mark.parametrize(("unsampled_s", "holds"), [(0.12, "yes"), (0.105, "no"), (0.09, "no")])
def test_a_sample_saves_time_by_more_than_load_shifts(unsampled_s, holds):
    times = made.rooms()["rooms_times"]
    times.loc[times["task"] == "build_unsampled_hulls", "seconds"] = unsampled_s
    assert rooms(rooms_times=times)[0]["sample_saves_time"] == holds


@pytest.mark.parametrize(("extraction_s", "holds"), [(1.0, "yes"), (0.04, "no")])
def test_clusters_save_time_where_walls_take_longer_than_hulls(extraction_s, holds):
    # 90 % of the walls take 40 scans by clusters, 270 by one hull; hulls of 270 scans take 10.8 s
    # more by clusters
    times = made.rooms()["rooms_times"]
    times.loc[times["task"] == "plain_clusters", "seconds"] = extraction_s
    verdicts, values = rooms(rooms_times=times)
    assert verdicts["clusters_save_time"] == holds
    assert values["clusters_save_time", "scans needed, the most clusters"] == 40
    assert values["clusters_save_time", "scans needed, one hull"] == 270


def test_clusters():
    verdicts, _ = rooms()
    assert verdicts["more_clusters_less_area"] == verdicts["more_clusters_more_time"] == "yes"
    verdicts, _ = rooms(
        rooms_clusters=made.clusters({1: (900.0, 950.0), 10: (700.0, 950.0)}),
        rooms_times=made.times(build_hulls=((1, 10), (0.3, 0.1))),
    )
    assert verdicts["more_clusters_less_area"] == verdicts["more_clusters_more_time"] == "no"


def test_fewer_area_for_any_number_of_scans():
    growth = made.clusters({1: (900.0, 950.0), 10: (700.0, 940.0)})
    growth.loc[(growth["n_clusters"] == 10) & (growth["rank"] == 3), "covered_m2"] = 901.0
    verdicts, values = rooms(rooms_clusters=growth)
    assert verdicts["more_clusters_less_area"] == "no"
    assert values["more_clusters_less_area", "numbers of scans at which it holds"] == pytest.approx(
        29 / 30
    )


def test_subsets():
    verdicts, values = rooms()
    # 0.6 where the best 15 find 0.7, 0.8 where all find 1
    assert verdicts["fifteen_almost_complete"] == verdicts["tenth_little_loss"] == "no"
    assert values["fifteen_almost_complete", "walls found"] == 0.6
    assert values["fifteen_almost_complete", MARGIN] == pytest.approx(0.6 / 0.7 - 0.9)
    assert (
        values["tenth_little_loss", "scans"],
        values["tenth_little_loss", "walls found, a tenth"],
    ) == (27, 0.8)
    full = made.evaluation(cluster_hull=(0.1, 0.64, 0.96, 0.97, 0.98, 0.99, 1.0))
    verdicts, _ = rooms(rooms_walls=full)
    assert verdicts["fifteen_almost_complete"] == verdicts["tenth_little_loss"] == "yes"


def test_what_all_find_being_little_does_not_make_a_few_complete():
    poor = made.evaluation(cluster_hull=(0.1, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5))
    verdicts, _ = rooms(rooms_walls=poor)
    assert (verdicts["fifteen_almost_complete"], verdicts["tenth_little_loss"]) == ("no", "yes")


@pytest.mark.parametrize(("correct", "holds"), [(0.87, "yes"), (0.85, "no")])
def test_false_walls_are_a_loss_too(correct, holds):
    walls = made.evaluation(cluster_hull=(0.1, 0.95, 0.96, 0.97, 0.98, 0.99, 1.0))
    walls["visible_correctness_010m"] = np.where(walls["k"] == 270, 0.96, correct)
    assert rooms(rooms_walls=walls)[0]["tenth_little_loss"] == holds
    assert drive(drive_walls=walls)[0]["fifteen_like_all"] == holds


def test_a_survey_of_fewer_scans_has_no_first_fifteen():
    few = made.evaluation()
    few = few[few["k"] < 15]
    verdicts, values = rooms(rooms_walls=few)
    assert verdicts["fifteen_almost_complete"] == verdicts["slower_is_better"] == ""
    assert np.isnan(values["fifteen_almost_complete", "walls found"])
    assert drive(drive_walls=few)[0]["fifteen_like_all"] == ""


def test_only_walls_of_the_hallways_count_for_what_the_drive_surveyed():
    walls = made.evaluation()
    walls["entered_completeness_010m"] = np.where(walls["k"] >= 15, 0.99, 0.3)
    verdicts, values = drive(drive_walls=walls)
    assert verdicts["fifteen_like_all"] == verdicts["tenth_of_drive"] == "yes"
    quantity = "with the rooms behind open doors, cluster RANSAC, 15 scans"
    assert values["fifteen_like_all", quantity] == 0.6


@pytest.mark.parametrize(("hull_s", "holds"), [(0.02, "yes"), (0.15, "no")])
def test_a_subset_scales_where_hulls_take_less_than_the_walls_that_it_saves(hull_s, holds):
    # walls of a scan take 0.03 s and 0.1 s; hulls are of five scans
    times = made.drive()["drive_times"]
    times.loc[times["task"] == "build_hulls", "seconds"] = hull_s
    verdicts, values = drive(drive_times=times)
    assert verdicts["subset_scales"] == holds
    saved = values["subset_scales", "time saved, iterative RANSAC"]
    assert saved == pytest.approx(1 - (hull_s / 5 + 0.01) / 0.1)


@pytest.mark.parametrize(("power", "holds"), [(2.0, "yes"), (1.05, "no")])
def test_choosing_is_lengthy_where_time_grows_faster_than_the_scans(power, holds):
    times = made.drive()["drive_times"]
    of_it = times["task"] == "order_scans_literally"
    times.loc[of_it, "seconds"] = 1e-4 * times.loc[of_it, "size"] ** power
    verdicts, values = drive(drive_times=times)
    assert verdicts["selection_polynomial"] == holds
    assert values["selection_polynomial", "exponent, algorithm 1"] == pytest.approx(power)
    assert values["selection_polynomial", "90 scans, ours"] == 0.09


@pytest.mark.parametrize(("power", "holds"), [(1.0, "yes"), (0.05, "no")])
def test_fewer_walls_are_merged_faster(power, holds):
    times = made.drive()["drive_times"]
    of_it = times["task"] == "merge_segments"
    times.loc[of_it, "seconds"] = 1e-4 * times.loc[of_it, "size"] ** power
    verdicts, values = drive(drive_times=times)
    assert verdicts["fewer_walls_merge_faster"] == holds
    assert values["fewer_walls_merge_faster", "segments, the most"] == 400


def test_extraction():
    verdicts, values = drive()
    assert (
        verdicts["fewer_walls"] == verdicts["steadier_times"] == verdicts["time_by_size"] == "yes"
    )
    assert values["fewer_walls", "walls a scan, cluster RANSAC"] == 5
    assert values["fewer_walls", "walls a scan, iterative RANSAC"] == 10
    assert values["several_per_wall", "iterative RANSAC of ours"] == pytest.approx(14 / 9)
    assert values["several_per_wall", "lines, 10 mm"] == 0.5
    assert values["several_per_wall", "lines, 50 mm"] == 1.5
    assert verdicts["fifteen_like_all"] == "no"
    swapped = made.times(
        plain_ransac=((100, 200, 300), (0.03, 0.03, 0.031)),
        plain_clusters=((100, 200, 300), (0.05, 0.1, 0.15)),
        thinned_plain_ransac=((1, 2), (0.03, 0.03)),
        thinned_plain_clusters=((1, 2), (0.05, 0.1)),
        order_scans=((10, 90), (0.01, 0.09)),
    )
    verdicts, _ = drive(drive_times=swapped)
    assert verdicts["steadier_times"] == verdicts["time_by_size"] == "no"


def test_what_survives_the_limits_is_a_number_without_a_verdict():
    verdicts, values = drive(limits_steps=made.steps(3600, 300, 72))
    assert verdicts["two_percent_survive"] == ""
    assert values["two_percent_survive", "share retained"] == 0.02


def test_a_drive_without_the_limits_says_nothing_of_them():
    tables = made.drive()
    del tables["limits_steps"]
    verdicts, _ = judged(judging.DRIVE, tables)
    assert "two_percent_survive" not in verdicts and "own_limits" in verdicts


def test_numbers_of_the_drive():
    _, values = drive()
    assert values["survey_drive", "minutes"] == 6 and values["own_limits", "scans"] == 700
    assert values["selection_time", "to choose 15 of 90 scans"] == 0.045
    assert values["selection_time", "to order all 90"] == 0.09
    assert values["selection_time", "to order all 90 by algorithm 1"] == 0.81
    exponent = values["selection_polynomial", "exponent, ours, the first 15"]
    assert exponent == pytest.approx(1, abs=0.01)
    assert values["survey_drive", "gigabytes a minute"] == pytest.approx(4 / 6)
    assert values["localiser", "error of the position, localiser, rms"] == pytest.approx(
        0.0125**0.5 / 10**0.5
    )


@pytest.mark.parametrize(
    ("thesis", "cluster", "holds"),
    [
        ((1, 2, 4), (1, 1, 1), "yes"),
        ((1, 2, 4), (1, 2, 4), "no"),
        # a square root and less is nearer to being the same than to growing with the size
        ((1, 2**0.25, 2**0.5), (1, 1, 1), "no"),
        ((1, 2, 4), (1, 2**0.25, 2**0.5), "yes"),
        # shorter for more points is as much a dependence as longer
        ((1, 2, 4), (4, 2, 1), "no"),
        ((4, 2, 1), (1, 1, 1), "no"),
    ],
)
def test_time_depends_on_the_size_for_one_and_not_for_the_other(thesis, cluster, holds):
    # two scans, of which one takes ten times as long as the other for as many points
    size, times = np.array((100, 200, 400)), made.drive()["drive_times"]
    kept = times[~times["task"].str.startswith("thinned")]
    rows = [
        (f"thinned_{name}", n * (1 + item), item, 5, factor * s)
        for name, seconds in (("plain_ransac", thesis), ("plain_clusters", cluster))
        for item, factor in ((0, 1.0), (7, 10.0))
        for n, s in zip(size, seconds, strict=True)
    ]
    thinned = pd.DataFrame(rows, columns=["task", "size", "item", "found", "seconds"])
    table = pd.concat([kept, thinned], ignore_index=True)
    assert drive(drive_times=table)[0]["time_by_size"] == holds


def test_times_of_one_size_tell_nothing_about_the_size():
    times = made.drive()["drive_times"]
    times["size"] = 100
    assert drive(drive_times=times)[0]["time_by_size"] == ""


def test_where_nothing_is_found_or_seen_nothing_is_judged():
    nothing = made.evaluation(cluster_hull=[0.0] * len(made.SIZES))
    verdicts, _ = rooms(rooms_walls=nothing)
    assert (verdicts["fifteen_almost_complete"], verdicts["tenth_little_loss"]) == ("no", "")
    assert drive(drive_walls=nothing)[0]["fifteen_like_all"] == ""
    blind = made.rooms()["rooms_areas"].assign(seen_m2=0.0)
    verdicts, values = rooms(rooms_areas=blind)
    assert verdicts["full_hull_overestimates"] == verdicts["cluster_hull_closer"] == ""
    assert np.isnan(values["full_hull_overestimates", "share of scans over-estimated"])
    some = made.rooms()["rooms_areas"].assign(seen_m2=[0.0, 10, 10])
    assert (
        rooms(rooms_areas=some)[1]["full_hull_overestimates", "hull per seen area, median"] == 3.5
    )


def test_the_time_for_the_thesiss_scans_is_that_of_no_other_number():
    few = made.drive()["drive_times"]
    few["size"] = np.where(few["size"] == 90, 89, few["size"])
    assert np.isnan(drive(drive_times=few)[1]["selection_time", "to choose 15 of 90 scans"])


def test_one_candidate_and_a_few_more_per_wall_are_not_several():
    for near_walls, holds in (([9, 4], "yes"), ([9, 3], "no")):
        found = made.candidates(near_walls)
        assert drive(drive_candidates=found)[0]["several_per_wall"] == holds
    nothing = made.candidates([0, 0]).assign(walls=0)
    assert drive(drive_candidates=nothing)[0]["several_per_wall"] == ""


@pytest.mark.parametrize(
    ("random", "area", "holds"),
    [
        ((100.0, 90.0, 70.0), (120.0, 120.0, 116.0), "yes"),
        # random suffers, but not the more the worse it gets
        ((100.0, 80.0, 85.0), (120.0, 120.0, 120.0), "no"),
        ((100.0, 98.0, 96.0), (120.0, 120.0, 120.0), "no"),
        # the area-based order suffers, too
        ((100.0, 90.0, 70.0), (120.0, 105.0, 120.0), "no"),
        ((0.5, 0.5, 0.5), (0.5, 0.5, 0.5), "no"),
    ],
)
def test_uneven_sampling(random, area, holds):
    verdicts, values = rooms(rooms_unevenness=made.unevenness(random=random, cluster_hull=area))
    assert verdicts["uneven_harms_random"] == holds
    assert values["uneven_harms_random", "lost, random, crowd 20 times"] == pytest.approx(
        1 - random[2] / random[0]
    )


def test_where_no_wall_is_seen_unevenness_tells_nothing():
    blind = made.rooms()["rooms_unevenness"]
    blind["seen_m"] = 0.0
    assert rooms(rooms_unevenness=blind)[0]["uneven_harms_random"] == ""
