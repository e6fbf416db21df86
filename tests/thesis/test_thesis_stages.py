"""The stages of the thesis's experiments on made-up surveys."""

import numpy as np
import pandas as pd
import pytest
import shapely

from build_hulls import build_hulls
from helpers import claim_making as made
from helpers.default_settings import SETTINGS
from helpers.evaluation_making import (
    FACES,
    SCAN_IDS,
    write_registration,
    write_selection,
    write_truth,
    write_walls,
)
from scanplan.project import stage_settings
from scanplan.selection.methods import WALL_LIMITS
from scanplan.store import schemas, tables
from thesis import premises, thesis_schemas
from thesis.beyond import live_choice, point_budgets, room_counts
from thesis.beyond.measurements import (
    Measurement,
    mean_by_level,
    read_measurements,
    write_measurements,
)
from thesis.beyond.shown.experiments import EXPERIMENTS
from thesis.figures import drive_figures
from thesis.shown_figures import FIGURES
from thesis.stages.choose_by_confidence import choose_by_confidence
from thesis.stages.choose_live import choose_live
from thesis.stages.compare_budgets import compare_budgets
from thesis.stages.draw_thesis_drive import draw_thesis_drive
from thesis.stages.draw_thesis_rooms import draw_thesis_rooms
from thesis.stages.evaluate_walls import evaluate_walls
from thesis.stages.judge_claims import judge_claims
from thesis.stages.measure_candidates import measure_candidates
from thesis.stages.measure_coverage import measure_coverage
from thesis.stages.measure_outliers import measure_outliers
from thesis.stages.measure_premises import measure_premises
from thesis.stages.measure_registrability import measure_registrability
from thesis.stages.measure_sensitivity import measure_sensitivity
from thesis.stages.measure_surrogates import measure_surrogates
from thesis.stages.measure_unevenness import measure_unevenness
from thesis.stages.tabulate_steps import tabulate_steps
from thesis.stages.time_stages import time_stages
from thesis.stages.time_to_quality import time_to_quality
from thesis.stages.write_thesis import write_thesis
from thesis.stages.write_thesis_more import write_thesis_more
from thesis.survey_files import open_survey_files

SAMPLING = {"sample_size": 200, "radius": "least_distance", "seed": 0}
EXTRACTORS = ("cluster_ransac", "iterative_ransac")


@pytest.fixture
def survey(tmp_path):
    """Three scans of a room of 6 m x 4 m: points along its walls, all registered where they are."""
    write_truth(tmp_path)
    write_registration(tmp_path)
    rng = np.random.default_rng(3)
    with tables.open_scan_writer(tmp_path / "scans.parquet", planar=False) as write:
        for scan_id in SCAN_IDS:
            corners = np.array(FACES, float)[rng.integers(0, 4, 400)]
            share = rng.random((400, 1))
            write(
                scan_id,
                np.column_stack(
                    [corners[:, :2] + share * (corners[:, 2:] - corners[:, :2]), rng.random(400)]
                ),
            )
    build_hulls(
        tmp_path / "scans.parquet",
        tmp_path / "registration.parquet",
        tmp_path / "hulls.parquet",
        settings={"n_clusters": 6, **SAMPLING},
        threads=1,
    )
    for extractor in EXTRACTORS:
        write_walls(
            tmp_path, extractor, [FACES[0], FACES[1], FACES[2], *FACES], [2, 2, 4, 7, 7, 7, 7]
        )
    for method in ("cluster_hull", "hull", "random", "sequential"):
        write_selection(tmp_path, method, SCAN_IDS)
    return tmp_path


def coverage(folder):
    inputs = [folder / name for name in ("scans.parquet", "hulls.parquet", "registration.parquet")]
    inputs += [folder / name for name in ("truth.geojson", "truth_poses.tum")]
    outputs = folder / "clusters.parquet", folder / "areas.parquet"
    sampling = SAMPLING | {"n_clusters": 6}
    measure_coverage(*inputs, *outputs, n_clusters=[6, 1], max_range_m=100.0, sampling=sampling)
    return outputs


def evaluated(folder):
    walls = [folder / f"walls/{extractor}.parquet" for extractor in EXTRACTORS]
    selections = sorted((folder / "selection").glob("*.parquet"))
    inputs = [
        folder / name for name in ("registration.parquet", "truth.geojson", "truth_poses.tum")
    ]
    outputs = [folder / f"{name}.parquet" for name in ("evaluated", "aligned", "oracle")]
    evaluate_walls(walls, selections, *inputs, *outputs, max_range_m=100.0, bitmap_cell_m=0.05)
    return outputs[0]


def write_times(folder):
    tasks = ("plain_clusters", "plain_ransac")
    rows = [("order_scans", 3, 0, 3, 0.1)] + [
        (e, 400, scan_id, 4, 0.01) for e in tasks for scan_id in SCAN_IDS
    ]
    columns = dict(
        zip(thesis_schemas.TIMES.columns, map(list, zip(*rows, strict=True)), strict=True)
    )
    tables.write_table(folder / "times.parquet", thesis_schemas.TIMES, columns)
    return folder / "times.parquet"


def test_areas_are_those_of_the_room_each_time(survey):
    clusters, areas = coverage(survey)
    first = clusters.read_bytes(), areas.read_bytes()
    assert tuple(path.read_bytes() for path in coverage(survey)) == first
    measured = tables.read_table(areas, thesis_schemas.AREAS)
    np.testing.assert_allclose(measured["seen_m2"], 24)
    # hulls lie within the room: what they share with it is their own share of it
    np.testing.assert_allclose(measured["full_hull_iou"], measured["full_hull_m2"] / 24, rtol=1e-6)
    assert (measured["cluster_hull_iou"] < measured["full_hull_iou"]).all()
    # points on the walls: one hull is nearly the room, the clusters' hulls leave its middle out
    assert (measured["full_hull_m2"] > 22).all() and (measured["cluster_hull_m2"] < 20).all()
    # a stray return as far as the farthest: outside of the room, but for a few directions
    assert (measured["full_hull_stray_m2"] >= measured["full_hull_m2"] - 1e-6).all()
    assert (measured["full_hull_stray_m2"] > measured["full_hull_m2"] + 0.1).any()
    growth = tables.read_table(clusters, thesis_schemas.CLUSTERS)
    own_m2 = growth["area_m2"][growth["n_clusters"] == 6]
    np.testing.assert_allclose(np.sort(own_m2), np.sort(measured["cluster_hull_m2"]))
    assert (
        growth["n_clusters"].tolist() == [1, 1, 1, 6, 6, 6]
        and growth["rank"].tolist() == [1, 2, 3] * 2
    )
    assert (np.diff(growth["covered_m2"])[[0, 1, 3, 4]] >= 0).all()


def test_of_a_room_that_every_scan_sees_nothing_is_lost(survey, tmp_path):
    inputs = [survey / name for name in ("scans.parquet", "hulls.parquet", "registration.parquet")]
    inputs += [survey / name for name in ("truth.geojson", "truth_poses.tum")]
    sampling, found = SAMPLING | {"n_clusters": 6}, []
    for name in ("first", "second"):
        output = tmp_path / f"{name}.parquet"
        measure_unevenness(*inputs, output, sampling=sampling, max_range_m=100.0, n_selected=2)
        found.append(output.read_bytes())
    assert found[0] == found[1]
    columns = tables.read_table(output, thesis_schemas.UNEVENNESS)
    # three crowds of one scan each, all within sight of the room's 20 m of wall
    assert set(columns["crowd"]) == {0, 1, 2} and set(columns["repeats"]) == {1, 5, 20}
    np.testing.assert_allclose(columns["seen_m"], 20.0)


def test_premises_are_measured_scan_by_scan_and_draw_by_draw(survey, tmp_path):
    opened = open_files(survey)
    found = []
    for name in ("first", "second"):
        output = tmp_path / f"{name}.parquet"
        measure_premises(
            opened,
            output,
            extraction=stage_settings.select_extractor(SETTINGS, "cluster_ransac"),
            n_added=4,
        )
        found.append(output.read_bytes())
    assert found[0] == found[1]
    table = pd.DataFrame(tables.read_table(output, thesis_schemas.PREMISES))
    assert table.groupby("premise").size().to_dict() == {
        **dict.fromkeys(premises.UTILITIES, 4),
        premises.ONE_WALL: 3,
    }
    # walls found is a union's length: no scan adds more to more
    assert (table.loc[table["premise"] == "walls found", "value"].dropna() >= 1 - 1e-9).all()


def test_candidates_are_counted_by_model_and_band(survey, tmp_path):
    inputs = [survey / name for name in ("scans.parquet", "registration.parquet", "truth.geojson")]
    walls = stage_settings.select_extractor(SETTINGS, "thesis_iterative_ransac")
    # a strip of 0.1 m of a wall 1 m high has about ten of its hundred points
    walls |= {"max_trials": 1000, "min_points": 8}
    found = []
    for name in ("first", "second"):
        output = tmp_path / f"{name}.parquet"
        measure_candidates(*inputs, output, walls=walls, n_scans=2)
        found.append(output.read_bytes())
    assert found[0] == found[1]
    columns = tables.read_table(output, thesis_schemas.CANDIDATES)
    assert len(columns["model"]) == 2 * 3 * 2
    # the room's four walls without noise: planes are these walls, however narrow the band
    is_plane = columns["model"] == "plane"
    assert (
        columns["near_walls"][is_plane].tolist() == columns["walls"][is_plane].tolist() == [4] * 6
    )
    is_wide = ~is_plane & (columns["inlier_m"] == 0.05)
    assert (columns["near_walls"][is_wide] > 2 * columns["walls"][is_wide]).all()


def test_every_task_is_timed(survey, tmp_path):
    thesis = ("thesis_cluster_ransac", "thesis_iterative_ransac")
    walls = stage_settings.select_extractors(SETTINGS, thesis)
    inputs = [survey / name for name in ("scans.parquet", "registration.parquet", "hulls.parquet")]
    inputs.append(survey / "walls/cluster_ransac.parquet")
    time_stages(
        *inputs,
        tmp_path / "times.parquet",
        walls=walls,
        hulls=SAMPLING,
        n_clusters=[3, 1],
        timed_scans=3,
        merge=stage_settings.select_merging(SETTINGS),
        whole=True,
    )
    found = tables.read_table(tmp_path / "times.parquet", thesis_schemas.TIMES)
    extractors = {"plain_clusters", "plain_ransac"}
    assert set(found["task"]) == extractors | {f"thinned_{e}" for e in extractors} | {
        "build_hulls",
        "build_sampled_hulls",
        "build_unsampled_hulls",
        "merge_segments",
        "order_scans",
        "order_scans_literally",
    }
    thinned = found["size"][found["task"] == "thinned_plain_ransac"]
    assert sorted(set(thinned.tolist())) == [50, 100, 200, 400]


def test_the_steps_are_counted(survey, tmp_path):
    (tmp_path / "a.bag").write_bytes(b"x" * 1000)
    for name, seconds in (("first", "2.5"), ("second", "0.5")):
        (tmp_path / f"{name}.tsv").write_text(f"s\th:m:s\n{seconds}\t0:00:02\n")
    times = [
        [tmp_path / "first.tsv", tmp_path / "second.tsv"],
        [tmp_path / "first.tsv"],
        [tmp_path / "second.tsv"],
    ]
    inputs = [
        survey / name
        for name in ("truth_poses.tum", "registration.parquet", "scans.parquet", "hulls.parquet")
    ]
    selection = survey / "selection/cluster_hull.parquet"
    tabulate_steps(
        [tmp_path / "a.bag"], *inputs, selection, times, tmp_path / "steps.parquet", n_selected=2
    )
    found = tables.read_table(tmp_path / "steps.parquet", thesis_schemas.STEPS)
    assert found["n_scans"].tolist() == [3, 3, 3, 3, 2]
    np.testing.assert_allclose(found["seconds"], [0.5, np.nan, 3.0, 2.5, 0.5])
    whole = (survey / "scans.parquet").stat().st_size
    # a line that says nothing and commas are as good to the reader of all true poses
    truth = survey / "truth_poses.tum"
    truth.write_text("\n" + truth.read_text().replace(" ", ","))
    tabulate_steps(
        [tmp_path / "a.bag"], *inputs, selection, times, tmp_path / "steps.parquet", n_selected=2
    )
    np.testing.assert_allclose(
        tables.read_table(tmp_path / "steps.parquet", thesis_schemas.STEPS)["seconds"],
        [0.5, np.nan, 3.0, 2.5, 0.5],
    )
    assert found["n_bytes"].tolist() == [
        1000,
        thesis_schemas.NOT_WRITTEN,
        whole,
        (survey / "hulls.parquet").stat().st_size,
        whole * 2 // 3,
    ]


def test_every_figure_is_drawn_and_stands_on_the_page(survey, tmp_path):
    drawn = [tmp_path / "figures" / figure.file for figure in FIGURES]
    files = {name: survey / f"{name}.parquet" for name in ("scans", "registration", "hulls")}
    files |= {
        method: survey / f"selection/{method}.parquet"
        for method in ("cluster_hull", "hull", "sequential")
    }
    files |= {
        "cluster_ransac": survey / "walls/cluster_ransac.parquet",
        "clusters": coverage(survey)[0],
    }
    files |= {"truth": survey / "truth.geojson", "true_poses": survey / "truth_poses.tum"}
    evaluation = evaluated(survey)
    draw_thesis_rooms(
        files,
        [evaluation] * 2,
        {"figures": drawn[:11], "orders": tmp_path / "orders.svg"},
        bitmap_cell_m=0.05,
        max_range_m=100.0,
        extraction=stage_settings.select_extractor(SETTINGS, "cluster_ransac"),
    )
    walls = {extractor: survey / f"walls/{extractor}.parquet" for extractor in EXTRACTORS}
    tables_of_drive = [survey / name for name in ("scans.parquet", "registration.parquet")]
    draw_thesis_drive(
        *tables_of_drive, files["cluster_hull"], walls, write_times(survey), drawn[11:]
    )
    assert all("<svg" in path.read_text() for path in [*drawn, tmp_path / "orders.svg"])


def claim_files(folder):
    files = {}
    for name, columns in (made.rooms() | made.drive()).items():
        schema = _schema(name)
        full = {column: columns.get(column, np.zeros(len(columns))) for column in schema.columns}
        order = np.lexsort([np.asarray(full[column]) for column in reversed(schema.sorted_by)])
        path = folder / f"{name}.parquet"
        tables.write_table(
            path, schema, {column: np.asarray(values)[order] for column, values in full.items()}
        )
        files[name] = [path, path]
    return files


def _schema(name):
    known = {
        "walls": "EVALUATION",
        "hull": "SELECTION",
        "cluster_hull": "SELECTION",
        "poses": "POSE_ERRORS",
    }
    table = name.split("_", 1)[1]
    if table in known:
        return getattr(schemas, known[table])
    return getattr(thesis_schemas, table.upper())


def test_claims_are_judged_seed_by_seed_and_written_to_the_page(tmp_path):
    files = claim_files(tmp_path)
    drive = {key: paths[:1] for key, paths in files.items() if not key.startswith("rooms")}
    judge_claims(files | drive, tmp_path / "claims.parquet", rooms_seeds=[3, 5], drive_seeds=[5])
    found = tables.read_table(tmp_path / "claims.parquet", thesis_schemas.CLAIMS)
    assert set(found["survey"][found["claim"] == "full_hull_99"]) == {"seed 3", "seed 5"}
    assert set(found["survey"][found["claim"] == "fewer_walls"]) == {"seed 5"}
    assert set(found["survey"][found["claim"] == "uneven_harms_random"]) == {"seed 3", "seed 5"}
    figures = [tmp_path / figure.file for figure in FIGURES]
    for path in figures:
        path.write_text("<svg></svg>")
    steps = files["drive_steps"][0], files["limits_steps"][0]
    output = tmp_path / "report.html"
    own_figures = [tmp_path / f"{name}.svg" for name in ("orders", "gates", "alignments")]
    for path in own_figures:
        path.write_text("<svg></svg>")
    write_thesis(figures, own_figures, tmp_path / "claims.parquet", steps, made.PAGE, output)
    page = output.read_text()
    assert (
        "does not hold" in page
        and "<h3>Figure 5.12</h3>" in page
        and page.count("<svg") == len(FIGURES) + 3
    )


def test_crowded_places_are_circled_once():
    rng = np.random.default_rng(0)
    path_m = np.concatenate(
        [rng.normal((0, 0), 0.2, (30, 2)), rng.normal((20, 0), 0.2, (28, 2)), [(10.0, 0)] * 3]
    )
    found = np.array(drive_figures.find_crowded_places(path_m))
    np.testing.assert_allclose(found, [(0, 0), (20, 0), (10, 0)], atol=0.6)
    assert drive_figures.find_crowded_places(np.array([(0.0, 0.0), (9.0, 0.0)])) == []


def test_experiments_beyond_the_thesis_stand_on_their_page(survey, tmp_path, project_root):
    """Every scan shows a wall cell; the orders that the figure compares are those of the survey."""
    for method in ("wall_length", "distance"):
        write_selection(survey, method, SCAN_IDS)
    cells = {"facing": [0, 1, 2], "along": [4] * 3, "across": [2] * 3, "length_m": [0.2] * 3}
    cells["axes_deg"] = [0] * 3
    tables.write_table(
        survey / "observations.parquet", schemas.OBSERVATIONS, {"scan_id": SCAN_IDS, **cells}
    )
    squares = shapely.to_wkb(shapely.box(0, 0, [1, 2, 3], 1))
    tables.write_table(
        survey / "visibility.parquet",
        schemas.VISIBILITY,
        {"scan_id": SCAN_IDS, "area_m2": [1.0, 2.0, 3.0], "geometry": squares},
    )
    known = [survey / name for name in ("walls/cluster_ransac.parquet", "registration.parquet")]
    known += [survey / name for name in ("truth.geojson", "truth_poses.tum")]
    truth = {"max_range_m": 100.0, "bitmap_cell_m": 0.05}
    chosen, stood = survey / "confidence.parquet", survey / "surrogates.parquet"
    observations = survey / "observations.parquet"
    choose_by_confidence(observations, *known, chosen, cell_m=0.25, sigma_m=0.06, **truth)
    covers = {name: survey / f"{name}.parquet" for name in ("observations", "visibility", "hulls")}
    measure_surrogates(covers, open_files(survey), stood, n_added=2, seed=1)
    found = tables.read_table(chosen, schemas.EVALUATION)
    assert set(found["method"]) == {"confidence", "oracle"} and found["k"].max() == len(SCAN_IDS)
    ratios = tables.read_table(stood, thesis_schemas.SURROGATES)["ratio"]
    # covered areas and lengths are submodular
    assert (ratios[np.isfinite(ratios)] >= 1 - 1e-9).all()
    measured = further_experiments(survey, tmp_path)
    folder = project_root / "workflow/thesis/page"
    page = [folder / name for name in ("thesis_more.html.j2", "thesis.css")]
    output = tmp_path / "more.html"
    evaluations = [evaluated(survey)] * 2
    write_thesis_more(evaluations, [chosen] * 2, [stood] * 2, measured, page, output)
    text = output.read_text()
    assert text.count("<svg") == 2 + len(EXPERIMENTS) and "2 seeds" in text
    for experiment in EXPERIMENTS.values():
        assert f"<h2>{experiment.title}</h2>" in text


def open_files(survey, *methods):
    """The made-up room as stages open it, with orders by some methods."""
    files = {name: survey / f"{name}.parquet" for name in ("scans", "registration")}
    files |= {"walls": survey / "walls/cluster_ransac.parquet"}
    files |= {"truth": survey / "truth.geojson", "true_poses": survey / "truth_poses.tum"}
    files |= {f"order_{method}": survey / f"selection/{method}.parquet" for method in methods}
    # a table that is called like a method is none
    files |= {"visibility": survey / "visibility.parquet"}
    return open_survey_files(files, max_range_m=100.0, bitmap_cell_m=0.05)


def further_experiments(survey, folder):
    """The tables of the further experiments on the made-up room, by name."""
    methods = ("distance", "every_nth", "wall_length")
    for method in methods:
        write_selection(survey, method, SCAN_IDS)
    opened = open_files(survey, *methods)
    extraction = stage_settings.select_extractor(SETTINGS, "cluster_ransac")
    cells = stage_settings.select_wall_cells(SETTINGS, WALL_LIMITS)
    hulls = SAMPLING | {"n_clusters": 6}
    benchmark = folder / "job.tsv"
    benchmark.write_text("s\tcpu_time\n2.5\t1.5\n")
    table = {name: folder / f"{name}.parquet" for name in EXPERIMENTS}
    search = {"extraction": extraction, "cells": cells, "hulls": hulls}
    compare_budgets(opened, table["budgets"], extraction=extraction, sizes=[1, 2], seed=1)
    time_to_quality(
        opened,
        [benchmark],
        table["quality_times"],
        settings=search | {"plan": stage_settings.select_plan(SETTINGS)},
        sizes=[1],
    )
    rows = [Measurement(case, 4, 1, room_counts.NEEDED, 5) for case in ("oracle", "distance")]
    write_measurements(table["floors"], rows)
    seen = {"visibility": stage_settings.select_visibility(SETTINGS)}
    limits = {"n_scans": 3, "n_selected": 1, "seed": 1}
    measure_outliers(opened, table["outliers"], settings=search | seen, shares=[0.3], **limits)
    measure_registrability(
        opened,
        table["registrability"],
        registration=stage_settings.select_section(SETTINGS, "registration"),
        sizes=[2],
        seed=1,
    )
    observations = survey / "observations.parquet"
    live = table["live_choice"]
    choose_live(opened, observations, live, shares=[0.1, 0.5])
    factors = [1.0, 2.0]
    measure_sensitivity(
        opened, table["sensitivity"], extraction=extraction, hulls=hulls, factors=factors
    )
    # every scan shows a cell of its own
    found = read_measurements([live])
    assert (found.loc[found["quantity"] == live_choice.TAKEN, "value"] == 3).all()
    assert (found.loc[found["quantity"] == live_choice.HELD, "value"] == 3).all()
    # with the points of two of three scans no way finds more than all there is
    shares = mean_by_level(read_measurements([table["budgets"]]), point_budgets.FOUND_SHARE)
    assert shares.index.tolist() == [1, 2] and (shares <= 1).all(axis=None)
    return {name: [path] for name, path in table.items()}
