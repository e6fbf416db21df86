"""The whole workflow on the tiny office: complete, idle, changed, edited, killed and resumed."""

import os
import re
import shutil
import signal
import subprocess
import time

import pytest

from helpers.project_copy import TINY, Project

# the tests share one run, which each leaves as it was
pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]


@pytest.fixture(scope="module")
def project(project_root, tmp_path_factory):
    project = Project(project_root, tmp_path_factory.mktemp("work space"))
    result = project.run()
    assert result.returncode == 0, result.stdout + result.stderr
    project.output = result.stdout + result.stderr
    return project


EVALUATED = {"evaluate_walls", "draw_evaluation", "tabulate_seconds"}
PLANNED = {"assemble_plan", "export_plan", "draw_walls", "evaluate_plan"}
AFTER_ORDERS = {"order_scans", "draw_scans", "draw_area"} | PLANNED | EVALUATED
AFTER_HULLS = {"build_hulls"} | AFTER_ORDERS


def test_every_result_is_there_and_the_user_is_told(project):
    made = set(project.digests())
    for name in (
        "poses.parquet",
        "scans.parquet",
        *(f"plan/plan.{suffix}" for suffix in ("geojson", "dxf", "svg", "pdf", "ifc")),
        "plan/map.yaml",
        "figures/walls.svg",
        "evaluation/walls.parquet",
    ):
        assert f"results/demo/{name}" in made
    assert (project.folder / "results/demo/report.html").stat().st_size > 100_000
    assert (
        "results/demo/plan/plan.svg" in project.output
        and "results/demo/report.html" in project.output
    )
    assert "register_scans:" in project.output and not [p for p in made if ".part" in p]


def test_a_second_run_does_nothing(project):
    before = project.digests()
    result = project.run()
    assert result.returncode == 0 and "Nothing to be done" in result.stderr
    assert project.would_run() == set() and project.digests() == before


def test_a_touched_file_reruns_nothing(project):
    os.utime(project.folder / "scripts/scanplan/selection/hulls.py")
    assert project.would_run() == set()


@pytest.mark.parametrize(
    ("change", "rules"),
    [
        ("hulls: {n_clusters: 7}", AFTER_HULLS),
        ("plan: {merge: {tolerance_m: 0.08}}", PLANNED),
        ("plan: {method: sequential}", PLANNED | {"draw_scans", "draw_evaluation"}),
        ("evaluation: {bitmap_cell_m: 0.1}", EVALUATED | {"evaluate_plan"}),
        (
            "advanced: {selection: {wall_length: {cell_m: 0.5}}}",
            {"observe_walls"} | AFTER_ORDERS,
        ),
        (
            "advanced: {selection: {visibility: {range_m: 9.0}}}",
            {"build_visibility", "order_scans", "draw_area"} | EVALUATED,
        ),
        ("selection: {min_overlap: 0.1}", AFTER_ORDERS),
        (
            "walls: {min_length_m: 0.7}",
            {"extract_walls"} | PLANNED | EVALUATED,
        ),
    ],
)
def test_a_changed_parameter_reruns_exactly_its_stages(project, change, rules):
    other = project.folder / "change.yaml"
    other.write_text(change)
    # the report states all settings
    assert project.would_run("--configfile", TINY, str(other)) == rules | {"write_report"}


@pytest.mark.parametrize(
    ("change", "methods"),
    [
        ("advanced: {selection: {streaming: {k: 7}}}", {"streaming"}),
        ("selection: {min_overlap: 0.1}", {"wall_length", "visibility", "cluster_hull", "hull"}),
    ],
)
def test_a_setting_of_one_order_reruns_no_other(project, change, methods):
    other = project.folder / "change.yaml"
    other.write_text(change)
    listing = project.run("--dry-run", "--quiet", "reason", "--configfile", TINY, str(other)).stdout
    ordered = re.findall(r"output: results/demo/selection/(\w+)\.parquet", listing)
    assert sorted(ordered) == sorted(methods)


@pytest.mark.parametrize(
    ("helper", "rules"),
    [
        ("selection/hulls", AFTER_HULLS),
        ("exports/dxf", {"export_plan"}),
        ("lab/evaluation/length_metrics", EVALUATED | {"evaluate_plan"}),
        ("lab/evaluation/pose_errors", {"evaluate_poses", "evaluate_plan"} | EVALUATED),
        ("plan/faces/merging", PLANNED),
        ("report/plan_svg", set()),
    ],
)
def test_an_edited_helper_reruns_exactly_the_stages_that_import_it(project, helper, rules):
    path = project.folder / f"scripts/scanplan/{helper}.py"
    source = path.read_text()
    path.write_text(source + "\n# an edit\n")
    try:
        assert project.would_run() == rules | {"write_report"}
    finally:
        path.write_text(source)


def test_a_truth_beside_the_recording_switches_evaluation_on(project):
    house = project.folder / "house"
    shutil.copytree(project.folder / "results/demo/survey", house)
    both = {"evaluate_walls", "evaluate_poses", "draw_evaluation", "tabulate_seconds"}
    assert both <= project.would_run("--config", "dataset=house")
    (house / "truth_poses.tum").unlink()
    assert not both & project.would_run("--config", "dataset=house")


def test_a_file_is_a_simulated_dataset_beside_recorded_ones(project):
    (project.folder / "toy.yaml").write_text("simulate: {building: tiny_office}")
    (project.folder / "other.yaml").write_text("simulate: {building: tiny_office, recording: mcap}")
    house = project.folder / "recorded"
    house.mkdir()
    shutil.copy2(project.folder / "results/demo/survey/survey.bag", house)
    listed = project.run(
        "--dry-run", "--quiet", "reason", "--config", "dataset=[toy.yaml, recorded, other.yaml]"
    ).stdout
    assert (
        "output: results/toy/survey/survey.bag" in listed
        and "output: results/other/survey/survey.mcap" in listed
    )
    assert "results/recorded/plan/plan.svg" in listed and "results/recorded/survey" not in listed
    assert (
        "results/toy/evaluation/walls.parquet" in listed
        and "results/recorded/evaluation" not in listed
    )


def test_a_deleted_report_is_made_again(project):
    report = project.folder / "results/demo/report.html"
    report.unlink()
    assert project.would_run() == {"write_report"}
    assert project.run().returncode == 0 and report.stat().st_size > 100_000


def test_one_stage_can_be_rerun(project):
    before = project.digests()
    (project.folder / "results/demo/hulls.parquet").unlink()
    assert project.run("results/demo/hulls.parquet").returncode == 0
    assert project.digests() == before


def test_one_core_gives_the_same_bytes(project):
    before = project.digests()
    result = project.run("--cores", "1", "--forcerun", "build_hulls", "extract_walls")
    assert result.returncode == 0 and project.digests() == before


def restore_sigint():
    signal.signal(signal.SIGINT, signal.default_int_handler)


def started(project, *targets):
    """Start a run that registers the scans anew, and return it once that stage is at work."""
    log = project.folder / "logs/demo/register_scans.log"
    log.unlink()
    with (project.folder / "said.txt").open("w") as said:
        run = subprocess.Popen(
            project.command(*targets, "--forcerun", "register_scans"),
            cwd=project.folder,
            env=project.env(),
            stdout=subprocess.DEVNULL,
            stderr=said,
            start_new_session=True,
            # whoever runs the tests in the background may ignore SIGINT, and children inherit that
            preexec_fn=restore_sigint,
        )
    while not log.exists():
        assert run.poll() is None, "the run ended before the stage began"
        time.sleep(0.02)
    return run


# later stages see of a resumed one only its files, so one way to be killed has them all run
SCANS = ("results/demo/scans.parquet",)


@pytest.mark.parametrize(
    ("sent", "targets"), [(signal.SIGKILL, ()), (signal.SIGINT, SCANS), (signal.SIGTERM, SCANS)]
)
def test_a_killed_run_resumes_with_the_same_command(project, sent, targets):
    before = project.digests()
    run = started(project, *targets)
    os.kill(run.pid, sent) if sent == signal.SIGKILL else os.killpg(run.pid, sent)
    assert run.wait(timeout=120) != 0
    if sent != signal.SIGKILL:
        last = (project.folder / "said.txt").read_text().splitlines()[-1]
        assert last == "scanplan: the run was interrupted; the same command goes on from here"
    result = project.run(*targets)
    assert result.returncode == 0, result.stderr
    assert project.digests() == before


def test_two_runs_at_once_do_not_mix(project):
    before = project.digests()
    first = started(project)
    second = project.run("--forcerun", "build_hulls")
    assert first.wait(timeout=120) == 0
    assert second.returncode != 0 and "another run is at work" in second.stdout + second.stderr
    assert project.digests() == before
