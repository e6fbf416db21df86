"""A recording reduced while it is read, read back by rosbags and by the stages."""

import json
from unittest import mock

import pytest

from helpers.default_settings import SETTINGS
from helpers.hall_recording import N_SCANS, messages_of, record
from helpers.refusals import refused
from interpolate_poses import interpolate_poses
from scanplan.project.settings import merge_settings
from scanplan.project.stage_settings import select_section, select_wall_cells
from scanplan.selection import wall_cells
from scanplan.selection.methods import WALL_LIMITS
from scanplan.store import schemas, tables
from write_reduced_bag import write_reduced_bag


def reduce(folder, files, suffix, **playing):
    output, own = (folder / f"reduced{suffix}{end}" for end in ("", ".yaml"))
    write_reduced_bag(
        files,
        output,
        own,
        reading=SETTINGS["input"],
        poses={**SETTINGS["poses"], "keep_every": 1},
        cells=select_wall_cells(SETTINGS, WALL_LIMITS),
        playing=select_section(SETTINGS, "selection", "playing") | playing,
    )
    return output, json.loads(own.read_text())


@pytest.mark.parametrize("suffix", [".bag", ".mcap"])
def test_of_one_hall_the_first_scan_is_enough(tmp_path, suffix):
    files = record(tmp_path, "ros1")
    output, own = reduce(tmp_path, files, suffix, min_new_share=0.5)
    (cloud,) = messages_of(output, "/points")
    first = messages_of(files[0], "/points")[0]
    assert cloud[1].data.tobytes() == first[1].data.tobytes()
    # all poses are there: it is read as any recording
    assert len(messages_of(output, "/amcl_pose")) == len(messages_of(files[0], "/amcl_pose"))
    settings = merge_settings(SETTINGS, own)
    reading = {name: value for name, value in settings["input"].items() if name != "deskew"}
    poses = tmp_path / "poses.parquet"
    interpolate_poses([str(output)], poses, **settings["poses"], **reading)
    assert tables.read_table(poses, schemas.POSES)["covered"].tolist() == [True]


def test_where_the_least_new_wall_is_enough_more_scans_are_taken(tmp_path):
    files = record(tmp_path, "ros1")
    output, _ = reduce(tmp_path, files, ".bag", min_new_share=1e-9)
    taken = len(messages_of(output, "/points"))
    assert 1 < taken <= N_SCANS


def test_cells_lie_along_the_walls_of_the_first_scan_that_shows_any(tmp_path):
    files = record(tmp_path, "ros1")
    found = mock.patch.object(wall_cells, "find_main_direction", side_effect=[None, 30])
    measured = mock.patch.object(
        wall_cells, "observe_wall_cells", wraps=wall_cells.observe_wall_cells
    )
    with found, measured as observe:
        reduce(tmp_path, files, ".bag")
    axes_deg = [call.kwargs["axes_deg"] for call in observe.call_args_list]
    assert axes_deg == [0, *[30] * (N_SCANS - 1)]


def test_without_memory_no_place_is_known_again(tmp_path):
    files = record(tmp_path, "ros1")
    output, _ = reduce(tmp_path, files, ".bag", max_cells=1)
    assert len(messages_of(output, "/points")) == N_SCANS


def test_where_no_scan_shows_a_wall_it_is_told(tmp_path):
    files = record(tmp_path, "ros1")
    with refused(value="8 scans"):
        write_reduced_bag(
            files,
            tmp_path / "reduced.bag",
            tmp_path / "reduced.bag.yaml",
            reading=SETTINGS["input"] | {"max_range_m": 0.6},
            poses={**SETTINGS["poses"], "keep_every": 1},
            cells=select_wall_cells(SETTINGS, WALL_LIMITS),
            playing={"min_new_share": 0.3, "max_cells": 10},
        )
    assert not (tmp_path / "reduced.bag").exists()
