"""Imports are followed as Python follows them."""

import ast
import re
from pathlib import Path

import yaml

import scanplan
from scanplan.project import code_files

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def names(script):
    return {path.stem for path in code_files.list_helpers(script)}


def test_direct_and_indirect_imports_are_found(tmp_path):
    script = tmp_path / "stage.py"
    script.write_text("from scanplan.registration import sequential\nimport numpy\n")
    helpers = {"sequential", "icp", "constraints", "planar_icp", "se3", "twists"}
    assert helpers <= names(script) and not {"hulls", "walls", "bags"} & names(script)


def test_what_is_imported_for_types_alone_is_no_helper(tmp_path):
    script = tmp_path / "stage.py"
    script.write_text(
        "from typing import TYPE_CHECKING\nfrom scanplan import errors\n"
        "if TYPE_CHECKING:\n    from scanplan.geometry import se3\n"
    )
    assert names(script) == {"errors"}


def test_an_import_within_a_function_counts(tmp_path):
    script = tmp_path / "stage.py"
    script.write_text("def stage():\n    from scanplan.store.tum import read_tum\n")
    assert {"tum", "errors"} <= names(script)


def imported_modules(tree):
    """Names that a syntax tree imports from our packages, but for types alone."""
    names, waiting = set(), [tree]
    while waiting:
        node = waiting.pop()
        is_import = isinstance(node, ast.ImportFrom)
        if is_import and (node.module or "").startswith(("scanplan", "thesis")):
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        if not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"):
            waiting.extend(ast.iter_child_nodes(node))
    return names


def test_the_imports_of_every_file_are_those_of_its_syntax_tree():
    for path in SCRIPTS.rglob("*.py"):
        modules = imported_modules(ast.parse(path.read_text()))
        files = {SCRIPTS / f"{module.replace('.', '/')}.py" for module in modules}
        assert code_files._imports(path) == {file for file in files if file.exists()}, path


def test_a_stage_does_not_depend_on_what_it_does_not_import():
    assert "hulls" in names(SCRIPTS / "build_hulls.py")
    assert not {"hulls", "segments", "icp"} & names(SCRIPTS / "interpolate_poses.py")


def test_every_script_imports_helpers_that_exist():
    for script in (*SCRIPTS.glob("*.py"), *SCRIPTS.glob("thesis/stages/*.py")):
        assert {"log", "errors"} <= names(script)


def test_a_stage_of_the_laboratory_depends_on_helpers_of_both_packages():
    helpers = {"judging", "room_claims", "thesis_schemas", "tables", "schemas"}
    assert helpers <= names(SCRIPTS / "thesis/stages/judge_claims.py")


def test_a_digest_of_helpers_is_of_what_they_say(tmp_path):
    one, same, other = (tmp_path / f"{name}.py" for name in ("one", "same", "other"))
    for script, imported in ((one, "tum"), (same, "tum"), (other, "atomic")):
        script.write_text(f"from scanplan.store import {imported}\n")
    digest = code_files.digest_helpers(one)
    assert len(digest) == 12 and digest == code_files.digest_helpers(same)
    assert digest != code_files.digest_helpers(other)


def test_the_code_of_plans_is_all_but_the_laboratorys(tmp_path, monkeypatch):
    monkeypatch.setattr(code_files, "_PACKAGE", tmp_path / "scanplan")
    files = [tmp_path / name for name in ("stage.py", "scanplan/helper.py", "thesis/claims.py")]
    digests = []
    for file in files:
        file.parent.mkdir(exist_ok=True)
        file.write_text(f"# {file.name}\n")
        digests.append(code_files.digest_code())
    stage, both, with_laboratory = digests
    assert stage != both and both == with_laboratory


def test_the_release_is_the_same_wherever_it_is_stated():
    root = SCRIPTS.parent
    citation = yaml.safe_load((root / "CITATION.cff").read_text(encoding="utf-8"))
    _, *releases = re.findall(r"^## (\S+)", (root / "CHANGELOG.md").read_text("utf-8"), re.M)
    assert citation["version"] == releases[0] == scanplan.__version__
    assert code_files.state_version().startswith(f"scanplan {scanplan.__version__}, code ")


def test_a_release_is_told_in_few_lines():
    changes = (SCRIPTS.parent / "CHANGELOG.md").read_text(encoding="utf-8")
    assert all(part.count("\n") <= 40 for part in changes.split("\n## "))
