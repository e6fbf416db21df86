# by the stems of their tables: on the first survey of the rooms, what takes seconds on all
FURTHER_EXPERIMENTS = {
    "budgets": slice(1),
    "quality_times": slice(1),
    "outliers": slice(1),
    "registrability": slice(1),
    "live_choice": slice(None),
    "sensitivity": slice(1),
}
# what most experiments read of a survey, see thesis/survey_files.py
SURVEYED = {
    "scans": "results/{dataset}/scans.parquet",
    "walls": "results/{dataset}/walls/cluster_ransac.parquet",
    "registration": "results/{dataset}/registration.parquet",
    "truth": product.true_faces,
    "true_poses": product.true_poses,
}


def evaluation_of_survey(wildcards):
    """A param function: how far a scan sees, and the cell of bitmaps; what a survey is opened with."""
    settings = product.DATASETS[wildcards.dataset].settings
    return {
        "max_range_m": settings["input"]["max_range_m"],
        **settings["evaluation"],
    }


def orders_by(*names):
    """The orders of a survey's scans; some tables are called like a method."""
    return {
        f"order_{method}": f"results/{{dataset}}/selection/{method}.parquet"
        for method in names
    }


def settings_of_search(*parts):
    """A param function: settings of what is measured again, by what they are of."""
    select = {
        "extraction": lambda settings: stage_settings.select_extractor(
            settings, "cluster_ransac"
        ),
        "plan": stage_settings.select_plan,
        "hulls": stage_settings.select_hulls,
        "visibility": stage_settings.select_visibility,
        "simulation": stage_settings.select_simulation,
        "cells": lambda settings: stage_settings.select_wall_cells(
            settings, methods.WALL_LIMITS
        ),
    }

    def look_up(wildcards):
        name = wildcards.get("dataset", THESIS[experiments.ROOMS][0].name)
        return {part: select[part](product.DATASETS[name].settings) for part in parts}

    return look_up


def thesis_setting(key):
    """A setting of the experiments."""
    return THESIS[experiments.ROOMS][0].settings["thesis"][key]
