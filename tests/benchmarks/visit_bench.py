"""Second visits to simulated buildings: as planned, and at random with as many scans and more.

A drive is cut short, and its plan says from where a second visit would settle what it leaves open.
The rover drives there; the bag is added to the first, and the plan made again. What was asked is
settled rightly where the second plan is not in doubt and says what is true. What needs a person is
not promised to be.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import drawn_buildings
import numpy as np
import shapely
from guard import BUILDINGS, DRAWN, LOCALISER

import simulate_survey
from scanplan.lab.buildings import route
from scanplan.lab.evaluation import opening_metrics, pose_errors, true_plan, truth_file
from scanplan.lab.simulation import rover, survey_bag, survey_setup
from scanplan.plan import floorplan, floorplan_files
from scanplan.project import stage_settings
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import Array, FloatArray, Settings

_DRIVEN = 0.45  # of the way through all rooms: some are seen through doors alone
_MORE = (1, 2, 4)  # times as many scans have random drives, each the first part of the next
_RIGHT_SHARE = 0.8  # of a length
_WITHIN_M = 0.1
_STEP_M = 0.1  # along what is asked
_LATER_NS = 3600 * 10**9  # an hour between the drives
_KINDS = {"door": "door", "passage": "door", "window": "window", "glass": "window"}
_TABLES = ("faces", "walls", "openings", "rooms", "free", "confidence")


def bench(
    project: Path, settings: Settings, folder: Path, recordings: Path, names: Sequence[str]
) -> None:
    """Print, by building, how much of what a first drive left open either second drive settles.

    Parameters
    ----------
    project : Path
    settings : dict
        Default settings.
    folder : Path
        Drives and results are kept there.
    recordings : Path
        The folder with the buildings.
    names : sequence of str
        Of `guard.BUILDINGS`, with a seed behind an underscore, as duplex_4; or drawn_9.
    """
    totals: dict[str, list[bool]] = {}
    for name in names:
        for drive, right in _visit_again(project, settings, folder, recordings, name).items():
            totals[drive] = totals.get(drive, []) + right
        for drive, right in totals.items():
            print(f"next_visit, so far, {drive}: {sum(right)} of {len(right)}", flush=True)


def _visit_again(
    project: Path, settings: Settings, folder: Path, recordings: Path, name: str
) -> dict[str, list[bool]]:
    building, _, seed = name.partition("_")
    given = BUILDINGS.get(building, {"building": building, "site": {"route": "rooms"}})
    source = Path(given["building"])
    if building == DRAWN:
        source = folder / f"{name}.geojson"
        source.write_bytes(drawn_buildings.draw_building(int(seed)))
    else:
        source = recordings / "buildings" / source if source.suffix else _drawing(project, source)
    simulated = settings["simulate"] | {"seed": int(seed), "localiser": _localiser(settings)}
    simulated["site"] = simulated["site"] | given.get("site", {})
    place = survey_setup.prepare_site(source.read_bytes(), source, simulated, seed=int(seed))
    way_m = _cut_way(np.asarray(place.waypoints_m), _DRIVEN)
    first = folder / "surveys" / f"{name}_first"
    n_first = _drive(source, first, "first", simulated, way_m)
    _make_plan(project, folder, first)
    asked = tables.read_table(
        folder / f"results/{first.name}/plan/questions.parquet", schemas.QUESTIONS
    )
    stops = tables.read_table(
        folder / f"results/{first.name}/plan/standpoints.parquet", schemas.STANDPOINTS
    )
    motion = _find_motion(folder / "results" / first.name, first)
    standpoints_m = _move(np.column_stack([stops["x_m"], stops["y_m"]]), motion)
    floor = (place.floor_m, place.obstacles_m)

    def join(places_m: FloatArray) -> FloatArray:
        return route.join_places(*floor, places_m, source, clearance_m=_clearance(settings))

    planned_m = join(np.vstack([way_m[:1], standpoints_m]))
    planned_s = _duration_s(planned_m, simulated)
    drives = {"planned": planned_m} | {
        f"random{times}": _wander(place, join, way_m, times * planned_s, simulated)
        for times in _MORE
    }
    reachable = asked["standpoint"] > 0
    promised = reachable & ~asked["needs_person"]
    print(f"next_visit, {name}: {n_first} scans, {reachable.sum()} of {len(reachable)} questions"
          f" can be seen, from {len(stops['standpoint'])} places, {promised.sum()} settled",
          flush=True)  # fmt: skip
    right, _ = _judge(folder / "results" / first.name, first, asked, motion)
    settled = {"before, right": right[reachable].tolist()}
    if not reachable.any():
        return settled
    print(f"next_visit, {name}: {right[reachable].sum()} of them are right before", flush=True)
    for drive, corners_m in drives.items():
        again = folder / "surveys" / f"{name}_{drive}"
        n_scans = _drive(source, again, drive, simulated, corners_m, first)
        _make_plan(project, folder, again)
        right, is_sure = _judge(folder / "results" / again.name, again, asked, motion)
        settled[f"{drive}, right"] = right[reachable].tolist()
        settled[f"{drive}, right and in no doubt"] = (right & is_sure)[reachable].tolist()
        settled[f"{drive}, settled as promised"] = (right & is_sure)[promised].tolist()
        print(
            f"next_visit, {name}, {drive}: {n_scans} scans more, {right[reachable].sum()} of"
            f" {reachable.sum()} right, {(right & is_sure)[reachable].sum()} of them in no doubt;"
            f" by kind {_count_kinds(asked['kind'], reachable, right)}",
            flush=True,
        )
    return settled


def _drawing(project: Path, name: Path) -> Path:
    return project / "config/buildings" / f"{name}.geojson"


def _localiser(settings: Settings) -> Settings:
    return settings["simulate"]["localiser"] | LOCALISER


def _clearance(settings: Settings) -> float:
    return stage_settings.select_visit(settings)["clearance_m"]


def _cut_way(way_m: FloatArray, share: float) -> FloatArray:
    """Return the first share of a way."""
    line = shapely.linestrings(way_m)
    gone_m = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way_m, axis=0).T))])
    end_m = share * gone_m[-1]
    last_m = shapely.get_coordinates(shapely.line_interpolate_point(line, end_m))
    return np.vstack([way_m[gone_m < end_m], last_m])


def _wander(
    place: Any, join: Any, way_m: FloatArray, wanted_s: float, simulated: Settings
) -> FloatArray:
    """Return a way through places drawn at random that takes so long."""
    random = np.random.default_rng(simulated["seed"])
    low_m, high_m = np.reshape(shapely.bounds(place.floor_m), (2, 2))
    corners_m = way_m[:1]
    while len(corners_m) < 2 or _duration_s(corners_m, simulated) < wanted_s:
        drawn_m = random.uniform(low_m, high_m)
        if shapely.contains_xy(place.floor_m, *drawn_m):
            leg_m = join(np.stack([corners_m[-1], drawn_m]))
            corners_m = np.vstack([corners_m, leg_m[1:]])
    low, high = 0.0, 1.0
    while high - low > 1e-3:
        middle = (low + high) / 2
        is_short = _duration_s(_cut_way(corners_m, middle), simulated) < wanted_s
        low, high = (middle, high) if is_short else (low, middle)
    return _cut_way(corners_m, high)


def _duration_s(corners_m: FloatArray, simulated: Settings) -> float:
    rates = {key: simulated["drive"][key] for key in ("speed_m_s", "turn_rate_deg_s")}
    return float(rover.plan_drive(corners_m, **rates).t_s[-1])


def _drive(
    source: Path,
    folder: Path,
    drive: str,
    simulated: Settings,
    way_m: FloatArray,
    earlier: Path | None = None,
) -> int:
    """Record a drive into a dataset's folder, beside that of an earlier one; return its scans."""
    folder.mkdir(parents=True, exist_ok=True)
    site = simulated["site"] | {"route": "given", "start_m": None}
    site["waypoints_m"] = way_m.round(4).tolist()
    keywords = {k: v for k, v in simulated.items() if k not in ("building", "recording", "site")}
    poses, bag = folder / "truth_poses.tum", folder / f"{drive}.bag"
    if not poses.exists():
        simulate_survey.simulate_survey(
            source,
            bag,
            folder / "truth.geojson",
            folder / "own_poses.txt",
            folder / "own_trajectory.txt",
            site=site,
            start_ns=survey_bag.EPOCH_NS + (_LATER_NS if earlier else 0),
            threads=2,
            **keywords,
        )
        if earlier:
            os.link(earlier / "first.bag", folder / "first.bag")
        before = (earlier / "truth_poses.tum").read_text() if earlier else ""
        poses.write_text(before + (folder / "own_poses.txt").read_text())
    return len((folder / "own_poses.txt").read_text().splitlines())


def _make_plan(project: Path, folder: Path, survey: Path) -> None:
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    target = f"results/{survey.name}/plan/next_visit.geojson"
    command = [sys.executable, "-m", "snakemake", "-s", str(project / "Snakefile")]
    command += ["-d", str(folder), "--cores", "2", "--quiet", "rules", "--config"]
    command += [f"dataset={json.dumps([str(survey)])}", "--", target]
    subprocess.run(command, env=environment, check=True)


def _find_motion(results: Path, survey: Path) -> FloatArray:
    """Return true_from_map (4, 4) of a plan."""
    registered = registered_scans.read_registered_scans(results / "registration.parquet")
    truth = truth_file.read_true_poses(survey / "truth_poses.tum")
    placed = truth_file.interpolate_true_poses(truth, registered.t_ns, survey)
    return pose_errors.fit_alignment(registered.map_from_sensor[:, :3, 3], placed[:, :3, 3])


def _move(xy_m: FloatArray, motion: FloatArray) -> FloatArray:
    return xy_m @ motion[:2, :2].T + motion[:2, 3]


def _move_shapes(shapes: Array, motion: FloatArray) -> Array:
    moved = shapely.transform(shapes, lambda xy_m: np.asarray(_move(xy_m, motion), np.float64))
    return np.asarray(moved, object)


def _count_kinds(kinds: Array, reachable: Array, right: Array) -> str:
    counts = []
    for kind in sorted(set(kinds)):
        of_kind = reachable & (kinds == kind)
        counts.append(f"{kind} {right[of_kind].sum()}/{of_kind.sum()}")
    return ", ".join(counts)


@dataclass(frozen=True, eq=False)
class _Statements:
    """What a plan, or the truth, says of places: the ground of doors, windows, walls, and rooms.

    In `doubt` is that of what the plan marks, or did not see.
    """

    door: Any
    window: Any
    wall: Any
    doubt: Any
    rooms: Any

    def of_places(self, points: Array) -> Array:
        """Return what is said of each place, (n,) str."""
        said = np.full(len(points), "nothing", object)
        for name in ("wall", "window", "door"):
            said[shapely.intersects(getattr(self, name), points)] = name
        return said


def _judge(results: Path, survey: Path, asked: Any, motion: FloatArray) -> tuple[Array, Array]:
    """Return of which questions of the first plan another says what is true, and is sure: (q,)."""
    plan = floorplan_files.read_floorplan({t: results / f"plan/{t}.parquet" for t in _TABLES})
    true = true_plan.read_true_plan(survey / "truth.geojson")
    known = truth_file.read_true_faces(survey / "truth.geojson")
    own = _find_motion(results, survey)
    drawn, is_true = _read_statements(plan, own), _true_statements(true, known)
    shapes = _move_shapes(shapely.from_wkb(asked["geometry"]), motion)
    verdicts = []
    for kind, shape in zip(asked["kind"], shapes, strict=True):
        if kind == "room":
            verdicts.append(_judge_room(shape, plan, own, true))
            continue
        points = _places_along(shape)
        is_sure = np.mean(~shapely.intersects(drawn.doubt, points)) >= _RIGHT_SHARE
        if kind == "way":
            beside = _places_beside(shape)
            inside = [shapely.intersects(s.rooms, beside) for s in (drawn, is_true)]
            verdicts.append((bool((inside[0] == inside[1]).all()), is_sure))
        else:
            agrees = drawn.of_places(points) == is_true.of_places(points)
            verdicts.append((agrees.mean() >= _RIGHT_SHARE, is_sure))
    right, sure = np.reshape(verdicts, (-1, 2)).astype(bool).T
    return right, sure


def _read_statements(plan: Any, motion: FloatArray) -> _Statements:
    def widen(lines_m: FloatArray, half_m: float) -> Any:
        return _widen(_move(lines_m, motion), half_m)

    openings_m, faces_m = (floorplan.centrelines_m(t) for t in (plan.openings, plan.faces))
    kinds = np.array([_KINDS.get(kind, "") for kind in plan.openings["type"]], object)
    weak = plan.walls["wall"][plan.walls["verify"]]
    doubtful_m = [
        faces_m[np.isin(plan.faces["wall"], weak)],
        openings_m[plan.openings["verify"]],
        floorplan.centrelines_m(plan.unseen),
    ]
    return _Statements(
        widen(openings_m[kinds == "door"], opening_metrics.WALL_M),
        widen(openings_m[kinds == "window"], opening_metrics.WALL_M),
        widen(faces_m, _WITHIN_M),
        widen(np.concatenate(doubtful_m), _WITHIN_M),
        shapely.union_all(_move_shapes(plan.areas, motion)),
    )


def _true_statements(true: Any, known: Any) -> _Statements:
    return _Statements(
        _widen(true.doors_m, opening_metrics.WALL_M),
        _widen(true.windows_m, opening_metrics.WALL_M),
        _widen(np.concatenate([known.inner_m, known.outer_m]), _WITHIN_M),
        shapely.Polygon(),
        shapely.union_all(true.rooms),
    )


def _widen(lines_m: FloatArray, half_m: float) -> Any:
    """Return the ground along lines (n, 2, 2), so wide to each side."""
    return shapely.union_all(floorplan.buffer_lines(lines_m, np.full(len(lines_m), half_m)))


def _places_along(shape: Any) -> Array:
    """Return places along lines, the middles of equal parts of about a step."""
    places: list[Any] = []
    for line in shapely.get_parts(shape):
        n = max(round(line.length / _STEP_M), 1)
        middles = (np.arange(n) + 0.5) / n
        places += [*shapely.line_interpolate_point(line, middles, normalized=True)]
    return np.array(places, object)


def _places_beside(shape: Any) -> Array:
    """Return the places half a metre to either side of the middle of an opening's line."""
    begin_m, end_m = shapely.get_coordinates(shape)[[0, -1]]
    way = (end_m - begin_m) / np.hypot(*(end_m - begin_m))
    aside_m = 0.5 * np.array([-way[1], way[0]])
    middle_m = (begin_m + end_m) / 2
    return np.asarray(shapely.points(np.stack([middle_m + aside_m, middle_m - aside_m])))


def _judge_room(shape: Any, plan: Any, motion: FloatArray, true: Any) -> tuple[bool, bool]:
    """Return whether the room that lies where one was asked for is a true one, and sure."""
    asked = shapely.union_all(shapely.get_parts(shapely.polygonize(shapely.get_parts(shape))))
    areas = _move_shapes(plan.areas, motion)
    shared_m2 = shapely.area(shapely.intersection(areas, asked))
    if not shared_m2.any():
        return False, False
    row = int(shared_m2.argmax())
    ious = [
        shapely.intersection(areas[row], room).area / shapely.union(areas[row], room).area
        for room in true.rooms
    ]
    return max(ious) > 0.5, not plan.rooms["verify"][row]
