from xml.etree import ElementTree

import numpy as np
import pytest

from scanplan.report import registration_figure
from scanplan.stage import figure_files
from scanplan.store import schemas, tables

REASONS = ["anchor", "kept", "low_prior_fitness", "pose_gap", "kept", "odd_thing", "anchor", "kept"]
KEPT = [r in ("anchor", "kept") for r in REASONS]


@pytest.fixture
def results(tmp_path):
    """Eight candidates along x, a metre apart; one has no place, one a reason nobody knows."""
    rng = np.random.default_rng(1)
    scan_ids = np.arange(0, 40, 5)
    with tables.open_scan_writer(tmp_path / "scans.parquet", planar=True) as write:
        for scan_id in scan_ids[KEPT]:
            write(scan_id, rng.uniform((0, -2, 0), (7, 2, 0), (200, 3)))
    x_m = np.where(np.array(REASONS) == "pose_gap", np.nan, np.arange(8.0))
    zeros = np.where(np.isnan(x_m), np.nan, 0.0)
    columns = {
        "scan_id": scan_ids,
        "t_ns": scan_ids,
        "kept": KEPT,
        "reason": REASONS,
        "x_m": x_m,
        "qw": zeros + 1,
    }
    columns |= dict.fromkeys(("y_m", "z_m", "qx", "qy", "qz", *schemas.COVARIANCE), zeros)
    columns |= dict.fromkeys(("prior_fitness", "refined_fitness"), zeros) | {
        "rmse_m": np.arange(8) / 100
    }
    tables.write_table(tmp_path / "registration.parquet", schemas.REGISTRATION, columns)
    spread = {key: [0.031, 0.012] for key in ("sigma_m", "quarter_below_m", "quarter_above_m")}
    crispness = {"poses": ["localiser", "registered"], "n_places": [9, 9], **spread}
    tables.write_table(tmp_path / "crispness.parquet", schemas.CRISPNESS, crispness)
    links = {"source": [0, 0, 5], "target": [5, 20, 35], "kind": ["sequence", "sequence", "loop"]}
    links |= {
        "residual_m": [0.01, 0.02, np.nan],
        "unobservable": [0, 0, 0],
        "inlier": [True, True, False],
    }
    others = set(schemas.EDGES.columns) - set(links)
    tables.write_table(
        tmp_path / "edges.parquet", schemas.EDGES, links | {name: np.zeros(3) for name in others}
    )
    return tmp_path


def test_the_figure_names_every_reason_with_its_number(results):
    verdicts, links, thickness = (
        tables.read_table(results / f"{schema.name}.parquet", schema)
        for schema in (schemas.REGISTRATION, schemas.EDGES, schemas.CRISPNESS)
    )
    sigma_m = dict(zip(thickness["poses"], thickness["sigma_m"], strict=True))
    points_m = np.random.default_rng(1).uniform((0, -2), (7, 2), (1000, 2))
    text = figure_files.format_svg(
        registration_figure.draw_registration_figure(points_m, verdicts, links, sigma_m)
    )
    ElementTree.fromstring(text)
    for told in (
        "kept (3)",
        "kept at the recorded pose (2)",
        "dropped: little overlap (1)",
        "dropped: pose gap (1, nowhere on the map)",
        "dropped: odd thing (1)",
        "5 of 8 candidates kept; thickness of walls: 31 mm localiser, 12 mm registered",
        "residual of a link (m)",
        "link to a neighbour (2)",
        "loop (0)",
    ):
        assert told in text, told


def test_a_registration_without_links_is_drawn(results):
    registration = tables.read_table(results / "registration.parquet", schemas.REGISTRATION)
    none = {name: np.array([], float) for name in ("source", "target", "residual_m")} | {
        "kind": np.array([], object)
    }
    figure = registration_figure.draw_registration_figure(
        np.random.default_rng(0).uniform(0, 7, (50, 2)), registration, none, {}
    )
    assert len(figure.axes) == 1


@pytest.mark.wording
def test_loops_are_told_apart(results):
    registration = tables.read_table(results / "registration.parquet", schemas.REGISTRATION)
    links = {
        "source": np.array([0, 5]),
        "target": np.array([5, 35]),
        "kind": np.array(["sequence", "loop"], object),
        "residual_m": np.array([0.01, 0.02]),
    }
    figure = registration_figure.draw_registration_figure(
        np.random.default_rng(0).uniform(0, 7, (50, 2)), registration, links, {}
    )
    named = figure.axes[0].get_legend_handles_labels()[1]
    assert {"link to a neighbour (1)", "loop (1)"} <= set(named)
