"""The picture of what a run has made so far: it grows as files come to be there."""

import json
import re
import shutil
import subprocess
import sys

import pytest

from helpers import report_making
from helpers.refusals import refused
from scanplan.project.run import growing
from scanplan.report.growing_plan import draw_growing_plan

STEPS = (
    ("poses.parquet", 'class="way"', "5 scans along the sensor's way"),
    ("registration.parquet", 'class="way"', "5 scans along the sensor's way"),
    ("scans.parquet", "<image", "4 registered scans, 16 points"),
    ("plan/segments.parquet", 'class="chosen"', "4 scans that the plan is made of"),
    ("plan/walls.parquet", 'class="wall', "6 walls and 2 rooms"),
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    report_making.files(folder)
    return folder


def put(made, results, name):
    """Have the file of a step, and what is written together with it, be there."""
    (results / "plan").mkdir(parents=True, exist_ok=True)
    shutil.copy(made / name.rpartition("/")[2], results / name)
    if name == "plan/walls.parquet":
        for table in ("faces", "openings", "rooms", "free", "furniture"):
            shutil.copy(made / f"{table}.parquet", results / f"plan/{table}.parquet")


def test_every_step_adds_what_it_found(made, tmp_path):
    results = tmp_path / "results/office"
    assert growing.stamp(results) == ""
    assert draw_growing_plan(results) == {"svg": "", "said": []}
    stamps = {""}
    for name, part, line in STEPS:
        put(made, results, name)
        drawn = draw_growing_plan(results)
        assert part in drawn["svg"] and line in drawn["said"]
        assert len(re.findall(r"<svg|</svg>", drawn["svg"])) == 2
        stamps.add(growing.stamp(results))
    # a page asks for a picture where something differs
    assert len(stamps) == 1 + len(STEPS)
    assert 'class="segments"' not in drawn["svg"] and 'class="room"' in drawn["svg"]


def test_walls_are_as_thick_as_sheets_assume_them(made, tmp_path):
    put(made, tmp_path, "plan/walls.parquet")
    usual = draw_growing_plan(tmp_path)["svg"]
    thick = json.loads(growing.draw(tmp_path, {"assumed_thickness_m": 0.3}))["svg"]
    # the east wall was seen from inside, at 7.1
    assert "7.2 " in usual and "7.2 " not in thick and "7.4 " in thick


def test_the_way_is_where_scans_were_registered(made, tmp_path):
    put(made, tmp_path, "poses.parquet")
    recorded = draw_growing_plan(tmp_path)["svg"]
    assert 'd="M1 -1L2 -1.5L4.05 -1.4L6 -1L6.5 -2"' in recorded
    put(made, tmp_path, "registration.parquet")
    # without the scan that was dropped, 3 cm further east
    assert 'd="M1.03 -1L2.03 -1.5L4.08 -1.4L6.03 -1"' in draw_growing_plan(tmp_path)["svg"]


def test_corrected_walls_take_the_place_of_others_once_all_are_there(made, tmp_path):
    for name, *_ in STEPS:
        put(made, tmp_path, name)
    (tmp_path / "plan/corrected").mkdir()
    (tmp_path / "plan/corrected/walls.parquet").touch()
    assert "6 walls and 2 rooms" in draw_growing_plan(tmp_path)["said"]


def test_a_damaged_file_is_told_by_a_process_that_ends(made, tmp_path):
    put(made, tmp_path, "poses.parquet")
    (tmp_path / "poses.parquet").write_bytes(b"PAR1")
    with refused(file="poses.parquet"):
        growing.draw(tmp_path, {})


def test_pictures_and_points_come_from_processes_of_this_package(made, tmp_path):
    report_making.written(tmp_path, report_making.files(tmp_path), name="office")
    assert json.loads(growing.draw(tmp_path, {}))["said"]
    content = b"".join(growing.send_points(tmp_path))
    n_head = int.from_bytes(content[:4], "little")
    # 12 points of three times two bytes
    assert len(content) == 4 + n_head + 72


def test_no_process_is_left_where_a_page_leaves_early(made, tmp_path, monkeypatch):
    begun = []

    def begin(*_):
        code = "import sys; [sys.stdout.buffer.write(bytes(2**20)) for _ in range(999)]"
        begun.append(
            subprocess.Popen(
                [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
            )
        )
        return begun[0]

    monkeypatch.setattr(growing, "_begin", begin)
    pieces = growing.send_points(tmp_path)
    next(pieces)
    pieces.close()
    assert begun[0].poll() is not None
