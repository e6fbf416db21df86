"""The whole workflow on the tiny office: complete, idle, changed, edited, killed and resumed."""

import os
import re
import shutil
import signal
import subprocess
import time

import pytest

from assemble_plan import assemble_plan
from helpers.default_settings import SETTINGS
from helpers.project_copy import TINY, Project
from scanplan.plan import planning
from scanplan.project import stage_settings

# the tests share one run, which each leaves as it was
pytestmark = pytest.mark.workflow


@pytest.fixture(scope="module")
def project(planned, tmp_path_factory):
    project = Project(planned, tmp_path_factory.mktemp("work space"), made=True)
    project.plan_alone = project.digests()
    compared = project.run("comparison", cores=2)
    assert compared.returncode == 0, compared.stdout + compared.stderr
    project.said = {"plan": (planned / "said.txt").read_text(), "comparison": compared.stderr}
    assert compared.stdout == ""
    return project


PLANNED = {
    *("assemble_plan", "validate_plan", "plan_next_visit"),
    *("export_plan", "export_presentation", "export_files"),
    *("draw_figures", "evaluate_plan"),
}
CHOSEN = {"extract_chosen_walls"} | PLANNED
EVALUATED = {"evaluate_walls", "draw_evaluation", "tabulate_seconds"}
AFTER_ORDERS = {"order_scans", "draw_area"} | CHOSEN | EVALUATED
AFTER_HULLS = {"build_hulls", "order_scans", "draw_area"} | EVALUATED
REPORTS = {"write_report", "write_comparison"}


def test_the_plan_and_its_report_are_there_and_the_user_is_told(project):
    made = set(project.plan_alone)
    for name in (
        "poses.parquet",
        "scans.parquet",
        *(f"plan/plan.{suffix}" for suffix in ("geojson", "dxf", "svg", "pdf", "ifc", "gpkg")),
        "plan/rooms.csv",
        "trajectory.tum",
        "plan/map.yaml",
        "figures/walls.svg",
        "evaluation/plan.parquet",
    ):
        assert f"results/demo/{name}" in made
    assert not [p for p in made if ".part" in p]
    assert not [p for p in made if "/walls/" in p or "comparison" in p]
    assert [p for p in made if "/selection/" in p] == ["results/demo/selection/wall_length.parquet"]
    said = project.said["plan"]
    assert "results/demo/plan/plan.pdf" in said and "results/demo/report.html" in said
    assert re.search(r"of\s+floor", said) and "doubtful" in said and "took" in said
    stages = re.findall(r"^ *(\d+)/(\d+) demo (\w+)", said, re.M)
    assert [int(done) for done, _, _ in stages] == list(range(1, len(stages) + 1))
    assert {total for _, total, _ in stages} == {str(len(stages))}
    assert len(said.splitlines()) <= 40 and "\x1b" not in said


def test_the_comparison_leaves_the_plan_as_it_is(project):
    made = project.digests()
    assert {name: made[name] for name in project.plan_alone} == project.plan_alone
    assert "results/demo/evaluation/walls.parquet" in made
    assert "results/demo/comparison.html" in project.said["comparison"]
    pages = [(project.folder / f"results/demo/{n}.html").read_text() for n in PAGES]
    assert ['id="figure-area"' in page for page in pages] == [False, True]
    assert all('id="figure-walls"' in page for page in pages)


PAGES = ("report", "comparison")


def test_the_plan_of_chosen_walls_is_that_of_all_walls(project, tmp_path):
    """Byte for byte, all tables of the plan; poses beside them say what all were made of."""
    results = project.folder / "results/demo"
    (tmp_path / "poses.parquet").symlink_to(results / "poses.parquet")
    outputs = {name: tmp_path / f"{name}.parquet" for name in planning.TABLES}
    assemble_plan(
        results / f"walls/{SETTINGS['plan']['extractor']}.parquet",
        results / f"selection/{SETTINGS['plan']['method']}.parquet",
        results / "scans.parquet",
        results / "registration.parquet",
        outputs,
        settings=stage_settings.select_plan(SETTINGS),
        **stage_settings.select_section(SETTINGS, "selection", "stop"),
    )
    for name, path in outputs.items():
        assert path.read_bytes() == (results / f"plan/{name}.parquet").read_bytes()


def test_a_second_run_does_nothing_and_says_where_the_results_are(project):
    before = project.digests()
    result = project.run()
    assert result.returncode == 0 and "Nothing to be done" in result.stderr
    assert "results/demo/report.html, results/demo/comparison.html" in result.stderr
    assert project.would_run("comparison") == set() and project.digests() == before


def test_a_touched_file_reruns_nothing(project):
    os.utime(project.folder / "scripts/scanplan/selection/hulls.py")
    assert project.would_run("comparison") == set()


@pytest.mark.parametrize(
    ("change", "rules"),
    [
        ("hulls: {n_clusters: 7}", AFTER_HULLS),
        ("plan: {merge: {tolerance_m: 0.08}}", PLANNED),
        ("plan: {method: sequential}", CHOSEN | {"draw_evaluation"}),
        ("selection: {stop: {n_scans: 3}}", CHOSEN),
        ("plan: {export: {formats: [ifc, laz]}}", {"export_cloud", "export_files"}),
        ("plan: {export: {formats: []}}", set()),
        (
            "plan: {export: {author: A. Surveyor}}",
            {"export_files", "export_plan", "export_presentation"},
        ),
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
            {"extract_walls", "extract_chosen_walls"} | PLANNED | EVALUATED,
        ),
    ],
)
def test_a_changed_parameter_reruns_exactly_its_stages(project, change, rules):
    other = project.folder / "change.yaml"
    other.write_text(change)
    # the reports state all settings
    assert project.would_run("comparison", "--configfile", TINY, str(other)) == rules | REPORTS


def test_what_only_the_comparison_reads_reruns_nothing_of_the_plan(project):
    other = project.folder / "change.yaml"
    other.write_text("advanced: {selection: {visibility: {range_m: 9.0}}}")
    assert project.would_run("--configfile", TINY, str(other)) == {"write_report"}


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
    wanted = ("comparison", "--dry-run", "--quiet", "reason", "--configfile", TINY, str(other))
    listing = project.run(*wanted).stdout
    ordered = re.findall(r"output: results/demo/selection/(\w+)\.parquet", listing)
    assert sorted(ordered) == sorted(methods)


@pytest.mark.parametrize(
    ("helper", "rules"),
    [
        ("selection/hulls", {"build_hulls"} | AFTER_ORDERS),
        ("exports/dxf", {"export_plan", "export_presentation"}),
        ("exports/data/mesh", {"export_files"}),
        ("lab/evaluation/length_metrics", EVALUATED | {"evaluate_plan"}),
        ("lab/evaluation/pose_errors", {"evaluate_poses", "evaluate_plan"} | EVALUATED),
        ("plan/faces/merging", PLANNED),
        ("report/plan_view/plan_svg", set()),
    ],
)
def test_an_edited_helper_reruns_exactly_the_stages_that_import_it(project, helper, rules):
    path = project.folder / f"scripts/scanplan/{helper}.py"
    source = path.read_text()
    path.write_text(source + "\n# an edit\n")
    try:
        assert project.would_run("comparison") == rules | REPORTS
    finally:
        path.write_text(source)


def test_a_truth_beside_the_recording_switches_evaluation_on(project):
    house = project.folder / "house"
    shutil.copytree(project.folder / "results/demo/survey", house)
    both = {"evaluate_poses", "evaluate_plan"} | EVALUATED
    assert both <= project.would_run("comparison", "--config", "dataset=house")
    (house / "truth_poses.tum").unlink()
    assert not both & project.would_run("comparison", "--config", "dataset=house")


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
        "results/toy/evaluation/plan.parquet" in listed
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
    # stages after these work with one core whatever there is
    wanted = [f"results/demo/{table}.parquet" for table in ("hulls", "plan/walls")]
    result = project.run(*wanted, "--forcerun", "build_hulls", "extract_chosen_walls", cores=1)
    assert result.returncode == 0 and project.digests() == before


def restore_sigint():
    signal.signal(signal.SIGINT, signal.default_int_handler)


def started(project, log, *arguments):
    """Start a run, and return it once the stage with this log is at work."""
    with (project.folder / "said.txt").open("w") as said:
        run = subprocess.Popen(
            project.command(*arguments, cores=2),
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


def registering(project, *targets):
    """Start a run that registers the scans anew, and return it once that stage is at work."""
    log = project.folder / "logs/demo/register_scans.log"
    log.unlink()
    return started(project, log, *targets, "--forcerun", "register_scans")


# later stages see of a resumed one only its files, so one way to be killed has them all run
SCANS = ("results/demo/scans.parquet",)


@pytest.mark.parametrize(
    ("sent", "targets"), [(signal.SIGKILL, ()), (signal.SIGINT, SCANS), (signal.SIGTERM, SCANS)]
)
def test_a_killed_run_resumes_with_the_same_command(project, sent, targets):
    before = project.digests()
    run = registering(project, *targets)
    os.kill(run.pid, sent) if sent == signal.SIGKILL else os.killpg(run.pid, sent)
    status = run.wait(timeout=120)
    assert status == (-sent if sent == signal.SIGKILL else 128 + sent)
    if sent != signal.SIGKILL:
        last = (project.folder / "said.txt").read_text().splitlines()[-1]
        assert last == "scanplan: the run was interrupted; the same command goes on from here"
    result = project.run(*targets)
    assert result.returncode == 0, result.stderr
    assert project.digests() == before


def test_two_runs_at_once_do_not_mix(project):
    before = project.digests()
    first = registering(project, *SCANS)
    # however long the second takes to begin, the first is at work by then
    os.killpg(first.pid, signal.SIGSTOP)
    try:
        second = project.run("--forcerun", "build_hulls")
    finally:
        os.killpg(first.pid, signal.SIGCONT)
    assert first.wait(timeout=120) == 0
    assert second.returncode != 0 and "another run is at work" in second.stdout + second.stderr
    assert project.digests() == before


def test_stages_in_chunks_killed_and_resumed_give_the_bytes_of_one_job(project):
    survey = project.folder / "long"
    survey.mkdir()
    shutil.copy2(project.folder / "results/demo/survey/survey.bag", survey)
    half_gb = (survey / "survey.bag").stat().st_size / 2.5e9
    (survey / "dataset.yaml").write_text(f"advanced: {{jobs: {{chunk_gb: {half_gb}}}}}")
    registered = ("scans", "registration", "edges")
    tables = (*registered, "observations", "visibility", "hulls", "walls/cluster_ransac")
    wanted = [f"results/long/{table}.parquet" for table in tables]
    given = (*wanted, "--config", "dataset=long")
    try:
        stages = {"observe_walls_chunk", "build_visibility_chunk", "build_hulls_chunk"}
        gathering = {"extract_walls_chunk", "gather_chunks", "gather_wall_chunks"}
        registering = {"register_scans_chunk", "gather_scan_chunks"}
        planned = project.would_run(*given)
        assert stages | gathering | registering < planned and "register_scans" not in planned
        run = started(project, project.folder / "logs/long/observe_walls_2-of-2.log", *given)
        run.kill()
        run.wait()
        made = project.run(*given)
        assert made.returncode == 0, made.stderr
        results = project.folder / "results"
        for table in tables:
            gathered = (results / f"long/{table}.parquet").read_bytes()
            assert gathered == (results / f"demo/{table}.parquet").read_bytes()
        assert not list(results.rglob("*-of-2*"))
        assert not project.would_run(*given)
    finally:
        shutil.rmtree(project.folder / "results/long", ignore_errors=True)
