"""Plans of the same surveys by any commit, so that a change of the code shows what it does to them.

The surveys are drives through five buildings with three seeds each, made from one recipe, and the
real recordings that lie beside the project. A drive is recorded with what a VLP-16 and a localiser
on a real rover show: the sweep of the moving sensor, constant errors of its beams, and poses that
drift and jump.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import drawn_buildings
import pyarrow.parquet as pq
import yaml

BUILDINGS: dict[str, dict[str, Any]] = {
    "demo": {"building": "demo_office"},
    "ring": {"building": "ring_office", "site": {"route": "rooms", "start_m": "random"}},
    "duplex": {"building": "duplex.ifc", "site": {"route": "rooms", "storey": "Level 1"}},
    "fzk": {"building": "AC20-FZK-Haus.ifc", "site": {"route": "rooms", "storey": "Erdgeschoss"}},
    "pavilion": {"building": "pavilion"},
}
"""Drive to its settings of `simulate`; a building with a suffix is a file among the recordings."""
PLANAR: dict[str, dict[str, Any]] = {
    "laser180": {
        "mount": {"height_m": 0.3},
        "sensor": {
            **{"model": "laser", "n_azimuth": 181, "field_deg": 180.0},
            **{"max_range_m": 80.0, "rate_hz": 1.0, "sweep": False},
        },
        "errors": {"noise_m": 0.02},
        "drive": {"speed_m_s": 1.0},
        "people": {"count": 3},
    },
    "laser270": {
        "mount": {"height_m": 0.3},
        "sensor": {
            **{"model": "laser", "n_azimuth": 541, "field_deg": 270.0},
            **{"max_range_m": 30.0, "rate_hz": 10.0, "sweep": True},
        },
        "errors": {"noise_m": 0.01},
        "people": {"count": 3},
    },
}
"""Kind of drive with a 2-D scanner to its settings: a scan each metre, or ten a second."""
DRAWN = "drawn"
"""Drives of this name lead through buildings drawn at random by the seed behind it."""
# one on each ten square metres
_CHAIRS = {"demo": 40, "ring": 120, "duplex": 12, "fzk": 16, "pavilion": 18}
LOCALISER = {"noise_m": 0.05, "noise_deg": 1.0, "jumps_per_min": 1.0}
SEEDS = (1, 2, 3)
RECORDINGS = (
    "intel",
    "jackal_ros1",
    "jackal_ros2",
    "mac_first_floor",
    "scenes7_room",
    "vlp16_room",
)
MAX_DROP = 0.005  # half a point: less is rounding of openings by a column
"""A measure that falls by more is reported."""
_EQUAL = 1e-9  # sums in another order

_MORE_IS_BETTER = (
    "completeness",
    "correctness",
    "f1",
    "recall",
    "precision",
    "iou",
    "n_rooms_found",
)
_LESS_IS_BETTER = ("thickness_error_m", "width_error_m", "n_rooms_false")


def record(
    project: Path, revision: str, folder: Path, recordings: Path, names: Sequence[str] = ()
) -> None:
    """Make the plans of the guard's surveys with the code of a commit.

    Parameters
    ----------
    project : Path
        The checkout that the commit is taken from.
    revision : str
        Any name that git knows the commit by.
    folder : Path
        Made if need be; a second call with another commit reruns what changed in between.
    recordings : Path
        Folder with the real recordings and the buildings.
    names : sequence of str
        Only these surveys; all but drawn ones if empty.

    Raises
    ------
    subprocess.CalledProcessError
        If git or the workflow fails; it has said why.
    """
    folder.mkdir(parents=True, exist_ok=True)
    code = check_out(project, revision, folder)
    surveys = _surveys(folder, recordings) | _drawn_surveys(folder, names)
    unknown = set(names) - set(surveys)
    if unknown:
        sys.exit(f"guard: no survey {', '.join(sorted(unknown))}; there are {', '.join(surveys)}")
    chosen = {name: path for name, path in surveys.items() if not names or name in names}
    targets = [f"results/{name}/{table}" for name in chosen for table in _wanted(name)]
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    given = json.dumps([str(path) for path in chosen.values()])
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "--cores",
        "2",
        "--quiet",
        "rules",
        "--config",
        f"dataset={given}",
    ]
    subprocess.run([*command, "--", *targets], cwd=code, env=environment, check=True)


def check_out(project: Path, revision: str, folder: Path) -> Path:
    """Return a checkout of a commit of the project, made in the folder where it is missing."""
    code = folder / "code"
    commit = _git(project, "rev-parse", f"{revision}^{{commit}}")
    if not code.is_dir():
        _git(project, "clone", "--quiet", "--no-checkout", str(project), str(code))
    _git(code, "fetch", "--quiet", str(project), commit)
    _git(code, "checkout", "--quiet", "--detach", commit)
    return code


def _git(folder: Path, *words: str) -> str:
    done = subprocess.run(
        ["git", "-C", str(folder), *words], check=True, stdout=subprocess.PIPE, text=True
    )
    return done.stdout.strip()


def _surveys(folder: Path, recordings: Path) -> dict[str, Path]:
    surveys = folder / "surveys"
    surveys.mkdir(exist_ok=True)
    paths = {}
    for name, settings in _drives():
        building = settings["building"]
        place = str(recordings / "buildings" / building) if Path(building).suffix else building
        for seed in SEEDS:
            drive = {**settings, "building": place, "seed": seed, "localiser": LOCALISER}
            path = surveys / f"{name}_{seed}.yaml"
            text = yaml.safe_dump({"simulate": drive})
            if not path.exists() or path.read_text() != text:
                path.write_text(text)
            paths[path.stem] = path
    return paths | {name: recordings / name for name in RECORDINGS}


def _drawn_surveys(folder: Path, names: Sequence[str]) -> dict[str, Path]:
    """Return the drives among names through buildings drawn at random, made where missing."""
    paths = {}
    for name in names:
        kind, _, seed = name.partition("_")
        if kind != DRAWN or not seed.isdecimal():
            continue
        path, drawing = (folder / f"surveys/{name}{suffix}" for suffix in (".yaml", ".geojson"))
        drawing.write_bytes(drawn_buildings.draw_building(int(seed)))
        drive = {"building": str(drawing), "seed": int(seed), "localiser": LOCALISER}
        site = {"route": "rooms", **_clutter(int(seed))}
        path.write_text(yaml.safe_dump({"simulate": {**drive, "site": site}}))
        paths[name] = path
    return paths


def _clutter(seed: int) -> dict[str, Any]:
    """Return what stands about every other drawn building."""
    return {"chairs": 12, "doors_ajar": 0.4} if seed % 2 else {}


def _drives() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield names and settings of the drives: in space, and in the plane among chairs."""
    yield from BUILDINGS.items()
    for building, settings in BUILDINGS.items():
        clutter = {"chairs": _CHAIRS[building], "doors_ajar": 0.5}
        site = {**settings.get("site", {}), **clutter}
        for kind, planar in PLANAR.items():
            yield f"{building}_{kind}", {**settings, **planar, "site": site}


def _wanted(name: str) -> tuple[str, ...]:
    if name.startswith(DRAWN):
        return ("selection/wall_length.parquet",)
    drawn = ("plan/plan.svg", "plan/plan.geojson")
    measured = ("evaluation/plan.parquet", "evaluation/walls.parquet")
    return drawn if name in RECORDINGS else drawn + measured


def compare(before: Path, after: Path) -> int:
    """Print what changed between two folders of the guard, survey by survey.

    Parameters
    ----------
    before, after : Path
        As `record` made them.

    Returns
    -------
    int
        How many measures fell by more than `MAX_DROP`.
    """
    drives = [f"{name}_{seed}" for name, _ in _drives() for seed in SEEDS]
    fallen = sum(_compare_survey(name, before, after) for name in (*drives, *RECORDINGS))
    print(f"guard: {fallen} measures fell by more than {MAX_DROP:g}")
    return fallen


def _compare_survey(name: str, before: Path, after: Path) -> int:
    """Print what changed of one survey, and return how many measures fell."""
    folders = [folder / "code/results" / name for folder in (before, after)]
    if not all((folder / "plan/plan.geojson").exists() for folder in folders):
        print(f"{name}: not in both")
        return 0
    changed = _changed_files(*folders)
    print(f"{name}: {'differ: ' + ', '.join(changed) if changed else 'all tables equal in bytes'}")
    if name in RECORDINGS:
        return 0
    rows = list(_changed_measures(*folders))
    for measure, old, new, falls in rows:
        print(f"  {'FELL ' if falls else '     '}{measure}: {old:.4f} -> {new:.4f}")
    return sum(falls for *_, falls in rows)


def _changed_files(before: Path, after: Path) -> list[str]:
    """Return the tables that differ; run times and drawings with their stamps are no tables."""
    files = sorted(file.relative_to(before) for file in before.rglob("*.parquet"))
    tables = [file for file in files if file.name != "seconds.parquet"]
    both = [file for file in tables if (after / file).exists()]
    return [str(f) for f in both if (before / f).read_bytes() != (after / f).read_bytes()]


def _changed_measures(before: Path, after: Path) -> Iterator[tuple[str, float, float, bool]]:
    """Yield measures that changed: name, value before and after, whether it fell."""
    old, new = (_measures(folder) for folder in (before, after))
    for name, value in old.items():
        drop = value - new.get(name, float("nan"))
        if name.rsplit(" ", 1)[-1].endswith(_LESS_IS_BETTER):
            drop = -drop
        # what became NaN fell, too
        if abs(drop) > _EQUAL or drop != drop:
            yield name, value, new.get(name, float("nan")), not drop <= MAX_DROP


def _measures(folder: Path) -> dict[str, float]:
    """Return the guard's measures by name: of the plan by frame, and means of the walls over k."""
    plan = pq.read_table(folder / "evaluation/plan.parquet").to_pandas().set_index("frame")
    walls = pq.read_table(folder / "evaluation/walls.parquet").to_pandas()
    by_kind = walls.groupby(["method", "extractor"]).mean(numeric_only=True)
    measures = {}
    for table, frame in (("plan", plan), ("walls", by_kind)):
        names = [column for column in frame.columns if _is_measure(column)]
        for index, row in frame[names].dropna(axis=1, how="all").iterrows():
            label = index if isinstance(index, str) else " ".join(index)
            known = row.dropna()
            measures |= {f"{table} {label} {name}": float(known[name]) for name in known.index}
    return measures


def _is_measure(column: str) -> bool:
    return any(name in column for name in _MORE_IS_BETTER) or column.endswith(_LESS_IS_BETTER)
