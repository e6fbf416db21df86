import numpy as np
import pytest

from evaluationmaking import SCAN_IDS, shift, write_registration
from measure_crispness import measure_crispness
from scanplan import tables

SETTINGS = {"radius_m": 0.2, "most_points": 100_000, "most_places": 500, "seed": 1}


def write_scans(folder, moved):
    with tables.scan_writer(folder / "scans.parquet", planar=False) as write:
        for scan_id in SCAN_IDS:
            rng = np.random.default_rng(int(scan_id))
            wall = np.column_stack([rng.uniform(0, 5, 3000), rng.normal(0, 0.003, 3000), rng.uniform(0, 2, 3000)])
            write(scan_id, wall + moved.get(int(scan_id), (0, 0, 0)))


def measured(folder):
    files = [folder / f"{name}.parquet" for name in ("scans", "registration", "poses", "crispness")]
    measure_crispness(*files, **SETTINGS)
    return tables.read(files[-1], tables.CRISPNESS)


def test_maps_of_both_poses_are_measured(tmp_path):
    write_registration(tmp_path)
    write_scans(tmp_path, {})
    table = measured(tmp_path)
    assert table["poses"].tolist() == ["localiser", "registered"]
    np.testing.assert_allclose(table["sigma_m"], 0.003, rtol=0.1)


def test_what_registration_moves_is_put_back_for_the_localisers_map(tmp_path):
    """All scans are moved alike: a shift of the map changes no thickness."""
    write_registration(tmp_path, shift(0.7, 0.2))
    write_scans(tmp_path, {})
    np.testing.assert_allclose(measured(tmp_path)["sigma_m"], 0.003, rtol=0.1)
    # one of the poses corrected by 6 cm: the localiser's map is thick, the registered one is not
    poses = tables.read(tmp_path / "poses.parquet", tables.POSES)
    poses["y_m"] = poses["y_m"] + np.where(poses["scan_id"] == SCAN_IDS[1], 0.06, 0)
    tables.write(tmp_path / "poses.parquet", tables.POSES, poses)
    thick_m = dict(zip(*(measured(tmp_path)[c].tolist() for c in ("poses", "sigma_m")), strict=True))
    assert thick_m["localiser"] == pytest.approx(np.sqrt(0.003**2 + 0.06**2 * 2 / 9), rel=0.1)
    assert thick_m["registered"] == pytest.approx(0.003, rel=0.1)
