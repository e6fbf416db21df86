"""What changed is found, and its tests with it."""

import subprocess

import pytest

import changed_tests

FILES = {
    "scripts/scanplan/geometry/lines.py": "",
    "scripts/scanplan/plan/walls.py": "from scanplan.geometry import lines\n",
    "scripts/scanplan/plan/corners.py": "from scanplan.geometry.lines import Line\n",
    "scripts/scanplan/plan/joints.py": "from scanplan.plan import corners\n",
    "scripts/scanplan/plan/unused.py": "",
    "scripts/order_scans.py": "from scanplan.plan import joints, walls\n",
    "tests/helpers/made.py": "from scanplan.geometry.lines import Line\n",
    "tests/unit/test_house.py": "",
    "tests/unit/test_lines.py": "from helpers import made\n",
    "tests/unit/test_settings.py": "",
    "tests/unit/test_walls.py": "from scanplan.plan import walls\n",
    "tests/stages/test_order_scans.py": "from order_scans import order_scans\n",
    "scripts/thesis/stages/judge_claims.py": "from thesis import judging\n",
    "tests/thesis/test_claims.py": "from thesis.stages.judge_claims import judge_claims\n",
}


@pytest.fixture
def project(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


@pytest.mark.parametrize(
    ("changed", "tests"),
    [
        ("scripts/scanplan/geometry/lines.py", ["unit/test_lines"]),
        ("scripts/scanplan/plan/walls.py", ["unit/test_walls"]),
        # two imports away, and nowhere
        ("scripts/scanplan/plan/corners.py", ["stages/test_order_scans"]),
        ("scripts/scanplan/plan/unused.py", []),
        ("scripts/order_scans.py", ["stages/test_order_scans"]),
        ("scripts/thesis/stages/judge_claims.py", ["thesis/test_claims"]),
        ("tests/helpers/made.py", ["unit/test_lines"]),
        ("tests/unit/test_walls.py", ["unit/test_walls"]),
        ("config/config.yaml", ["unit/test_settings"]),
        ("README.md", []),
    ],
)
def test_a_changed_file_has_the_tests_that_import_it(project, changed, tests):
    expected = sorted(["tests/unit/test_house.py", *(f"tests/{test}.py" for test in tests)])
    assert changed_tests.list_tests([changed], project) == expected


def test_types_are_checked_of_stages_and_helpers_only():
    files = ["scripts/a.py", "scripts/scanplan/b.py", "tests/unit/test_c.py", "config/d.yaml"]
    assert changed_tests.list_typed(files) == ["scripts/a.py", "scripts/scanplan/b.py"]


def git(folder, *words):
    who = ("-c", "user.name=somebody", "-c", "user.email=somebody@example.org")
    subprocess.run(["git", "-C", folder, *who, *words], check=True, capture_output=True)


def test_changes_are_those_since_main(project):
    git(project, "init", "--quiet", "--initial-branch=main")
    git(project, "add", ".")
    git(project, "commit", "--quiet", "--message=first")
    (project / "scripts/order_scans.py").write_text("# uncommitted\n")
    assert changed_tests.list_changed(project) == ["scripts/order_scans.py"]
    git(project, "switch", "--quiet", "--create", "branch")
    git(project, "commit", "--quiet", "--all", "--message=second")
    (project / "tests/unit/test_new.py").write_text("")
    (project / "scripts/scanplan/plan/walls.py").unlink()
    expected = ["scripts/order_scans.py", "tests/unit/test_new.py"]
    assert changed_tests.list_changed(project) == expected


def test_what_all_tests_use_from_afar_is_left_to_the_whole_run(project, monkeypatch):
    monkeypatch.setattr(changed_tests, "MOST_NEAREST", 0)
    assert changed_tests.list_tests(["scripts/scanplan/plan/corners.py"], project) == [
        "tests/unit/test_house.py"
    ]
    assert "tests/unit/test_walls.py" in changed_tests.list_tests(
        ["scripts/scanplan/plan/walls.py"], project
    )
