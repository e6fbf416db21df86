"""A stage that a plan does without spoils nothing where it fails, and is tried again."""

import itertools

import pytest

from helpers.project_copy import Project

pytestmark = pytest.mark.workflow

RESULTS = {
    *("plan/plan.geojson", "plan/plan.pdf", "plan/plan.dxf", "plan/plan.ifc"),
    *("plan/next_visit.geojson", "figures/validation.svg", "figures/walls.svg"),
    *("crispness.parquet", "plan/confidence.parquet", "report.html", "summary.txt"),
}
RAISES = "raise RuntimeError('on purpose')"
# as the system ends one where memory is not enough
IS_KILLED = "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"


@pytest.fixture(scope="module")
def project(planned, tmp_path_factory):
    project = Project(planned, tmp_path_factory.mktemp("optional"), made=True)
    project.right = project.digests()
    return project


@pytest.mark.parametrize(
    ("stage", "does", "lacking"),
    [
        ("measure_crispness", RAISES, {"crispness.parquet"}),
        ("validate_plan", RAISES, {"plan/confidence.parquet", "plan/next_visit.geojson"}),
        ("plan_next_visit", IS_KILLED, {"plan/next_visit.geojson"}),
        ("export_files", RAISES, {"plan/plan.ifc"}),
    ],
)
def test_all_else_is_made_where_a_stage_fails(project, stage, does, lacking):
    script = project.folder / f"scripts/{stage}.py"
    whole = script.read_text()
    begins = "with log.log_to_file(snakemake.log[0]):\n"
    script.write_text(whole.replace(begins, f"{begins}        {does}\n"))
    runs = [project.run(), project.run()]
    script.write_text(whole)
    # whatever else is there already
    assert [run.stderr.count(f"scanplan: {stage}: ") for run in runs] == [1, 1]
    run = runs[1]
    told = [line for line in run.stderr.splitlines() if line.startswith("scanplan: ")]
    assert run.returncode == 1 and "Traceback" not in run.stderr + run.stdout
    assert len(told) == 1 and told[0].startswith(f"scanplan: {stage}: "), run.stderr
    assert run.stderr.splitlines()[-1] == told[0] and "tries it again" in told[0]
    here = {name for name in RESULTS if (project.folder / "results/demo" / name).exists()}
    assert here == RESULTS - lacking
    report = (project.folder / "results/demo/report.html").read_text()
    assert ("failed" in report) == bool(lacking & {"plan/next_visit.geojson"})


def test_what_was_lacking_is_made_by_the_same_command(project):
    again = project.run()
    assert again.returncode == 0, again.stderr
    made, right = project.digests(), project.right
    assert made.keys() == right.keys()
    # a title block names the code, which a spoilt script was a part of when the sheet was drawn
    sheets = itertools.product(("plan", "presentation"), ("svg", "pdf", "dxf", "png"))
    drawn = {f"results/demo/plan/{sheet}.{kind}" for sheet, kind in sheets}
    drawn.add("results/demo/plan/presentation_a3.pdf")
    assert {name for name in made if made[name] != right[name]} <= drawn
