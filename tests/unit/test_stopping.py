import numpy as np
import pytest

from scanplan import stopping

COLUMNS = {"covered_m2": np.array([50.0, 80.0, 95.0, 100.0, 100.0])}


@pytest.mark.parametrize(
    ("limits", "k", "reason"),
    [
        ({}, 5, "all 5 scans"),
        ({"n_scans": 2}, 2, "2 of 5 scans, as asked for"),
        ({"n_scans": 5}, 5, "5 of 5 scans, as asked for"),
        ({"n_scans": 9}, 5, "all 5 scans: 9 were asked for, there are no more"),
        ({"area_share": 0.8}, 2, "2 of 5 scans cover 0.8 of the 100.0 m2 that all cover"),
        ({"area_share": 0.81}, 3, "3 of 5 scans cover 0.81 of the 100.0 m2 that all cover"),
        ({"area_share": 1.0}, 4, "4 of 5 scans cover 1 of the 100.0 m2 that all cover"),
        ({"n_scans": 3, "area_share": 0.8}, 2, "2 of 5 scans cover 0.8 of the 100.0 m2 that all cover"),
        ({"n_scans": 1, "area_share": 0.8}, 1, "1 of 5 scans, as asked for"),
    ],
)
def test_number_and_reason(limits, k, reason):
    assert stopping.n_scans(COLUMNS, **limits) == (k, reason)


def test_a_share_is_of_the_method_s_own_measure():
    own = {**COLUMNS, "covered": np.array([5.0, 6.0, 7.0, 8.0, 10.0])}
    k, reason = stopping.n_scans(own, area_share=0.8)
    assert (k, reason) == (4, "4 of 5 scans show 0.8 of what all show, by the method's own measure")
    assert stopping.n_scans({**COLUMNS, "covered": COLUMNS["covered_m2"]}, area_share=0.8)[0] == 2


def test_rounding_of_areas_needs_no_further_scan():
    covered_m2 = np.array([10.0, 20.0, 20.0 + 1e-9])
    assert stopping.n_scans({"covered_m2": covered_m2}, area_share=1.0)[0] == 2


def test_no_area_needs_one_scan():
    assert stopping.n_scans({"covered_m2": np.zeros(3)}, area_share=0.9)[0] == 1


@pytest.mark.parametrize("wrong", [{"n_scans": 0}, {"n_scans": -1}, {"area_share": 0}, {"area_share": 1.01}])
def test_refuses_a_limit_out_of_range(wrong):
    with pytest.raises(ValueError, match=r"least one|area_share"):
        stopping.n_scans(COLUMNS, **wrong)


def test_refuses_an_ordering_of_nothing():
    with pytest.raises(ValueError, match="no scans"):
        stopping.n_scans({"covered_m2": np.zeros(0)})
