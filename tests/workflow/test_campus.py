"""Many datasets of one list: a broken one keeps no other from its plan, and one page shows all."""

import pandas as pd
import pytest

from helpers import browser
from helpers.project_copy import TINY, Project

pytestmark = pytest.mark.workflow
OLD_STAGE_S = 1e6


@pytest.fixture(scope="module")
def campus(project_root, tmp_path_factory):
    """Two floors and what their run said; times of a stage that is gone lie there from before."""
    project = Project(project_root, tmp_path_factory.mktemp("campus"))
    broken = project.folder / "broken"
    broken.mkdir()
    (broken / "drive.bag").write_bytes(b"#ROSBAG V2.0\n")
    (project.folder / "floors.tsv").write_text(f"name\tpath\nsound\t{TINY}\nbroken\tbroken\n")
    gone = project.folder / "benchmarks/sound/stage_of_long_ago.tsv"
    gone.parent.mkdir(parents=True)
    gone.write_text(f"s\n{OLD_STAGE_S}\n")
    arguments = ("--configfile", "config/config.yaml", "--config", "dataset=floors.tsv")
    project.done = project.run(*arguments, "--keep-going")
    return project


def test_the_sound_floor_has_its_plan_and_the_broken_one_a_line(campus):
    lines = [line for line in campus.done.stderr.splitlines() if line.startswith("scanplan: ")]
    assert campus.done.returncode == 1
    assert len(lines) == 1 and "broken" in lines[0]
    assert "Traceback" not in campus.done.stderr
    assert (campus.folder / "results/sound/plan/plan.pdf").exists()


def test_the_table_over_all_says_what_became_of_each(campus):
    rows = pd.read_parquet(campus.folder / "results/summary.parquet").set_index("name")
    assert rows["state"].to_dict() == {"broken": "failed", "sound": "plan"}
    assert "drive.bag" in rows.loc["broken", "why"]
    assert rows.loc["sound", "rooms"] >= 2 and rows.loc["sound", "area_m2"] > 10
    assert 0 < rows.loc["sound", "seconds"] < OLD_STAGE_S


@pytest.mark.skipif(browser.find() is None, reason="no Chromium here")
@pytest.mark.wording
def test_the_page_over_all_shows_a_plan_and_the_fault(campus, tmp_path):
    with browser.Page(tmp_path) as page:
        page.open((campus.folder / "results/summary.html").as_uri())
        page.run("Promise.all([...document.images].map(i => i.decode()))")
        drawn = page.run("[...document.images].map(i => [i.getAttribute('src'), i.naturalWidth])")
        text = page.run("document.body.innerText")
        is_scrolled = page.run("document.documentElement.scrollWidth > innerWidth")
    assert [source for source, width in drawn if width] == ["sound/plan/plan.svg#drawn"]
    assert "1 with a plan" in text and "1 failed" in text and "drive.bag" in text
    assert not is_scrolled
