"""What is no target is told with what to write instead."""

import re

import pytest

from scanplan.errors import StageError
from scanplan.project.targets import check_targets

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
    with pytest.raises(StageError, match="in its name; rename it"):
        check_targets(["results/\x1b[31m"], ["demo"], FOLDERS)


def test_rules_and_results_are_targets():
    asked = ["all", "thesis", "results/demo/plan/plan.svg", "results/thesis/report.html"]
    asked += ["results/town_hall/building.ifc", "results/overview.html", "plan.svg", ""]
    check_targets(asked, ["demo"], FOLDERS)
