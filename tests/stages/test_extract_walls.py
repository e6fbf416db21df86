import numpy as np
import pytest

import extract_walls
from helpers import toy_rooms
from helpers.room_survey import SENSORS, SETTINGS, write_survey
from scanplan.errors import StageError
from scanplan.store import schemas, tables

# no gap, height or furniture is asked for
_LIMITS = {
    key: toy_rooms.LIMITS[key] for key in ("inlier_m", "min_points", "min_points_planar", "seed")
}
_RANSAC = {**_LIMITS, "max_tilt_deg": 15.0, "model": "plane", "max_trials": 50}
THESIS = {
    "thesis_cluster_ransac": {
        **_RANSAC,
        "reach_deg": 3.5,
        "bandwidth_m": 0.3,
        "projection": "normal",
    },
    "thesis_iterative_ransac": _RANSAC,
}


@pytest.fixture(params=[False, True], ids=["space", "plane"])
def survey(request, tmp_path):
    return write_survey(tmp_path, planar=request.param)


@pytest.mark.parametrize("extractor", SETTINGS)
def test_walls_of_every_scan(survey, extractor, tmp_path):
    output = tmp_path / "walls" / f"{extractor}.parquet"
    extract_walls.extract_walls(*survey, output, extractor=extractor, settings=SETTINGS[extractor])
    walls = tables.read_table(output, schemas.WALLS)
    assert set(walls["scan_id"]) == set(SENSORS)
    for scan_id, sensor in SENSORS.items():
        own = {name: column[walls["scan_id"] == scan_id] for name, column in walls.items()}
        assert own["wall"].tolist() == list(range(len(own["wall"])))
        assert len(own["wall"]) >= 6
        to_sensor = (sensor[0] - own["x0_m"]) * own["nx"] + (sensor[1] - own["y0_m"]) * own["ny"]
        assert (to_sensor > 0.5).all()
        offsets = own["x0_m"] * own["nx"] + own["y0_m"] * own["ny"]
        for expected in (0, -4, -6, -9):
            assert np.abs(offsets - expected).min() < 0.01


@pytest.mark.parametrize("extractor", [*SETTINGS, *THESIS])
def test_same_bytes_for_one_and_two_processes(extractor, tmp_path):
    survey = write_survey(tmp_path, planar=False)
    for threads in (1, 2):
        settings = (SETTINGS | THESIS)[extractor]
        options = {"extractor": extractor, "settings": settings, "threads": threads}
        extract_walls.extract_walls(*survey, tmp_path / f"{threads}.parquet", **options)
    assert (tmp_path / "1.parquet").read_bytes() == (tmp_path / "2.parquet").read_bytes()


def test_no_wall_anywhere_is_an_answer(tmp_path):
    survey = write_survey(tmp_path, planar=False, scan=lambda _, seed: np.full((3, 3), float(seed)))
    output, settings = tmp_path / "walls.parquet", SETTINGS["cluster_ransac"]
    extract_walls.extract_walls(*survey, output, extractor="cluster_ransac", settings=settings)
    assert len(tables.read_table(output, schemas.WALLS, allow_empty=True)["wall"]) == 0


def test_a_scan_without_a_pose_is_told(tmp_path):
    survey = write_survey(tmp_path, planar=False, shown=(0, 5))
    output, settings = tmp_path / "walls.parquet", SETTINGS["cluster_ransac"]
    with pytest.raises(StageError, match=r"registration\.parquet.*scan 15"):
        extract_walls.extract_walls(*survey, output, extractor="cluster_ransac", settings=settings)
    assert not output.exists()


def test_an_unknown_extractor_is_told(tmp_path):
    with pytest.raises(StageError, match=r"hough.*cluster_ransac, iterative_ransac"):
        extract_walls.extract_walls(
            "scans", "registration", tmp_path / "w", extractor="hough", settings={}
        )
