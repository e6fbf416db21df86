"""The surveys of the thesis's experiments: names, seeds, settings, shared recordings."""

import subprocess
import sys

import pytest

from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.errors import StageError
from scanplan.project import settings
from thesis import experiments


@pytest.fixture
def known(project_root):
    return {
        "defaults": SETTINGS,
        "given": [settings.Layer("a.yaml", {"thesis": {"seeds": [4, 7], "drive_seeds": [7]}})],
        "schema": SCHEMA,
        "config": project_root / "config",
    }


def test_every_survey_has_its_seed_and_its_place(known):
    found = experiments.list_surveys(**known)
    assert [survey.name for survey in found[experiments.ROOMS]] == [
        "thesis/ring_rooms_4",
        "thesis/ring_rooms_7",
    ]
    for survey, seed in zip(found[experiments.ROOMS], (4, 7), strict=True):
        assert survey.settings["seed"] == survey.settings["simulate"]["seed"] == seed
        assert survey.settings["registration"]["icp_method"] == "none"


def test_the_limits_are_tried_on_the_first_drive(known):
    known["given"].append(settings.Layer("b.yaml", {"thesis": {"drive_seeds": [7, 8]}}))
    found = experiments.list_surveys(**known)
    (drive, _), (strict,) = found[experiments.DRIVE], found[experiments.LIMITS]
    assert strict.recordings == drive.recordings and strict.truth == drive.truth
    assert strict.name != drive.name and strict.building is None and drive.building
    assert strict.settings["registration"]["min_refined_fitness"] == 0.99
    assert drive.settings["registration"]["min_refined_fitness"] != 0.99
    assert strict.settings["simulate"] == drive.settings["simulate"]


def test_the_command_line_wins(known):
    own = {"simulate": {"building": "tiny_office"}, "registration": {"min_refined_fitness": 0.5}}
    known["given"].append(settings.Layer("b.yaml", own))
    found = experiments.list_surveys(**known)
    assert all(
        survey.settings["simulate"]["building"] == "tiny_office"
        for kind in found.values()
        for survey in kind
    )
    assert found[experiments.LIMITS][0].settings["registration"]["min_refined_fitness"] == 0.5


def test_settings_are_not_changed_by_a_seed():
    given = {"seed": 1, "simulate": {"seed": 1, "building": "a"}, "hulls": {"n_clusters": 3}}
    seeded = experiments.replace_seeds(given, 5)
    assert seeded["seed"] == seeded["simulate"]["seed"] == 5
    assert seeded["simulate"]["building"] == "a" and seeded["hulls"] == {"n_clusters": 3}
    assert given["seed"] == given["simulate"]["seed"] == 1


def test_seeds_after_the_first_are_timed_on_a_fifth_of_the_scans(known):
    surveys = experiments.list_surveys(**known)[experiments.ROOMS]
    timed = [survey.settings["thesis"]["timed_scans"] for survey in surveys]
    assert timed == [SETTINGS["thesis"]["timed_scans"], SETTINGS["thesis"]["timed_scans"] // 5]


def test_settings_that_unfit_the_surveys_are_told_to_who_asks_for_them_alone(known):
    known["given"].append(settings.Layer("b.yaml", {"simulate": {"building": "nowhere"}}))
    assert experiments.list_wanted(["comparison", "--cores", "2"], **known) == {}
    for word in ("thesis", "thesis_more", "results/thesis/report.html"):
        with pytest.raises(StageError, match=r"simulate\.building: nowhere"):
            experiments.list_wanted(["--cores", word], **known)


def test_surveys_that_fit_are_there_whatever_is_asked_for(known):
    assert experiments.list_wanted([], **known) == experiments.list_surveys(**known)


def test_nothing_heavy_is_imported_while_the_workflow_is_parsed(project_root):
    code = "import sys, thesis.experiments;"
    code += "sys.exit(bool({'numpy', 'pandas', 'scipy'} & set(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", code], cwd=project_root / "scripts", check=False)
    assert run.returncode == 0
