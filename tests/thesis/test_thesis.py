"""The thesis's experiments as a target: what it would run, and the page of two small rooms."""

import re
import subprocess
import sys

import pytest

from helpers.project_copy import Project
from thesis.shown_figures import FIGURES

pytestmark = pytest.mark.workflow
TINY_THESIS = "tests/data/tiny_thesis.yaml"


@pytest.fixture(scope="module")
def project(project_root, tmp_path_factory):
    return Project(project_root, tmp_path_factory.mktemp("thesis"))


def jobs(project, *arguments):
    """Number of jobs by rule that a run would execute."""
    result = project.run("--dry-run", *arguments)
    assert result.returncode == 0, result.stderr
    counts = re.findall(r"^(\w+) +(\d+)$", result.stdout + result.stderr, re.M)
    return {rule: int(count) for rule, count in counts}


def test_it_runs_every_survey_with_every_seed_and_nothing_of_the_demo(project):
    found = jobs(project, "thesis", "--configfile", "config/config.yaml")
    # 5 surveys of the rooms and 3 drives, the first of these also with the thesis's limits
    assert found["simulate_survey"] == 8 and found["register_scans"] == 9
    assert found["evaluate_walls"] == found["time_stages"] == 8 and found["measure_coverage"] == 5
    assert found["measure_unevenness"] == found["measure_premises"] == 5
    assert found["judge_claims"] == found["write_thesis"] == found["thesis"] == 1
    assert not {"all", "assemble_plan", "export_plan"} & set(found)


def listed(project, *arguments):
    """Names of the rules that a workflow lists."""
    result = project.run("--list", *arguments)
    assert result.returncode == 0, result.stderr
    return {line.split()[0] for line in result.stdout.splitlines()}


def test_the_product_lists_what_a_user_may_ask_for_and_nothing_of_it(project):
    product, all_rules = listed(project), listed(project, "comparison")
    stages = {path.stem for path in (project.folder / "scripts/thesis/stages").glob("*.py")}
    assert {"all", "floors", "assemble_plan", "write_report"} <= product and len(product) <= 25
    assert not stages & product
    added = {"thesis", "thesis_more", "comparison", "write_comparison", "extract_walls"}
    added |= {"build_hulls", "build_visibility"}
    assert all_rules == product | stages | added


def test_an_ordering_that_a_plan_asks_for_brings_its_stages(project):
    file = project.folder / "other.yaml"
    usual = listed(project)
    for changed, stage in (
        ("plan: {method: hull}", "build_hulls"),
        ("plan: {method: visibility}", "build_visibility"),
        ("selection: {stop: {min_gain_m2: 1.0}}", "build_hulls"),
    ):
        file.write_text(changed)
        assert stage in listed(project, "--configfile", "other.yaml") - usual, changed


def test_the_demo_runs_nothing_of_it(project):
    assert not {"thesis", "judge_claims", "time_stages"} & set(jobs(project))


WITHOUT_CORES = """
import sys
from pathlib import Path
from snakemake.api import SnakemakeApi
from snakemake.settings.types import ConfigSettings, ResourceSettings

with SnakemakeApi() as api:
    given = ConfigSettings(configfiles=[Path("tests/data/tiny.yaml")])
    nodes = ResourceSettings(nodes=2)
    run = api.workflow(nodes, config_settings=given, snakefile=Path(sys.argv[1]))
    print("parsed", len(list(run._workflow.rules)))
"""


@pytest.mark.parametrize("snakefile", ["Snakefile", "workflow/thesis/Snakefile"])
def test_it_is_parsed_where_jobs_go_elsewhere_and_no_cores_are_given(project, snakefile):
    command = [sys.executable, "-c", WITHOUT_CORES, snakefile]
    result = subprocess.run(
        command, cwd=project.folder, env=project.env(), capture_output=True, text=True
    )
    assert result.returncode == 0 and "parsed" in result.stdout, result.stderr


def test_the_page_has_every_figure(project):
    result = project.run("thesis", "thesis_more", "--configfile", TINY_THESIS)
    assert result.returncode == 0, result.stdout + result.stderr
    page = (project.folder / "results/thesis/report.html").read_text()
    for figure in FIGURES:
        assert f"<h3>Figure {figure.number}</h3>" in page
    assert page.count("<svg") == len(FIGURES) + 3
    assert re.search(r"Of \d+ claims \d+ hold, \d+ do not", page)
    assert '<h2 id="deviations">' in page
    assert jobs(project, "thesis", "thesis_more", "--configfile", TINY_THESIS) == {}
    assert "report:  results/thesis/report.html" in result.stderr
    assert "report:  results/thesis/more.html" in result.stderr
    assert (project.folder / "results/thesis/more.html").read_text().count("<svg") == 9
    # another seed is no reason to time or measure those again that there are
    settings = (project.folder / TINY_THESIS).read_text()
    (project.folder / "more.yaml").write_text(
        re.sub(r"(?m)^  seeds: .*", "  seeds: [1, 2]", settings)
    )
    more = jobs(project, "thesis", "--configfile", "more.yaml")
    assert more["time_stages"] == more["measure_coverage"] == more["simulate_survey"] == 1
    assert more["measure_unevenness"] == more["measure_premises"] == 1
