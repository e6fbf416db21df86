"""The order of the scans of real recordings is that of algorithm 1, and its bound holds."""

import numpy as np
import pytest

from reference import hull_selection
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey
from scanplan.registration import results
from scanplan.selection import area_greedy, bounds, hulls, streaming

pytestmark = pytest.mark.recordings
SETTINGS = {"n_clusters": 10, "sample_size": 500, "radius": "least_distance", "seed": 1}
N_SCANS = 40


@pytest.fixture(scope="module", params=["intel", "jackal_ros1", "vlp16_room"])
def polygons(recordings_dir, request):
    """Polygons of scans from all over a recording, placed by the localiser."""
    with open_survey(
        dataset_files.find_files(str(recordings_dir / request.param)), Reading(min_range_m=0.1)
    ) as survey:
        pose, _, covered = frame_edges.chain_poses(
            survey.pose_edges(), survey.stamps(), max_gap_s=2.0
        )
        placed = np.flatnonzero(covered)
        chosen = placed[np.linspace(0, len(placed) - 1, N_SCANS).astype(int)].tolist()
        scans = [
            (scan.scan_id, results.move_to_map(scan.scan_id, scan.xyz_m, pose[scan.scan_id]))
            for scan in survey.scans(chosen)
        ]
    return hulls.scan_polygons(
        hulls.concatenate_hulls(
            [hulls.make_cluster_hulls(i, xyz_m, **SETTINGS) for i, xyz_m in scans]
        )
    )[1]


def test_same_order_as_algorithm_1(polygons):
    order, covered_m2 = hull_selection.hull_selection(list(polygons))
    found = area_greedy.order_by_area(polygons)
    assert found.order.tolist() == order
    assert found.covered == pytest.approx(covered_m2, abs=1e-8)
    assert area_greedy.area_gains(polygons, order) == pytest.approx(found.gain, abs=1e-8)


def test_the_bound_is_above_every_order(polygons):
    bound_m2 = bounds.bound_any_subset(area_greedy.order_by_area(polygons))
    for seed in range(5):
        order = np.random.default_rng(seed).permutation(len(polygons))
        assert (np.cumsum(area_greedy.area_gains(polygons, order)) <= bound_m2 + 1e-8).all()


def test_one_pass_covers_much_of_what_greedy_does(polygons):
    order, most_held = streaming.order_streaming(polygons, k=8)
    covered_m2 = area_greedy.area_gains(polygons, order)[:8].sum()
    assert covered_m2 >= 0.8 * area_greedy.order_by_area(polygons).covered[7]
    assert most_held < len(polygons)
