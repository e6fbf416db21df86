"""The workflow as a module of another one."""

import os
import sys
from pathlib import Path

import pytest

from helpers.project_copy import TINY, run_python

pytestmark = pytest.mark.workflow
CALLER = """
module scanplan:
    snakefile:
        "{snakefile}"
{prefix}    config:
        {{"dataset": [{dataset!r}]}}


use rule * from scanplan as floor_*


rule count_poses:
    default_target: True
    input:
        "{folder}results/{name}/{table}",
    output:
        "size.txt",
    shell:
        "wc -c < {{input}} > {{output}}"
"""


def call(
    project_root, folder, *arguments, prefix="", dataset=None, table="poses.parquet", used=None
):
    """Run a workflow that uses ours, from a folder of its own."""
    dataset = dataset or os.fspath(project_root / TINY)
    text = CALLER.format(
        snakefile=project_root / (used or ("workflow/Snakefile" if prefix else "Snakefile")),
        prefix=f'    prefix:\n        "{prefix}"\n' if prefix else "",
        folder=f"{prefix}/" if prefix else "",
        dataset=dataset,
        name=Path(dataset).stem,
        table=table,
    )
    (folder / "Snakefile").write_text(text)
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    command = ["-m", "snakemake", "--cores", "1", *arguments]
    return run_python(folder, command, {**os.environ, "PATH": path})


@pytest.mark.parametrize("prefix", ["", "surveys"])
def test_results_lie_where_the_caller_wants_them(project_root, tmp_path, prefix):
    made = call(project_root, tmp_path, prefix=prefix)
    assert made.returncode == 0, made.stderr
    poses = tmp_path / prefix / "results/tiny/poses.parquet"
    assert int((tmp_path / "size.txt").read_text()) == poses.stat().st_size
    assert (tmp_path / prefix / "benchmarks/tiny/interpolate_poses.tsv").exists()


def test_the_whole_plan_can_be_asked_for(project_root, tmp_path):
    planned = call(project_root, tmp_path, "-n", prefix="surveys", table="report.html")
    assert planned.returncode == 0, planned.stderr
    assert "floor_assemble_plan" in planned.stdout


def test_the_comparison_is_the_laboratorys_to_be_asked_for(project_root, tmp_path):
    laboratory = {"prefix": "surveys", "used": "workflow/thesis/Snakefile"}
    planned = call(project_root, tmp_path, "-n", table="comparison.html", **laboratory)
    assert planned.returncode == 0, planned.stderr
    assert "floor_write_comparison" in planned.stdout
    assert "output: surveys/results/tiny/evaluation/walls.parquet" in planned.stdout
    # nor is its run ours
    refused = call(project_root, tmp_path, "-n", dataset="nowhere", **laboratory)
    assert refused.returncode != 0
    said = refused.stdout + refused.stderr
    assert "WorkflowError" in said and "scanplan: nowhere: does not exist" in said


def test_a_users_files_are_not_moved_by_the_prefix(project_root, tmp_path):
    folder = tmp_path / "recorded"
    folder.mkdir()
    (folder / "drive.bag").write_bytes(b"#ROSBAG V2.0\n")
    planned = call(project_root, tmp_path, "-n", prefix="surveys", dataset="recorded")
    assert planned.returncode == 0, planned.stderr
    assert "input: recorded/drive.bag" in planned.stdout


def test_a_fault_of_its_settings_is_the_callers_to_tell(project_root, tmp_path):
    refused = call(project_root, tmp_path, "-n", dataset="nowhere")
    assert refused.returncode != 0
    assert "scanplan: nowhere: does not exist" in refused.stdout + refused.stderr
    assert "Traceback" not in refused.stdout + refused.stderr
