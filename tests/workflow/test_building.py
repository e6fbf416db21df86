"""Datasets beside building.yaml are made into one building; dry runs tell."""

import pytest

from helpers.project_copy import TINY, Project

pytestmark = pytest.mark.workflow
BUILDING = """\
name: Town hall
storeys:
- {dataset: floor_0, elevation_m: 0}
- {dataset: floor_1, elevation_m: 3}
"""


def test_storeys_make_a_building_where_all_are_given(project_root, tmp_path):
    project = Project(project_root, tmp_path)
    for name in ("floor_0", "floor_1", "floor_2"):
        (tmp_path / "house" / name).mkdir(parents=True)
        (tmp_path / "house" / name / "drive.bag").write_bytes(b"#ROSBAG V2.0\n")
    (tmp_path / "house/building.yaml").write_text(BUILDING)

    def given(*names):
        paths = ", ".join(f"house/{name}" for name in names)
        return ("--configfile", TINY, "--config", f"dataset=[{paths}]")

    assert "assemble_building" in project.would_run(*given("floor_0", "floor_1"))
    assert "assemble_building" not in project.would_run(*given("floor_0"))
    told = project.run("--dry-run", *given("floor_0", "floor_1"))
    assert "Town_hall: floor_1 not aligned with the storeys below" in told.stderr
    without = (*given("floor_0", "floor_1"), "plan={export: {formats: [csv]}}")
    assert "assemble_building" not in project.would_run(*without)
    assert "Town_hall: not made, as plan.export.formats of floor_0, floor_1 lacks ifc" in (
        project.run("--dry-run", *without).stderr
    )
    refused = project.run("--dry-run", *given("floor_0", "floor_2"))
    assert refused.returncode != 0 and "Traceback" not in refused.stderr
    assert "storey floor_1 has no scans: its dataset floor_1 is not given" in refused.stderr
