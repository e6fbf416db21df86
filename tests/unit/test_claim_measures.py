import numpy as np
import pytest

from scanplan.lab.thesis import claim_measures


def evaluated(k, values):
    """Columns of an evaluation of one order and extractor."""
    n = len(k)
    names = {"method": np.repeat("hull", n), "extractor": np.repeat(claim_measures.OURS, n)}
    return names | {"k": np.array(k), "share": np.array(values, float)}


def test_every_number_of_scans_counts_once_however_few_were_evaluated():
    # 1, 1, 1 (4 times to 8 scans: 1, 0.75, 0.5, 0.25, 0), then nothing to 80
    walls = evaluated([1, 2, 4, 8, 80, 270], [1, 1, 1, 0, 0, 9])
    assert claim_measures.mean_over_first(walls, "hull", "share") == pytest.approx(
        (4 + 0.75 + 0.5 + 0.25) / 80
    )


def test_of_fewer_scans_all_count():
    assert claim_measures.mean_over_first(
        evaluated([1, 3], [0, 1]), "hull", "share"
    ) == pytest.approx(0.5)
