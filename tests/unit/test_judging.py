"""Every claim of the thesis is judged by made-up results whose verdict is known."""

import numpy as np
import pytest

import claimmaking as made
from scanplan.thesis import judging
from scanplan.thesis.thesisclaims import CLAIMS, stated


def judged(kind, tables):
    rows = judging.judge(kind, "seed 1", tables)
    verdicts = {row["claim"]: row["holds"] for row in rows}
    return verdicts, {(row["claim"], row["quantity"]): row["value"] for row in rows}


def rooms(**changes):
    return judged(judging.ROOMS, made.rooms(**changes))


def drive(**changes):
    return judged(judging.DRIVE, made.drive(**changes))


def test_every_claim_is_measured_once():
    both = judged(judging.BOTH, made.rooms() | made.drive())[0]
    found = [*rooms()[0], *drive()[0], *both]
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
    assert values["cluster_hull_closer", "relative error, cluster hulls"] == pytest.approx(0.2)
    small = made.rooms()["rooms_areas"] | {"full_hull_m2": np.array([9.0, 9, 9])}
    verdicts, _ = rooms(rooms_areas=small)
    assert verdicts["full_hull_overestimates"] == verdicts["cluster_hull_closer"] == "no"


def test_clusters():
    verdicts, _ = rooms()
    assert verdicts["more_clusters_less_area"] == verdicts["more_clusters_more_time"] == "yes"
    verdicts, _ = rooms(
        rooms_clusters=made.clusters({1: (900.0, 950.0), 10: (700.0, 950.0)}),
        rooms_times=made.times(build_hulls=((1, 10), (0.3, 0.1))),
    )
    assert verdicts["more_clusters_less_area"] == verdicts["more_clusters_more_time"] == "no"


def test_subsets():
    verdicts, values = rooms()
    assert verdicts["fifteen_almost_complete"] == verdicts["tenth_little_loss"] == "no"
    assert values["fifteen_almost_complete", "share of what all find"] == 0.6
    assert (values["tenth_little_loss", "scans"], values["tenth_little_loss", "share of what all find"]) == (27, 0.8)
    full = made.evaluation(cluster_hull=(0.1, 0.95, 0.96, 0.97, 0.98, 0.99, 1.0))
    verdicts, _ = rooms(rooms_walls=full)
    assert verdicts["fifteen_almost_complete"] == verdicts["tenth_little_loss"] == "yes"


def test_extraction():
    verdicts, values = drive()
    assert verdicts["fewer_walls"] == verdicts["steadier_times"] == verdicts["time_by_size"] == "yes"
    assert values["fewer_walls", "walls a scan, cluster_ransac"] == 10
    assert values["several_per_wall", "segments per true wall, iterative_ransac"] == pytest.approx(14 / 9)
    assert verdicts["fifteen_like_all"] == "no"
    swapped = made.times(
        iterative_ransac=((100, 200, 300), (0.03, 0.03, 0.031)), cluster_ransac=((100, 200, 300), (0.05, 0.1, 0.15)),
        order_scans=((10, 90), (0.01, 0.09)),
    )  # fmt: skip
    verdicts, _ = drive(drive_times=swapped)
    assert verdicts["steadier_times"] == verdicts["time_by_size"] == "no"


@pytest.mark.parametrize(("retained", "holds"), [(76, "yes"), (55, "yes"), (89, "yes"), (30, "no"), (700, "no")])
def test_two_percent(retained, holds):
    verdicts, values = drive(limits_steps=made.steps(3600, retained))
    assert verdicts["two_percent_survive"] == holds
    assert values["two_percent_survive", "share retained"] == retained / 3600


def test_numbers_of_the_drive():
    _, values = drive()
    assert values["survey_drive", "minutes"] == 6 and values["own_limits", "scans"] == 700
    assert values["selection_time", "seconds for 90 scans"] == 0.09
    assert values["selection_time", "exponent of its growth"] == pytest.approx(1)
    assert values["localiser", "error of the position, localiser, rms (m)"] == pytest.approx(0.0125**0.5 / 10**0.5)


@pytest.mark.parametrize(
    ("iterative", "cluster", "holds"),
    [
        ((1, 2, 3, 4), (1, 2, 2, 1), "yes"),
        ((1, 2, 3, 4), (1, 2, 3, 4), "no"),
        # against the size is as much a dependence as with it
        ((1, 2, 3, 4), (4, 3, 2, 1), "no"),
        ((4, 3, 2, 1), (1, 2, 2, 1), "no"),
        # neither depends on it, one by chance less
        ((1, 2, 2, 1.1), (1, 2, 2, 1), "no"),
        # what does not vary has no correlation
        ((1, 2, 3, 4), (1, 1, 1, 1), ""),
    ],
)
def test_time_depends_on_the_size_for_one_and_not_for_the_other(iterative, cluster, holds):
    size = (100, 200, 300, 400)
    times = made.times(
        cluster_ransac=(size, cluster), iterative_ransac=(size, iterative), order_scans=((10, 90), (0.01, 0.09))
    )
    assert drive(drive_times=times)[0]["time_by_size"] == holds


def test_where_nothing_is_found_or_seen_nothing_is_judged():
    nothing = made.evaluation(cluster_hull=[0.0] * len(made.SIZES))
    verdicts, values = rooms(rooms_walls=nothing)
    assert verdicts["fifteen_almost_complete"] == verdicts["tenth_little_loss"] == ""
    assert np.isnan(values["tenth_little_loss", "share of what all find"])
    assert drive(drive_walls=nothing)[0]["fifteen_like_all"] == ""
    blind = made.rooms()["rooms_areas"] | {"seen_m2": np.zeros(3)}
    verdicts, values = rooms(rooms_areas=blind)
    assert verdicts["full_hull_overestimates"] == verdicts["cluster_hull_closer"] == ""
    assert np.isnan(values["full_hull_overestimates", "share of scans over-estimated"])
    some = made.rooms()["rooms_areas"] | {"seen_m2": np.array([0.0, 10, 10])}
    assert rooms(rooms_areas=some)[1]["full_hull_overestimates", "hull per seen area, median"] == 3.5


def test_the_time_for_the_thesiss_scans_is_that_of_no_other_number():
    few = made.times(
        cluster_ransac=((1, 2), (1, 2)), iterative_ransac=((1, 2), (1, 2)), order_scans=((10, 80), (0.01, 0.08))
    )
    assert np.isnan(drive(drive_times=few)[1]["selection_time", "seconds for 90 scans"])


def test_one_segment_and_a_few_more_per_wall_are_not_several():
    walls = made.evaluation()
    assert drive()[0]["several_per_wall"] == "yes"
    for count, holds in ((1.49, "no"), (1.5, "yes"), (np.nan, "")):
        # of all scans alone, not of the first of the orders
        walls["walls_per_true_wall_of_a_scan"] = np.where(walls["k"] == 270, count, 2.0 if holds == "no" else 1.0)
        assert drive(drive_walls=walls)[0]["several_per_wall"] == holds


def test_uneven_sampling():
    uneven = made.evaluation(random=(0.1, 0.3, 0.75, 0.85, 0.9, 0.95, 1.0))
    assert judged(judging.BOTH, made.rooms() | made.drive(drive_walls=uneven))[0] == {"uneven_harms_random": "yes"}
    assert judged(judging.BOTH, made.rooms() | made.drive())[0] == {"uneven_harms_random": "no"}


def test_stated_numbers_are_the_thesiss():
    assert stated("full_hull_99", "scans for 99 %") == 10 and stated("cluster_hull_99", "scans for 99 %") == 17
