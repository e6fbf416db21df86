import numpy as np
import pytest

from scanplan.errors import StageError
from scanplan.selection import stopping
from scanplan.store import schemas, tables

COLUMNS = {
    "covered_m2": np.array([50.0, 80.0, 95.0, 100.0, 100.0]),
    "gain_m2": np.array([50.0, 30.0, 15.0, 5.0, 0.0]),
    "n_points": np.array([1000, 3000, 2000, 1000, 1000]),
}


@pytest.mark.parametrize(
    ("limits", "k", "reason"),
    [
        ({}, 5, "all 5 scans"),
        ({"n_scans": 2}, 2, "2 of 5 scans, as asked for"),
        ({"n_scans": 5}, 5, "5 of 5 scans, as asked for"),
        ({"n_scans": 9}, 5, "all 5 scans: 9 were asked for, there are no more"),
        ({"area_share": 0.8}, 2, "2 of 5 scans cover 80 % of the 100.0 m2 that all cover"),
        ({"area_share": 0.81}, 3, "3 of 5 scans cover 81 % of the 100.0 m2 that all cover"),
        ({"area_share": 1.0}, 4, "4 of 5 scans cover 100 % of the 100.0 m2 that all cover"),
        (
            {"n_scans": 3, "area_share": 0.8},
            2,
            "2 of 5 scans cover 80 % of the 100.0 m2 that all cover",
        ),
        ({"n_scans": 1, "area_share": 0.8}, 1, "1 of 5 scans, as asked for"),
        ({"min_gain_m2": 15.0}, 3, "3 of 5 scans: no later one adds 15 m2"),
        ({"min_gain_m2": 60.0}, 1, "1 of 5 scans: no later one adds 60 m2"),
        ({"max_points": 5999}, 2, "2 of 5 scans: 4,000 of at most 5,999 points"),
        ({"max_points": 6000}, 3, "3 of 5 scans: 6,000 of at most 6,000 points"),
        ({"max_bytes": 12_000}, 1, "1 of 5 scans: 12,000 of at most 12,000 bytes"),
        ({"max_bytes": 10**9, "min_gain_m2": 5.0}, 4, "4 of 5 scans: no later one adds 5 m2"),
    ],
)
def test_number_and_reason(limits, k, reason):
    assert stopping.choose_n_scans(COLUMNS, **limits) == (k, reason)


def test_a_share_is_of_the_method_s_own_measure():
    own = {**COLUMNS, "covered": np.array([5.0, 6.0, 7.0, 8.0, 10.0])}
    k, reason = stopping.choose_n_scans(own, area_share=0.8)
    assert k == 4 and "4 of 5" in reason and "80 %" in reason
    assert (
        stopping.choose_n_scans({**COLUMNS, "covered": COLUMNS["covered_m2"]}, area_share=0.8)[0]
        == 2
    )


def test_an_automatic_share_needs_to_know_the_scanner():
    with pytest.raises(ValueError, match="planar"):
        stopping.choose_n_scans(COLUMNS, area_share="auto")


COUNTED = ("rank", "scan_id", "n_points")


# 20 scans of equal worth, too little to go on for: for nine tenths it takes most of them
EVEN_M2 = np.arange(1.0, 21.0)


@pytest.mark.parametrize(
    ("planar", "k", "said"), [(False, 19, "show 95 % of"), (True, 17, "show 85.0 % of")]
)
def test_an_automatic_share_is_less_in_the_plane(tmp_path, planar, k, said):
    columns = {
        **dict.fromkeys(COUNTED, np.zeros(20, int)),
        **{name: EVEN_M2 for name in schemas.SELECTION.columns if name not in COUNTED},
        **{"rank": np.arange(1, 21), "covered_m2": EVEN_M2 / 2},
    }
    path = tmp_path / "wall_length.parquet"
    notes = {"planar": "true"} if planar else None
    tables.write_table(path, schemas.SELECTION, columns, notes=notes)
    chosen_ids, reason = stopping.read_chosen_scans(path, area_share="auto")
    assert len(chosen_ids) == k and said in reason


@pytest.mark.parametrize(
    ("planar", "n", "k"), [(False, 40, 3), (True, 40, 10), (False, 2, 2), (True, 2, 2)]
)
def test_a_few_scans_are_chosen_though_one_shows_all(planar, n, k):
    found, reason = stopping.choose_n_scans(
        {"covered_m2": np.full(n, 50.0)}, area_share="auto", planar=planar
    )
    assert found == k and reason.startswith(f"{k} of {n} scans")


@pytest.mark.parametrize(
    ("covered_m2", "k"),
    [
        # 4 scans show 0.9, and 7 show 0.95; 4 and 12; 12 and 13, and 11, no fewer, 0.85
        ([50, 70, 80, 90, 92, 94, 96, 98, 99, 99.5, 99.8, 100], 10),
        ([50, 70, 80, 90, 91, 92, 92.5, 93, 93.5, 94, 94.5, 100], 10),
        ([50, 60, 70, 75, 80, 82, 83, 84, 84.5, 84.8, 85, 92, 100], 11),
    ],
)
def test_of_few_planar_scans_none_are_spared(covered_m2, k):
    found, _ = stopping.choose_n_scans(
        {"covered_m2": np.array(covered_m2, float)}, area_share="auto", planar=True
    )
    assert found == k


@pytest.mark.parametrize(
    ("gain_m", "k"),
    [
        # 0.9 of 100 m is shown by 12 scans, 0.95 by 15 and by 14
        ([10.0] * 7 + [4.0] * 5 + [1.51, 1.49, 2.0, 2.0, 2.0, 1.0], 13),
        ([10.0] * 7 + [4.0] * 5 + [3.0, 3.0, 2.0, 2.0], 14),
        ([10.0] * 7 + [4.0] * 5 + [1.4, 3.0, 2.0, 2.0, 1.6], 12),
    ],
)
def test_planar_scans_are_taken_while_each_shows_much(gain_m, k):
    # fifty more that show nothing, so that three of ten are enough
    gain_m = [*gain_m, *[0.0] * 50]
    columns = {"covered_m2": np.ones(len(gain_m)), "covered": np.cumsum(gain_m)}
    assert columns["covered"][-1] == pytest.approx(100)
    assert stopping.choose_n_scans(columns, area_share="auto", planar=True)[0] == k


@pytest.mark.parametrize(
    ("gain_m", "k", "said"),
    [
        # of 40 scans 12 may be taken: for 0.9 it takes 15, and for 0.85 ten; or 13
        ([8.5] * 10 + [1.0] * 15 + [0.0] * 15, 12, "show 87.0 % of"),
        ([6.6] * 12 + [5.8] + [1.0] * 15 + [0.0] * 12, 13, "show 85.0 % of"),
        # for 0.9 it takes 12, and the next adds much
        ([8.5] * 10 + [2.5] * 2 + [2.0] * 5 + [0.0] * 23, 12, "show 90.0 % of"),
    ],
)
def test_of_planar_scans_three_of_ten_are_taken_unless_they_show_less(gain_m, k, said):
    columns = {"covered_m2": np.ones(40), "covered": np.cumsum(gain_m)}
    assert columns["covered"][-1] == pytest.approx(100)
    found, reason = stopping.choose_n_scans(columns, area_share="auto", planar=True)
    assert (found, said in reason, "limit: 30 %, 10," in reason) == (k, True, True)


def test_rounding_of_areas_needs_no_further_scan():
    covered_m2 = np.array([10.0, 20.0, 20.0 + 1e-9])
    assert stopping.choose_n_scans({"covered_m2": covered_m2}, area_share=1.0)[0] == 2


def test_no_area_needs_one_scan():
    assert stopping.choose_n_scans({"covered_m2": np.zeros(3)}, area_share=0.9)[0] == 1


def test_a_late_scan_that_adds_much_is_not_lost_in_an_order_without_greed():
    gain_m2 = np.array([3.0, 0.0, 7.0, 1.0])
    columns = {"covered_m2": np.cumsum(gain_m2), "gain_m2": gain_m2}
    assert stopping.choose_n_scans(columns, min_gain_m2=2.0)[0] == 3


def test_a_budget_below_the_first_scan_is_told():
    with pytest.raises(StageError, match=r"max_points: .*1,000.*999; raise"):
        stopping.choose_n_scans(COLUMNS, max_points=999)


@pytest.mark.parametrize(
    ("limits", "points"),
    [
        ({}, None),
        ({"max_points": 7}, 7),
        ({"max_bytes": 25}, 2),
        ({"max_points": 7, "max_bytes": 120}, 7),
    ],
)
def test_budget_in_points(limits, points):
    assert stopping.points_budget(**limits) == points


@pytest.mark.parametrize(
    "wrong",
    [
        {"n_scans": 0},
        {"n_scans": -1},
        {"area_share": 0},
        {"area_share": 1.01},
        {"min_gain_m2": 0.0},
        {"min_gain_m2": np.nan},
        {"max_points": 0},
    ],
)
def test_refuses_a_limit_out_of_range(wrong):
    with pytest.raises(ValueError, match=r"n_scans|area_share|min_gain|max_points"):
        stopping.choose_n_scans(COLUMNS, **wrong)


def test_refuses_an_ordering_of_nothing():
    with pytest.raises(ValueError, match="no scans"):
        stopping.choose_n_scans({"covered_m2": np.zeros(0)})
