"""Imports are followed as Python follows them."""

from pathlib import Path

from scanplan.project import code_files

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def names(script):
    return {path.stem for path in code_files.list_helpers(script)}


def test_direct_and_indirect_imports_are_found(tmp_path):
    script = tmp_path / "stage.py"
    script.write_text("from scanplan.registration import sequential\nimport numpy\n")
    assert names(script) == {
        "sequential",
        "icp",
        "constraints",
        "planar_icp",
        "se3",
        "twists",
        "types",
    }


def test_a_stage_does_not_depend_on_what_it_does_not_import():
    assert "hulls" in names(SCRIPTS / "build_hulls.py")
    assert not {"hulls", "segments", "icp"} & names(SCRIPTS / "interpolate_poses.py")


def test_every_script_imports_helpers_that_exist():
    for script in SCRIPTS.glob("*.py"):
        assert {"log", "errors"} <= names(script)
