"""The profile for Slurm, on a Slurm of this machine; `make test-slurm` installs what it needs."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from helpers.project_copy import TINY, Project
from helpers.slurm_node import SlurmNode, missing_commands
from scanplan.project.run import slurm_jobs

pytestmark = pytest.mark.slurm
SEEDS = (1, 2, 3)
PROFILE = ("--workflow-profile", "workflow/profiles/slurm")
POSES = "results/floor_1/poses.parquet"


@pytest.fixture(scope="module")
def node(tmp_path_factory):
    if os.getuid() != 0 or missing_commands():
        pytest.skip("no Slurm here that this user may start: make test-slurm installs one as root")
    node = SlurmNode(tmp_path_factory.mktemp("slurm"))
    node.start()
    yield node
    node.stop()


class Floors(Project):
    """The tiny office with three seeds, in a copy of the project."""

    def __init__(self, root, folder):
        super().__init__(root, folder)
        text = (folder / TINY).read_text()
        for seed in SEEDS:
            of_seed = text.replace("simulate:\n", f"simulate:\n  seed: {seed}\n")
            (folder / f"floor_{seed}.yaml").write_text(of_seed)
        rows = [f"floor_{seed}\tfloor_{seed}.yaml\n" for seed in SEEDS]
        (folder / "floors.tsv").write_text("name\tpath\n" + "".join(rows))

    def command(self, *arguments, profile=PROFILE, dataset="floors.tsv"):
        words = ["--config", f"dataset={dataset}", *profile]
        return [sys.executable, "-m", "snakemake", *words, *arguments]


@pytest.fixture
def floors(project_root, tmp_path, node):
    return Floors(project_root, tmp_path)


def one(floors, *arguments):
    """Run the first stages of one floor, and give what is said beside Snakemake's own words."""
    command = floors.command(*arguments, dataset="floor_1.yaml")
    done = subprocess.run(
        [*command, "--", POSES], cwd=floors.folder, env=floors.env(), capture_output=True, text=True
    )
    told = [line for line in done.stderr.splitlines() if line.startswith("scanplan: ")]
    assert "Traceback" not in done.stdout + done.stderr
    return done.returncode, told


def started(floors):
    """Start the first stages of one floor, and return the run once a job of it is at work."""
    command = floors.command(dataset="floor_1.yaml")
    with (floors.folder / "said.txt").open("w") as said:
        run = subprocess.Popen(
            [*command, "--", POSES],
            cwd=floors.folder,
            env=floors.env(),
            stdout=said,
            stderr=said,
            start_new_session=True,
        )
    while not any(job.state == "RUNNING" for job in slurm_jobs.list_jobs(floors.folder)):
        assert run.poll() is None, (floors.folder / "said.txt").read_text()
        time.sleep(0.2)
    return run


def test_three_floors_are_as_those_of_a_local_run(floors, project_root, tmp_path_factory):
    began_s = time.monotonic()
    made = floors.run()
    assert made.returncode == 0, made.stderr
    jobs = slurm_jobs.list_jobs(floors.folder)
    print(f"{len(jobs)} jobs of Slurm, {time.monotonic() - began_s:.0f} s")
    assert len(jobs) == 2 * len(SEEDS)
    local = Floors(project_root, tmp_path_factory.mktemp("local"))
    command = local.command("--cores", "2", profile=())
    subprocess.run(command, cwd=local.folder, env=local.env(), check=True, capture_output=True)
    assert floors.digests() == local.digests()


def test_jobs_that_outlive_a_killed_run_are_ended_before_they_run_twice(floors):
    run = started(floors)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    code, told = one(floors)
    assert code == 0
    assert told == [line for line in told if "of an earlier run were cancelled" in line] != []
    assert (floors.folder / POSES).exists()


def test_too_little_memory_is_told(floors):
    code, (told,) = one(
        *(floors, "--retries", "0", "--set-resources"),
        *("simulate_survey:mem_mb=60", "interpolate_poses:mem_mb=60"),
    )
    assert code == 1
    assert "ran out of its 60M of memory; raise it with" in told


def test_a_partition_that_is_not_there_is_told(floors):
    given = ("--default-resources", "slurm_partition=nowhere", "mem_mb=500", "runtime=5")
    code, (told,) = one(floors, "--retries", "0", *given)
    assert code == 1
    assert "Invalid partition name" in told


def test_what_a_lost_node_had_is_made_again(floors, node):
    run = started(floors)
    node.command("scontrol", "update", f"nodename={node.host}", "state=down", "reason=test")
    time.sleep(2)
    node.command("scontrol", "update", f"nodename={node.host}", "state=resume")
    assert run.wait() == 0, (floors.folder / "said.txt").read_text()
    assert (floors.folder / POSES).exists()


def test_without_the_plugin_the_profile_says_what_to_install(floors):
    hidden = floors.folder / "hidden"
    hidden.mkdir()
    # as Snakemake looks for its plugins, installed ones too
    hook = (
        "import pkgutil, sys\nsys.modules['snakemake_executor_plugin_slurm'] = None\n"
        "listed = pkgutil.iter_modules\n"
        "pkgutil.iter_modules = lambda *given, **more: (module for module in"
        " listed(*given, **more) if module.name != 'snakemake_executor_plugin_slurm')\n"
    )
    (hidden / "sitecustomize.py").write_text(hook)
    done = subprocess.run(
        floors.command("-n", dataset="floor_1.yaml"),
        cwd=floors.folder,
        env={**floors.env(), "PYTHONPATH": os.fspath(hidden)},
        capture_output=True,
        text=True,
    )
    assert done.returncode != 0
    assert "needs snakemake-executor-plugin-slurm" in done.stderr
    assert "Traceback" not in done.stderr


def test_the_lock_of_the_plugin_is_beside_the_environments(project_root):
    assert Path(project_root, slurm_jobs.LOCK).read_text().count("--hash=sha256:") == 2
