import numpy as np
import pytest

from scanplan.stage import workers
from scanplan.store import scan_cache


def test_clouds_come_back_in_the_order_asked_for_and_nothing_stays(tmp_path):
    rng = np.random.default_rng(0)
    clouds = [rng.normal(size=(n, 3)).astype(np.float32) for n in (5, 0, 7, 1)]
    with scan_cache.open_scan_cache(tmp_path / "scans.parquet") as kept:
        for cloud in clouds:
            kept.add(cloud)
        assert len(kept) == 4
        part = kept.part([3, 1, 0])
        for found, number in zip(part, [3, 1, 0], strict=True):
            np.testing.assert_array_equal(found, clouds[number])
        assert len(list(tmp_path.iterdir())) == 1
    assert list(tmp_path.iterdir()) == []


def test_a_failure_leaves_nothing_either(tmp_path):
    with (
        pytest.raises(RuntimeError),
        scan_cache.open_scan_cache(tmp_path / "scans.parquet") as kept,
    ):
        kept.add(np.zeros((3, 3)))
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("threads", [1, 2])
def test_results_come_in_the_order_of_the_jobs(threads):
    with workers.open_pool(threads) as run:
        assert list(run(divmod, ((n, 7) for n in range(20)))) == [divmod(n, 7) for n in range(20)]


def test_a_job_that_fails_fails_here():
    with pytest.raises(ZeroDivisionError), workers.open_pool(2) as run:
        list(run(divmod, [(1, 1), (1, 0)]))
