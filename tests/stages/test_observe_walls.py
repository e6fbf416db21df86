import logging

import numpy as np
import pytest

import observe_walls
from helpers import toy_rooms
from helpers.refusals import refused
from helpers.toy_survey import SENSORS, write_survey
from scanplan.selection import methods
from scanplan.store import schemas, tables

KNOWN = {**toy_rooms.LIMITS, "wall_height_m": 1.0}
SETTINGS = {name: KNOWN[name] for name in methods.WALL_LIMITS if name in KNOWN}
SETTINGS |= {"cell_m": 0.25, "reach_deg": 3.5, "max_tilt_deg": 15.0}


@pytest.mark.parametrize("planar", [False, True])
def test_every_scan_shows_the_room(planar, tmp_path, caplog):
    caplog.set_level(logging.INFO)
    output = tmp_path / "observations.parquet"
    observe_walls.observe_walls(*write_survey(tmp_path, planar=planar), output, settings=SETTINGS)
    seen = tables.read_table(output, schemas.OBSERVATIONS)
    for scan_id in SENSORS:
        assert 18 < seen["length_m"][seen["scan_id"] == scan_id].sum() < 24
    assert "observe_walls: 3 scans, " in caplog.text and "0 show none" in caplog.text


@pytest.mark.parametrize("planar", [False, True])
def test_in_space_cells_lie_along_the_walls_however_the_map_is_turned_in_every_chunk(
    planar, tmp_path
):
    survey = write_survey(tmp_path, planar=planar, turn_deg=30.0)
    axes_deg = []
    for chunk in (None, "1-of-2", "2-of-2"):
        output = tmp_path / f"{chunk}.parquet"
        observe_walls.observe_walls(*survey, output, settings=SETTINGS, chunk=chunk)
        seen = tables.read_table(output, schemas.OBSERVATIONS)
        axes_deg.append(np.unique(seen["axes_deg"]).tolist())
        # a wall along its cells lies in few of them
        assert planar or len(np.unique(seen["across"][seen["facing"] == 0])) < 8
    expected_deg = 0 if planar else 30
    assert axes_deg == [axes_deg[0]] * 3 and abs(axes_deg[0][0] - expected_deg) <= 1


def test_same_bytes_for_one_and_two_processes(tmp_path):
    survey = write_survey(tmp_path)
    for threads in (1, 2):
        observe_walls.observe_walls(
            *survey, tmp_path / f"{threads}.parquet", settings=SETTINGS, threads=threads
        )
    assert (tmp_path / "1.parquet").read_bytes() == (tmp_path / "2.parquet").read_bytes()


def test_a_survey_without_walls_is_an_answer(tmp_path):
    blind = {**SETTINGS, "min_height_m": 5.0}
    observe_walls.observe_walls(*write_survey(tmp_path), tmp_path / "none.parquet", settings=blind)
    assert (
        len(
            tables.read_table(tmp_path / "none.parquet", schemas.OBSERVATIONS, allow_empty=True)[
                "scan_id"
            ]
        )
        == 0
    )


def test_a_scan_without_pose_is_refused(tmp_path):
    survey = write_survey(tmp_path, registered=(0, 15))
    with refused(value=("scan 5", "1 such")):
        observe_walls.observe_walls(*survey, tmp_path / "o.parquet", settings=SETTINGS)
    assert not (tmp_path / "o.parquet").exists()
