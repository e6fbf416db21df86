"""The chosen scans as a recording: the plan made of it alone is the plan."""

import numpy as np
import pytest

from helpers.project_copy import TINY, Project
from scanplan.store import schemas, tables

pytestmark = pytest.mark.workflow
PLANS = {"walls": schemas.PLAN_WALLS, "openings": schemas.OPENINGS, "rooms": schemas.ROOMS}


def test_a_plan_of_the_selected_bag_is_the_plan(project_root, tmp_path):
    """An edge of an opening may move by a cell of rays; all else agrees to a millimetre or two."""
    project = Project(project_root, tmp_path)
    made = project.run("results/demo/selected.bag", "results/demo/plan/walls.parquet")
    assert made.returncode == 0, made.stderr
    folder = tmp_path / "results/demo"
    recorded = (folder / "survey/survey.bag").stat().st_size
    assert (folder / "selected.bag").stat().st_size < 0.2 * recorded
    settings = ("--configfile", TINY, "results/demo/selected.bag.yaml")
    dataset = ("--config", "dataset=results/demo/selected.bag")
    again = project.run("results/selected/plan/walls.parquet", *settings, *dataset)
    assert again.returncode == 0, again.stderr
    for name, schema in PLANS.items():
        before = tables.read_table(folder / f"plan/{name}.parquet", schema, allow_empty=True)
        after = tables.read_table(
            tmp_path / f"results/selected/plan/{name}.parquet", schema, allow_empty=True
        )
        assert len(after[schema.sorted_by[0]]) == len(before[schema.sorted_by[0]])
        for column in ("x0_m", "y0_m", "x1_m", "y1_m", "area_m2"):
            if column in schema.columns:
                np.testing.assert_allclose(after[column], before[column], atol=0.05)
