"""Coefficients of the confidence in a plan's elements, and how well they hold on other surveys.

Plans of few and of all chosen scans of simulated surveys are held against the truth: which of their
elements exist as they are drawn. What is fitted on some surveys is tested on others.
"""

import pprint
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import shapely
from scipy import optimize, special

from scanplan.extraction import extractors, segments
from scanplan.lab.evaluation import (
    length_metrics,
    opening_metrics,
    pose_errors,
    true_plan,
    truth_file,
)
from scanplan.plan import floorplan, planning
from scanplan.project import stage_settings
from scanplan.rays import levels, ray_set
from scanplan.selection import stopping
from scanplan.stage.per_registered_scan import sensor_keywords
from scanplan.store import registered_scans, tables
from scanplan.types import BoolArray, FloatArray, IntArray, Settings
from scanplan.validation import confidence, left_out_scans, prediction
from scanplan.validation.element_features import describe_elements

_PLANS = ((0.1, 0.0), (0.3, 0.0), (1.0, 0.0), (0.5, 0.15))
# share of the chosen scans, and how far some are displaced [m]: so that there is more that is wrong
_EVERY = 4  # scan is displaced
_RIGHT_SHARE = 0.8  # of the length of a face or wall near a true one
_WITHIN_M = 0.1
_RIGHT_FLAGGED = 0.09  # of right elements lie below the level: on other surveys it may be a tenth
_BINS = 10
Rating = tuple[FloatArray, FloatArray, BoolArray]
_KINDS = {"door": "door", "passage": "door", "window": "window", "glass": "window"}


def bench(
    results: Path,
    train: Sequence[str],
    test: Sequence[str],
    *,
    coefficients: Path,
    figure: Path,
    settings: Settings,
) -> None:
    """Fit on some surveys below `results`, test on others; write coefficients and a figure."""
    rows = {name: list(_rate_survey(results / name, settings)) for name in (*train, *test)}
    fitted = _fit_tables(rows, train)
    level = _choose_level(rows, train, fitted)
    text = pprint.pformat({"level": level} | fitted, sort_dicts=False, width=90)
    coefficients.write_text(
        '"""The model of `confidence.py`, written by `make bench ARGS="confidence ..."`.\n\n'
        + textwrap.fill(f"Fitted on {', '.join(train)}; tested on {', '.join(test)}.", 100)
        + '\n"""\n\nfrom typing import Any\n\n'
        + f"COEFFICIENTS: dict[str, Any] = {text}\n"
    )
    folds = []
    for name in train:
        others = [other for other in train if other != name]
        without = _fit_tables(rows, others)
        folds.append(_rate_tables(rows, [name], without, _choose_level(rows, others, without)))
    left_out = {t: _join_ratings([fold[t] for fold in folds]) for t in floorplan.NUMBERS}
    tested = _rate_tables(rows, test, fitted, level)
    sheet, axes = plt.subplots(1, 2, figsize=(9, 4.5), sharey=True)
    _report(axes[0], left_out, f"{len(train)} surveys, each left out of its fit")
    _report(axes[1], tested, f"tested on {', '.join(test)}")
    sheet.savefig(figure, dpi=110, bbox_inches="tight")


def _rate_survey(folder: Path, settings: Settings) -> Iterator[dict[str, Any]]:
    """Yield, of plans of a survey, features and rightness by table."""
    method = settings["plan"]["method"]
    stop = stage_settings.select_section(settings, "selection", "stop")
    ordering, count, _ = stopping.read_choice(folder / f"selection/{method}.parquet", **stop)
    for share, shift_m in _PLANS:
        chosen = np.sort(ordering["scan_id"][: max(round(share * count), 3)])
        plan, validation, motion = _make_plan(folder, chosen, settings, shift_m)
        features = describe_elements(plan, validation)
        right = _judge(plan, motion, folder / "survey/truth.geojson")
        yield {table: (features[table], right[table]) for table in floorplan.NUMBERS}
        n_wrong = {table: int((right[table] == 0).sum()) for table in right}
        print(f"confidence, {folder.name}, {len(chosen)} scans: wrong {n_wrong}", flush=True)


def _make_plan(
    folder: Path, chosen: Any, settings: Settings, shift_m: float
) -> tuple[Any, Any, FloatArray]:
    store = tables.ScanStore(folder / "scans.parquet")
    shifts_m = np.zeros((len(chosen), 3))
    wrong = np.arange(len(chosen)) % _EVERY == 0
    shifts_m[wrong, :2] = np.random.default_rng(1).normal(0, shift_m, (wrong.sum(), 2))
    moved = [
        (scan_id, xyz_m + shift)
        for (scan_id, xyz_m), shift in zip(store.scans(chosen), shifts_m, strict=True)
    ]
    found = _extract(folder, chosen, moved, store.planar, settings)
    registered = registered_scans.read_registered_scans(folder / "registration.parquet")
    rows = registered_scans.rows_of_scans(chosen, registered, "selection", "registration")
    poses = registered.map_from_sensor
    sensors_m = dict(zip(chosen.tolist(), poses[rows, :3, 3] + shifts_m, strict=True))
    rays = ray_set.gather_rays(moved, sensors_m, planar=store.planar)
    made = planning.make_plan(
        segments.segment_columns(chosen, found),
        rays,
        poses[:, :2, 3],
        registered.t_ns[rows],
        planning.make_plan_settings(**stage_settings.select_plan(settings)),
        poses[rows, :3, 2],
        registered.covariance[rows],
    )
    z_m = levels.find_floor_and_ceiling(np.empty(0) if rays.planar else rays.xyz_m[:, 2])
    parts = {name: getattr(made, name) for name in ("faces", "walls", "openings", "rooms", "free")}
    plan = floorplan.make_floorplan(parts, float(z_m[0]), float(z_m[1]))
    limits = prediction.ValidationSettings(**stage_settings.select_validation(settings))
    drawn = left_out_scans.draw_left_out_rays(
        store,
        registered,
        chosen,
        (plan.storey_m[0], plan.ceiling_z_m),
        max_scans=limits.max_scans,
        max_rays=limits.max_rays,
        seed=limits.seed,
    )
    truth = truth_file.read_true_poses(folder / "survey/truth_poses.tum")
    placed = truth_file.interpolate_true_poses(truth, registered.t_ns, folder)
    motion = pose_errors.fit_alignment(poses[:, :3, 3], placed[:, :3, 3])
    return plan, prediction.validate_by_rays(plan, drawn, limits).elements, motion


def _extract(
    folder: Path, chosen: Any, scans: Sequence[Any], planar: bool, settings: Settings
) -> list[Any]:
    extractor = extractors.EXTRACTORS["cluster_ransac"]
    keywords = stage_settings.select_extractor(settings, "cluster_ransac")
    of_walls = extractors.select_settings(extractor.settings, keywords)
    sensors = sensor_keywords(chosen, "selection", folder / "registration.parquet")
    return [
        extractors.find_wall_segments(
            scan_id,
            xyz_m,
            planar=planar,
            extractor=extractor,
            settings=of_walls,
            max_rmse_m=extractors.select_max_rmse_m(extractor, keywords),
            **sensors[scan_id],
        )
        for scan_id, xyz_m in scans
    ]


def _judge(plan: Any, motion: FloatArray, truth: Path) -> dict[str, FloatArray]:
    """Return of each element whether it exists as drawn (1) or not (0); NaN of unknown gaps."""

    def moved(lines_m: FloatArray) -> FloatArray:
        return lines_m @ motion[:2, :2].T + motion[:2, 3]

    true, known = true_plan.read_true_plan(truth), truth_file.read_true_faces(truth)
    true_m = np.concatenate([known.inner_m, known.outer_m])
    faces_m = moved(floorplan.centrelines_m(plan.faces))
    share = np.array([_share_near(line_m, true_m) for line_m in faces_m])
    length_m = np.hypot(*(faces_m[:, 1] - faces_m[:, 0]).T)
    host = plan.faces["wall"]
    share_of_wall = [_mean(share, length_m, host == wall) for wall in plan.walls["wall"]]
    areas = shapely.transform(plan.areas, lambda xy_m: np.asarray(moved(xy_m), np.float64))
    ious = [max((_iou(area, room) for room in true.rooms), default=0.0) for area in areas]
    return {
        "faces": (share >= _RIGHT_SHARE).astype(float),
        "walls": (np.array(share_of_wall) >= _RIGHT_SHARE).astype(float),
        "openings": _judge_openings(plan, moved(floorplan.centrelines_m(plan.openings)), true),
        "rooms": (np.array(ious) > 0.5).astype(float),
    }


def _share_near(line_m: FloatArray, true_m: FloatArray) -> float:
    return length_metrics.compare_lines(line_m[None], true_m, _WITHIN_M).correctness


def _mean(values: FloatArray, weights: FloatArray, chosen: BoolArray) -> float:
    """Return the weighted mean of the chosen values, 0 without any."""
    return float(np.average(values[chosen], weights=weights[chosen])) if chosen.any() else 0.0


def _iou(area: Any, room: Any) -> float:
    return shapely.intersection(area, room).area / shapely.union(area, room).area


def _judge_openings(plan: Any, lines_m: FloatArray, true: Any) -> FloatArray:
    """Return whether openings are what they are drawn as, NaN of unknown gaps.

    A true one of the kind lies where its middle is, and no other drawn one lies nearer to that;
    how wide it is does not count. A passage is also where floor is free without a wall.
    """
    kinds = np.array([_KINDS.get(kind, "") for kind in plan.openings["type"]], object)
    right = np.where(kinds == "", np.nan, 0.0)
    for kind, true_m in (("door", true.doors_m), ("window", true.windows_m)):
        rows = np.flatnonzero(kinds == kind)
        right[rows[_pair_middles(lines_m[rows], true_m)]] = 1.0
    lines = shapely.linestrings(lines_m)
    free_m = shapely.length(shapely.intersection(lines, shapely.union_all(true.rooms)))
    is_free = free_m >= _RIGHT_SHARE * shapely.length(lines)
    right[(plan.openings["type"] == "passage") & is_free] = 1.0
    return right


def _pair_middles(lines_m: FloatArray, true_m: FloatArray) -> IntArray:
    """Return the rows of lines (n, 2, 2) whose middles lie in true ones, of each the nearest."""
    middles = shapely.points(lines_m.mean(axis=1))
    half_m = np.full(len(true_m), opening_metrics.WALL_M)
    within = floorplan.buffer_lines(true_m, half_m)
    row, other = shapely.STRtree(within).query(middles, predicate="within")
    apart_m = shapely.distance(middles[row], shapely.points(true_m.mean(axis=1))[other])
    order = np.argsort(apart_m, kind="stable")
    _, first = np.unique(other[order], return_index=True)
    return row[order][first]


def _join(rows: Mapping[str, Any], names: Sequence[str], table: str) -> tuple[Any, FloatArray]:
    parts = [part[table] for name in names for part in rows[name]]
    right = np.concatenate([right for _, right in parts])
    known = np.isfinite(right)
    features = {
        name: np.concatenate([features[name] for features, _ in parts])[known]
        for name in parts[0][0]
    }
    return features, right[known]


def _fit_tables(rows: Mapping[str, Any], names: Sequence[str]) -> dict[str, Any]:
    return {table: _fit(*_join(rows, names, table)) for table in floorplan.NUMBERS}


def _rate_tables(
    rows: Mapping[str, Any], names: Sequence[str], fitted: Mapping[str, Any], level: float
) -> dict[str, Rating]:
    """Return, by table, of elements how likely they are, whether right, and whether flagged."""
    ratings: dict[str, Rating] = {}
    for table, model in fitted.items():
        features, right = _join(rows, names, table)
        p_true, _ = confidence.weigh_features(features, model)
        ratings[table] = (p_true, right, p_true < level)
    return ratings


def _join_ratings(ratings: Iterable[Rating]) -> Rating:
    p_true, right, verify = (np.concatenate(part) for part in zip(*ratings, strict=True))
    return p_true, right, verify


def _choose_level(
    rows: Mapping[str, Any], names: Sequence[str], fitted: Mapping[str, Any]
) -> float:
    """Return the level below which a share of the right elements lies, of whatever kind.

    Probabilities of walls and of rooms mean the same: one level misses the fewest wrong elements.
    """
    p_true, right, _ = _join_ratings(_rate_tables(rows, names, fitted, 0.0).values())
    return round(float(np.quantile(p_true[right == 1], _RIGHT_FLAGGED)), 3)


def _fit(features: Mapping[str, FloatArray], right: FloatArray) -> dict[str, Any]:
    """Fit a logistic model whose features speak for an element only.

    What few surveys seem to teach against reason (the more scans, the less likely) holds on no
    other.
    """
    values = np.column_stack(list(features.values()))
    mean, scale = values.mean(axis=0), np.maximum(values.std(axis=0), 1e-6)
    # the first column has the intercept, which is not held small
    standard = np.column_stack([np.ones(len(right)), (values - mean) / scale])
    sign = 2 * right - 1

    def lose(weights: FloatArray) -> tuple[float, FloatArray]:
        margin = sign * (standard @ weights)
        held = np.append(0.0, weights[1:])
        slope = -(sign * special.expit(-margin)) @ standard + held
        return float(np.logaddexp(0, -margin).sum() + held @ held / 2), slope

    bounds = [(None, None), *[(0.0, None)] * len(features)]
    start = np.zeros(len(bounds))
    weights = optimize.minimize(lose, start, jac=True, bounds=bounds, method="L-BFGS-B").x
    return {
        "intercept": round(float(weights[0]), 4),
        "features": {
            name: {"mean": round(float(m), 4), "weight": round(float(w), 4)}
            for name, m, w in zip(features, mean, weights[1:] / scale, strict=True)
        },
    }


def _report(chart: Any, ratings: Mapping[str, Rating], title: str) -> None:
    for table, rating in ratings.items():
        _print_line(f"{title}, {table}", *rating)
    p_true, right, verify = _join_ratings(ratings.values())
    _print_line(f"{title}, all", p_true, right, verify)
    bins = np.minimum((p_true * _BINS).astype(int), _BINS - 1)
    used = np.unique(bins)
    chart.plot([0, 1], [0, 1], color="0.7")
    said = [p_true[bins == b].mean() for b in used]
    held = [right[bins == b].mean() for b in used]
    chart.plot(said, held, "o-")
    for b, x, y in zip(used, said, held, strict=True):
        chart.annotate(f"{(bins == b).sum()}", (x, y), (4, -12), textcoords="offset points")
    chart.set(title=title, xlabel="stated probability")
    chart.set_ylabel("share that is right")
    chart.title.set_fontsize(7)


def _print_line(what: str, p_true: FloatArray, right: FloatArray, verify: BoolArray) -> None:
    bins = np.minimum((p_true * _BINS).astype(int), _BINS - 1)
    error = sum(abs(p_true[bins == b].sum() - right[bins == b].sum()) for b in range(_BINS)) / len(
        right
    )
    wrong = right == 0
    print(
        f"{what}: {len(right)} elements, {wrong.sum()} wrong; calibration error {error:.3f};"
        f" flagged {verify[wrong].mean() if wrong.any() else np.nan:.2f} of the wrong,"
        f" {verify[~wrong].mean():.3f} of the right",
        flush=True,
    )
