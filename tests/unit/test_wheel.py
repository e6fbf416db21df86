"""The wheel: what it carries, what it asks for, and what works without the rest."""

import ast
import email
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from importlib.metadata import packages_distributions
from itertools import takewhile
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from helpers.default_settings import SCHEMA
from scanplan.errors import EXTRAS
from scanplan.project import export_formats
from scanplan.project.code_files import state_version
from scanplan.project.run.command import SNAKEFILE
from scanplan.project.settings import read_defaults

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
ASKED = [*map(Requirement, PROJECT["dependencies"])]
BESIDE = {
    extra: [*map(Requirement, words)] for extra, words in PROJECT["optional-dependencies"].items()
}
OF_EXTRAS = {
    "simulate_survey": "simulate",
    **dict.fromkeys(("assemble_building", "annotate_design", "annotate_changes"), "ifc"),
}
"""Stages that are nothing without the library of an extra."""


def pins():
    """Return the version of every package that the files of the environments pin."""
    files = ("environment.lock", "environment-kiss-icp.lock")
    text = "\n".join((ROOT / file).read_text("utf-8") for file in files)
    return dict(re.findall(r"(?m)^([\w-]+)==(\S+)", text))


def list_sources():
    """Return what the workflow consists of, as in a checkout without anything that was made."""
    folders = ("config", "scripts", "workflow")
    found = [path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file()]
    named = [path.relative_to(ROOT) for path in found if path.suffix not in (".md", ".pyc")]
    return {path.as_posix() for path in named if path.parent.name != "envs"}


@pytest.fixture(scope="session")
def wheel(tmp_path_factory):
    """Build the wheel from a copy, by what the environment has and no network."""
    folder = tmp_path_factory.mktemp("wheel")
    for name in ("config", "scripts", "workflow"):
        shutil.copytree(ROOT / name, folder / name)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, folder)
    # what others have left in a checkout
    (folder / "workflow/envs/scanplan.sif").touch()
    pip = [sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index"]
    subprocess.run([*pip, "-qq", "-w", folder, folder], check=True, cwd=folder)
    return next(folder.glob("*.whl"))


def test_the_wheel_carries_the_whole_workflow_and_nothing_else(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    ours = {name.removeprefix("scanplan_project/") for name in names if "dist-info" not in name}
    assert ours == list_sources() | {"scanplan/__init__.py", "LICENSE"}


def test_the_wheel_states_its_command_its_release_and_what_it_asks_for(wheel):
    content = zipfile.ZipFile(wheel)
    (folder,) = {name.split("/")[0] for name in content.namelist() if ".dist-info/" in name}
    stated = email.message_from_bytes(content.read(f"{folder}/METADATA"))
    assert f"scanplan {stated['Version']}, code " in state_version()
    assert stated["Requires-Python"] == "<3.14,>=3.11"
    assert set(stated.get_all("Provides-Extra")) == set(EXTRAS.values())
    commands = content.read(f"{folder}/entry_points.txt").decode()
    assert "scanplan = scanplan.project.run.command:main" in commands


def test_an_installed_package_is_the_code_of_this_checkout(wheel, tmp_path):
    zipfile.ZipFile(wheel).extractall(tmp_path)
    code = "import scanplan; from scanplan.project.run import command\n"
    code += "print(scanplan.__file__, command.SNAKEFILE, command.state_version(), sep='\\n')"
    told = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    project = tmp_path / "scanplan_project"
    assert told.stdout.splitlines() == [
        str(project / "scripts/scanplan/__init__.py"),
        str(project / SNAKEFILE.relative_to(ROOT)),
        state_version(),
    ]


def test_what_is_asked_for_allows_what_the_environments_pin():
    pinned = pins()
    here = {"sys_platform": "linux", "platform_machine": "x86_64"}
    for asked in (*ASKED, *(one for some in BESIDE.values() for one in some)):
        is_of_lock = asked.name != PROJECT["name"] and (
            asked.marker is None or asked.marker.evaluate(here)
        )
        if is_of_lock:
            assert asked.specifier.contains(pinned[asked.name.replace(".", "-")]), asked


def imports_of(path):
    """Return the packages that a file imports, at once or later, but for Python's own."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            found.add(node.module or "")
    return {name.partition(".")[0] for name in found} - sys.stdlib_module_names


def test_all_that_is_imported_is_asked_for():
    made_of = packages_distributions()
    asked = {canonicalize_name(asked.name) for asked in ASKED}
    beside = {canonicalize_name(r.name): extra for extra, all_of in BESIDE.items() for r in all_of}
    ours = {"scanplan", "thesis", "sitecustomize", "_typeshed"}
    for path in SCRIPTS.rglob("*.py"):
        for name in imports_of(path) - ours:
            packages = {canonicalize_name(package) for package in made_of.get(name, (name,))}
            assert packages & asked or name in EXTRAS, f"{path}: {name}"
    for library, extra in EXTRAS.items():
        for package in made_of.get(library, ()):
            assert beside[canonicalize_name(package)] == extra


OF_UNIX = {"fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty"}


def test_nothing_is_imported_at_once_that_windows_lacks():
    for path in SCRIPTS.rglob("*.py"):
        for node in ast.parse(path.read_text("utf-8")).body:
            names = [alias.name for alias in getattr(node, "names", [])]
            module = getattr(node, "module", None)
            assert not OF_UNIX & {*names, module}, path


REFUSING = """
import importlib.abc, sys
class Refuse(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition('.')[0] in {lacking}:
            raise ModuleNotFoundError(name, name=name)
sys.meta_path.insert(0, Refuse())
"""
"""Python that is without some libraries."""


def run_without_extras(code):
    begin = REFUSING.format(lacking=sorted(EXTRAS))
    return subprocess.run(
        [sys.executable, "-c", begin + code], cwd=SCRIPTS, capture_output=True, text=True
    )


def test_stages_of_a_plan_begin_without_any_extra():
    stages = sorted(file.stem for file in SCRIPTS.glob("*.py") if file.stem not in OF_EXTRAS)
    assert len(stages) > 20
    done = run_without_extras(f"import {', '.join(stages)}")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("stage", "extra"), OF_EXTRAS.items())
def test_a_stage_that_wants_an_extra_says_in_a_line_which(tmp_path, stage, extra):
    code = f"""
from scanplan.stage import log
with log.log_to_file({str(tmp_path / "stage.log")!r}):
    import {stage}
"""
    done = run_without_extras(code)
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert f"pip install 'scanplan[{extra}]'" in done.stderr


def test_formats_without_their_library_are_left_out_of_the_defaults_and_told(monkeypatch):
    monkeypatch.setattr(export_formats, "find_spec", lambda library: None)
    defaults = read_defaults(ROOT / "config/config.yaml", SCHEMA)
    assert defaults["plan"]["export"]["formats"] == [
        *("glb", "gpkg", "imdf", "csv", "json", "tum", "masks", "bcf", "openplan", "presentation")
    ]
    told = export_formats.tell_lacking()
    files = ("plan/plan.ifc", "plan/presentation.ifc")
    assert [line.partition(": ")[0] for line in told] == [*files]
    assert all("'scanplan[ifc]'" in line for line in told)


@pytest.mark.parametrize("profile", ["default", "slurm"])
def test_a_checkout_runs_its_own_code_where_a_wheel_is_installed(tmp_path, profile):
    (tmp_path / "scanplan").mkdir()
    (tmp_path / "scanplan/__init__.py").write_text("raise SystemExit('the other one')")
    stated = yaml.safe_load((ROOT / f"workflow/profiles/{profile}/config.yaml").read_text("utf-8"))
    begin = "\n".join(
        takewhile(lambda line: "from scanplan" not in line, stated["__definitions__"])
    )
    code = f"{begin}\nimport scanplan, os; print(os.path.abspath(scanplan.__file__))"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert done.stdout.strip() == str(SCRIPTS / "scanplan/__init__.py"), done.stderr
