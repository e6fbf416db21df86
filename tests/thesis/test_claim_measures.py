import numpy as np
import pandas as pd
import pytest

from thesis import claim_measures


def evaluated(k, values):
    """An evaluation of one order and extractor."""
    share = np.array(values, float)
    names = {"method": "hull", "extractor": claim_measures.OURS}
    return pd.DataFrame({**names, "k": k, "share": share})


def test_every_number_of_scans_counts_once_however_few_were_evaluated():
    # 1, 1, 1 (4 times to 8 scans: 1, 0.75, 0.5, 0.25, 0), then nothing to 60
    walls = evaluated([1, 2, 4, 8, 60, 270], [1, 1, 1, 0, 0, 9])
    found = claim_measures.mean_over_first(walls, "share")
    assert found["hull"] == pytest.approx((4 + 0.75 + 0.5 + 0.25) / 60)


def test_of_fewer_scans_all_count():
    found = claim_measures.mean_over_first(evaluated([1, 3], [0, 1]), "share")
    assert found["hull"] == pytest.approx(0.5)


def timed(*rows):
    return pd.DataFrame(rows, columns=["task", "item", "size", "seconds"])


def test_a_power_law_gives_its_power_whatever_the_items_factors():
    rows = [
        ("some", item, n, factor * n**1.5)
        for item, factor in ((0, 1.0), (7, 30.0))
        for n in (10, 20, 40)
    ]
    other = ("other", 0, 10, 5.0)
    assert claim_measures.growth_exponent(timed(*rows, other), "some") == pytest.approx(1.5)
    assert np.isnan(claim_measures.growth_exponent(timed(other), "other"))
    assert np.isnan(claim_measures.growth_exponent(timed(other), "never timed"))


def test_the_fewest_scans_that_find_nine_tenths_of_what_all_do():
    walls = evaluated([1, 5, 10, 40], [0.2, 0.7, 0.75, 0.8]).rename(
        columns={"share": claim_measures.FOUND}
    )
    assert claim_measures.count_scans_to(walls, "hull", 0.9) == 10
    assert claim_measures.count_scans_to(walls, "hull", 0.5) == 5
