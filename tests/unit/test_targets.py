"""What is no target is told with what to write instead."""

import re

import pytest

from scanplan.errors import StageError
from scanplan.project.targets import asks_for_laboratory, check_targets

FOLDERS = ["demo", "thesis", "town_hall"]


@pytest.mark.parametrize(
    ("target", "told"),
    [
        ("plan.method=hull", 'write --config \'plan={"method": "hull"}\''),
        ("plan.merge.min_scans=3", '\'plan={"merge": {"min_scans": 3}}\''),
        ("dataset=data/a=b", "write --config dataset=data/a=b"),
        ("results/intel/plan/plan.svg", "no dataset intel is given, only demo; add"),
        ("./results/intel/report.html", "no dataset intel is given"),
    ],
)
def test_faults_are_told_in_one_line(target, told):
    with pytest.raises(StageError, match=re.escape(told)) as caught:
        check_targets(["all", target], ["demo"], FOLDERS)
    assert str(caught.value).startswith(f"{target}: ") and "\n" not in str(caught.value)


def test_a_target_that_would_steer_a_terminal_is_refused():
    with pytest.raises(StageError, match="; rename it"):
        check_targets(["results/\x1b[31m"], ["demo"], FOLDERS)


def test_rules_and_results_are_targets():
    asked = ["all", "thesis", "results/demo/plan/plan.svg", "results/thesis/report.html"]
    asked += ["results/town_hall/building.ifc", "results/overview.html", "plan.svg", ""]
    check_targets(asked, ["demo"], FOLDERS)


@pytest.mark.parametrize(
    "word",
    [
        *("comparison", "thesis", "thesis_more", "results/thesis/report.html"),
        *("results/thesis/ring_rooms_1/poses.parquet", "results/demo/comparison.html"),
        *("./results/demo/evaluation/walls.parquet", "results/demo/figures/area.svg"),
        *("results/demo/walls/cluster_ransac.parquet", "results/demo/selection/hull.parquet"),
        *("results/demo/hulls.parquet", "results/demo/visibility.parquet"),
    ],
)
def test_what_the_laboratory_alone_makes_asks_for_it(word):
    assert asks_for_laboratory(["--cores", "2", word])


def test_what_another_workflow_makes_is_told_with_how_to_run_it():
    for target in ("comparison", "results/demo/comparison.html", "results/thesis/report.html"):
        with pytest.raises(StageError, match=f"{target}: .*`-s lab/Snakefile`"):
            check_targets([target], ["demo"], FOLDERS, laboratory="lab/Snakefile")
    check_targets(["all", "results/demo/report.html"], ["demo"], FOLDERS, laboratory="lab")


def test_what_a_plan_is_made_of_asks_for_no_laboratory():
    words = ["--cores", "2", "all", "results/demo/plan/plan.svg", "", "results", "/"]
    words += ["results/demo/evaluation/plan.parquet", "results/demo/observations.parquet"]
    words += ["--configfile", "config/thesis.yaml", "--config", "dataset=comparison"]
    assert not asks_for_laboratory(words)
