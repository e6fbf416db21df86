"""Every claim of the thesis is judged by made-up results whose verdict is known."""

import numpy as np
import pytest

from helpers import claim_making as made
from scanplan.lab.thesis import judging
from scanplan.lab.thesis.stated_claims import CLAIMS, stated_number


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
    walls["correct_match"] = np.where(walls["method"] == "sequential", 0.99, 0.97)
    verdicts, _ = rooms(rooms_walls=walls)
    assert (verdicts["sequential_poorest"], verdicts["sequential_poorest_match"]) == ("yes", "no")


def test_how_similar_the_others_are():
    assert rooms()[0]["others_similar"] == "yes"
    apart = made.evaluation(hull=[0.8 * share for share in made.FOUND["sequential"]])
    assert rooms(rooms_walls=apart)[0]["others_similar"] == "no"


@pytest.mark.parametrize(("at", "holds"), [(8, "yes"), (12, "yes"), (7, "no"), (13, "no")])
def test_about_ten(at, holds):
    verdicts, values = rooms(rooms_hull=made.growing(at))
    assert verdicts["full_hull_99"] == holds
    assert values["full_hull_99", "scans for 99 %"] == at


def test_which_area_converges_sooner():
    verdicts, _ = rooms()
    assert (verdicts["cluster_hull_99"], verdicts["full_hull_sooner"]) == ("no", "yes")
    assert rooms(rooms_hull=made.growing(31))[0]["full_hull_sooner"] == "no"


def test_areas_against_what_is_seen():
    verdicts, values = rooms()
    assert verdicts["full_hull_overestimates"] == verdicts["cluster_hull_closer"] == "yes"
    assert values["full_hull_overestimates", "hull per seen area, median"] == 3
    assert values["cluster_hull_closer", "shared, cluster hulls, median"] == pytest.approx(0.8)
    small = made.rooms()["rooms_areas"] | {"full_hull_m2": np.array([9.0, 9, 9])}
    assert rooms(rooms_areas=small)[0]["full_hull_overestimates"] == "no"


@pytest.mark.parametrize(("iou", "holds"), [(0.71, "yes"), (0.69, "no"), (0.3, "no")])
def test_much_closer_is_half_of_what_is_not_shared_whatever_the_areas(iou, holds):
    # one hull shares 0.4: cluster hulls must share 0.7
    areas = made.rooms()["rooms_areas"] | {
        "cluster_hull_iou": np.full(3, iou),
        "cluster_hull_m2": np.full(3, 10.0),
    }
    assert rooms(rooms_areas=areas)[0]["cluster_hull_closer"] == holds


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
    growth["covered_m2"][(growth["n_clusters"] == 10) & (growth["rank"] == 3)] = 901.0
    verdicts, values = rooms(rooms_clusters=growth)
    assert verdicts["more_clusters_less_area"] == "no"
    assert values["more_clusters_less_area", "numbers of scans at which it holds"] == pytest.approx(
        29 / 30
    )


def test_subsets():
    verdicts, values = rooms()
    assert verdicts["fifteen_almost_complete"] == verdicts["tenth_little_loss"] == "no"
    assert values["fifteen_almost_complete", "walls found"] == 0.6
    assert (
        values["tenth_little_loss", "scans"],
        values["tenth_little_loss", "walls found, a tenth"],
    ) == (27, 0.8)
    full = made.evaluation(cluster_hull=(0.1, 0.95, 0.96, 0.97, 0.98, 0.99, 1.0))
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
    few = {name: values[few["k"] < 15] for name, values in few.items()}
    verdicts, values = rooms(rooms_walls=few)
    assert verdicts["fifteen_almost_complete"] == verdicts["slower_is_better"] == ""
    assert np.isnan(values["fifteen_almost_complete", "walls found"])
    assert drive(drive_walls=few)[0]["fifteen_like_all"] == ""


def test_extraction():
    verdicts, values = drive()
    assert (
        verdicts["fewer_walls"] == verdicts["steadier_times"] == verdicts["time_by_size"] == "yes"
    )
    assert values["fewer_walls", "walls a scan, cluster RANSAC"] == 5
    assert values["fewer_walls", "walls a scan, iterative RANSAC"] == 10
    assert values["several_per_wall", "iterative RANSAC"] == pytest.approx(14 / 9)
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


@pytest.mark.parametrize(
    ("retained", "holds"), [(76, "yes"), (55, "yes"), (89, "yes"), (30, "no"), (700, "no")]
)
def test_two_percent(retained, holds):
    verdicts, values = drive(limits_steps=made.steps(3600, 300, retained))
    assert verdicts["two_percent_survive"] == holds
    assert values["two_percent_survive", "share retained"] == retained / 3600


def test_numbers_of_the_drive():
    _, values = drive()
    assert values["survey_drive", "minutes"] == 6 and values["own_limits", "scans"] == 700
    assert values["selection_time", "to choose 15 of 90 scans"] == 0.045
    assert values["selection_time", "to order all 90"] == 0.09
    assert values["selection_time", "exponent of the growth of choosing"] == pytest.approx(
        1, abs=0.01
    )
    assert values["localiser", "error of the position, localiser, rms"] == pytest.approx(
        0.0125**0.5 / 10**0.5
    )


@pytest.mark.parametrize(
    ("thesis", "cluster", "holds"),
    [
        ((1, 2, 4), (1, 1, 1), "yes"),
        ((1, 2, 4), (1, 2, 4), "no"),
        # the fourth root of the size hardly is one that depends on it
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
    of_it = np.char.startswith(times["task"], "thinned")
    rows = {name: values[~of_it].tolist() for name, values in times.items()}
    for name, seconds in (("plain_ransac", thesis), ("plain_clusters", cluster)):
        for item, factor in ((0, 1.0), (7, 10.0)):
            rows["task"] += [f"thinned_{name}"] * 3
            rows["size"] += (size * (1 + item)).tolist()
            rows["item"] += [item] * 3
            rows["found"] += [5] * 3
            rows["seconds"] += [factor * s for s in seconds]
    assert (
        drive(drive_times={name: np.array(v) for name, v in rows.items()})[0]["time_by_size"]
        == holds
    )


def test_times_of_one_size_tell_nothing_about_the_size():
    times = made.drive()["drive_times"]
    times["size"] = np.full(len(times["size"]), 100)
    assert drive(drive_times=times)[0]["time_by_size"] == ""


def test_where_nothing_is_found_or_seen_nothing_is_judged():
    nothing = made.evaluation(cluster_hull=[0.0] * len(made.SIZES))
    verdicts, _ = rooms(rooms_walls=nothing)
    assert (verdicts["fifteen_almost_complete"], verdicts["tenth_little_loss"]) == ("no", "")
    assert drive(drive_walls=nothing)[0]["fifteen_like_all"] == ""
    blind = made.rooms()["rooms_areas"] | {"seen_m2": np.zeros(3)}
    verdicts, values = rooms(rooms_areas=blind)
    assert verdicts["full_hull_overestimates"] == verdicts["cluster_hull_closer"] == ""
    assert np.isnan(values["full_hull_overestimates", "share of scans over-estimated"])
    some = made.rooms()["rooms_areas"] | {"seen_m2": np.array([0.0, 10, 10])}
    assert (
        rooms(rooms_areas=some)[1]["full_hull_overestimates", "hull per seen area, median"] == 3.5
    )


def test_the_time_for_the_thesiss_scans_is_that_of_no_other_number():
    few = made.drive()["drive_times"]
    few["size"] = np.where(few["size"] == 90, 89, few["size"])
    assert np.isnan(drive(drive_times=few)[1]["selection_time", "to choose 15 of 90 scans"])


def test_one_segment_and_a_few_more_per_wall_are_not_several():
    walls = made.evaluation()
    assert drive()[0]["several_per_wall"] == "yes"
    for count, holds in ((1.49, "no"), (1.5, "yes"), (np.nan, "")):
        # of all scans alone, not of the first of the orders
        walls["walls_per_true_wall_of_a_scan"] = np.where(
            walls["k"] == 270, count, 2.0 if holds == "no" else 1.0
        )
        assert drive(drive_walls=walls)[0]["several_per_wall"] == holds


@pytest.mark.parametrize(
    ("random", "area", "holds"),
    [
        ((100.0, 90.0, 70.0), (120.0, 120.0, 116.0), "yes"),
        # random suffers, but not the more the worse it gets
        ((100.0, 80.0, 85.0), (120.0, 120.0, 120.0), "no"),
        ((100.0, 98.0, 96.0), (120.0, 120.0, 120.0), "no"),
        # the area-based order suffers, too
        ((100.0, 90.0, 70.0), (120.0, 110.0, 120.0), "no"),
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
    blind["seen_m"] = np.zeros(len(blind["seen_m"]))
    assert rooms(rooms_unevenness=blind)[0]["uneven_harms_random"] == ""


def test_stated_numbers_are_the_thesiss():
    assert (
        stated_number("full_hull_99", "scans for 99 %") == 10
        and stated_number("cluster_hull_99", "scans for 99 %") == 17
    )
