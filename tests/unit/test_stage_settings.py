"""Every stage receives the keywords that it takes, and every key reaches a stage."""

import copy
import inspect
import subprocess
import sys
from dataclasses import MISSING, fields

import pytest

from helpers.default_settings import SCHEMA, SETTINGS
from interpolate_poses import interpolate_poses
from measure_crispness import measure_crispness
from order_scans import order_scans
from scanplan.errors import StageError
from scanplan.extraction.extractors import EXTRACTORS
from scanplan.plan import planning
from scanplan.project import stage_settings
from scanplan.project.settings_schema import iterate_keys, list_choices
from scanplan.registration.registration_settings import registration_settings
from scanplan.selection import hulls, methods, wall_cells
from scanplan.validation import prediction
from scanplan.visit import next_visit
from simulate_survey import simulate_survey

SECTIONS = ("input", "poses", "registration", "evaluation", "thesis")
# what the workflow itself looks up: which surveys, recordings, designs, orderings and walls
OF_THE_WORKFLOW = {
    "dataset",
    "replace",
    "plan.method",
    "plan.extractor",
    "plan.export.formats",
    "plan.design.file",
    "plan.design.prior",
    "plan.design.tolerances",
    "simulate.building",
    "simulate.recording",
    "advanced.jobs.chunk_gb",
}


def received(settings):
    """All that stages receive of some settings."""
    select = stage_settings
    names = list_choices(SCHEMA, "plan", "extractor")
    return {
        **{name: select.select_section(settings, name) for name in SECTIONS},
        "stop": select.select_section(settings, "selection", "stop"),
        "playing": select.select_section(settings, "selection", "playing"),
        "drawing": select.select_drawing(settings),
        "presentation": select.select_presentation(settings),
        "files": select.select_files(settings),
        "design": select.select_design(settings),
        "cloud": select.select_section(settings, "plan", "export", "cloud"),
        "topics": select.select_topics(settings),
        "crispness": select.select_crispness(settings),
        "hulls": select.select_hulls(settings),
        "sampling": select.select_hull_sampling(settings),
        "visibility": select.select_visibility(settings),
        "cells": select.select_wall_cells(settings, methods.WALL_LIMITS),
        "orders": {
            method: select.select_order(settings, methods.METHODS[method].settings)
            for method in methods.METHODS
        },
        "walls": select.select_extractors(settings, names),
        "plan": select.select_plan(settings),
        "validation": select.select_validation(settings),
        "visit": select.select_visit(settings),
        "simulation": select.select_simulation(settings),
    }


def with_value(key, value):
    settings = copy.deepcopy(SETTINGS)
    *sections, last = key.split(".")
    section = settings
    for name in sections:
        section = section[name]
    section[last] = value
    return settings


def leaves(values):
    for value in values.values():
        if isinstance(value, dict):
            yield from leaves(value)
        else:
            yield value


@pytest.mark.parametrize("key", [k for k, _ in iterate_keys(SCHEMA) if k not in OF_THE_WORKFLOW])
def test_every_key_reaches_a_stage(key):
    changed = 77.5  # no default
    assert changed not in leaves(received(SETTINGS))
    # in the plan doors end a little lower
    assert changed in leaves(received(with_value(key, changed)))


def test_nothing_given_is_changed():
    before = copy.deepcopy(SETTINGS)
    received(SETTINGS)
    assert before == SETTINGS


def test_the_settings_classes_take_what_is_selected():
    for name, extractor in EXTRACTORS.items():
        selected = stage_settings.select_extractor(SETTINGS, name)
        own = {field.name: field.default is MISSING for field in fields(extractor.settings)}
        least = {name for name, is_asked in own.items() if is_asked}
        assert least <= set(selected) <= own.keys()
    cells = stage_settings.select_wall_cells(SETTINGS, methods.WALL_LIMITS)
    wall_cells.WallCellSettings(**cells)
    planning.make_plan_settings(stage_settings.select_plan(SETTINGS))
    prediction.ValidationSettings(**stage_settings.select_validation(SETTINGS))
    next_visit.VisitSettings(**stage_settings.select_visit(SETTINGS))
    registration_settings(stage_settings.select_section(SETTINGS, "registration"))


def keywords(stage):
    parameters = inspect.signature(stage).parameters.values()
    return {p.name for p in parameters if p.kind is p.KEYWORD_ONLY}


@pytest.mark.parametrize(
    ("stage", "selected", "others"),
    [
        (measure_crispness, stage_settings.select_crispness(SETTINGS), set()),
        (hulls.make_cluster_hulls, stage_settings.select_hulls(SETTINGS), set()),
        (interpolate_poses, stage_settings.select_section(SETTINGS, "poses"), {"moved", "made_of"}),
    ],
)
def test_the_stages_take_what_is_selected(stage, selected, others):
    assert set(selected) <= keywords(stage)
    assert keywords(stage) - set(selected) <= others


def test_the_simulation_takes_what_is_selected():
    selected = set(stage_settings.select_simulation(SETTINGS))
    scene = {"site", "mount", "sensor", "errors", "drive", "people"}
    assert selected - scene == keywords(simulate_survey) - {"threads", "start_ns"}
    assert scene <= selected


@pytest.mark.parametrize("method", methods.METHODS)
def test_an_ordering_takes_what_is_selected(method):
    selected = stage_settings.select_order(SETTINGS, methods.METHODS[method].settings)
    assert set(selected) <= keywords(order_scans)


def test_a_building_has_one_height_of_doors():
    settings = with_value("building.door_height_m", 2.5)
    for name in ("cluster_ransac", "iterative_ransac"):
        assert stage_settings.select_extractor(settings, name)["door_height_m"] == 2.5
    assert stage_settings.select_visibility(settings)["max_height_m"] == 2.5
    plan = stage_settings.select_plan(settings)
    assert plan["trace"]["door_height_m"] == 2.4
    # as tuned: not a hair's breadth beside
    assert stage_settings.select_plan(SETTINGS)["trace"]["door_height_m"] == 1.8


def test_a_gap_a_corner_and_a_door_are_as_wide_for_scans_and_for_the_plan():
    settings = with_value("walls.max_gap_m", 0.7)
    settings["building"]["max_door_m"] = 1.2
    plan = stage_settings.select_plan(settings)
    walls = stage_settings.select_extractor(settings, "iterative_ransac")
    assert plan["merge"]["max_gap_m"] == plan["trace"]["max_gap_m"] == walls["max_gap_m"] == 0.7
    assert plan["merge"]["corner_m"] == walls["corner_m"] == 0.25
    assert plan["openings"]["max_door_m"] == 1.2


def test_one_seed_draws_everything_but_the_simulation():
    settings = with_value("seed", 42)
    found = received(settings)
    for stage in ("crispness", "hulls", "sampling"):
        assert found[stage]["seed"] == 42
    assert found["orders"]["random"] == {"seed": 42}
    assert all(walls["seed"] == 42 for walls in found["walls"].values())
    assert found["simulation"]["seed"] == 1


def test_what_concerns_points_alone_is_no_topic():
    assert not {"min_range_m", "max_range_m", "deskew"} & set(
        stage_settings.select_topics(SETTINGS)
    )


def test_a_section_that_is_none_is_an_error():
    with pytest.raises(KeyError, match=r"plan\.colour"):
        stage_settings.select_section(SETTINGS, "plan", "colour")


def test_a_section_comes_with_its_tuned_keys():
    registration = stage_settings.select_section(SETTINGS, "registration")
    assert registration["icp_method"] == "gicp" and registration["voxel_m"] == 0.25
    names = {field.name for field in fields(registration_settings(registration).limits)}
    assert "min_points" in names


def test_nothing_heavy_is_imported_while_the_workflow_is_parsed(project_root):
    code = "import sys, scanplan.project.stage_settings;"
    code += "sys.exit(bool({'numpy', 'pandas', 'scipy'} & set(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", code], cwd=project_root / "scripts", check=False)
    assert run.returncode == 0


def test_a_stage_has_no_more_jobs_than_can_be_run():
    assert stage_settings.count_chunks("d", 0.1, 4.0) == 1
    assert stage_settings.count_chunks("d", 4000.0, 4.0) == 1000
    with pytest.raises(StageError, match=r"advanced\.jobs\.chunk_gb: 4 GB .* 1,001 jobs"):
        stage_settings.count_chunks("d", 4004.0, 4.0)
