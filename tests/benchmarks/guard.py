"""Plans of the same surveys by any commit, so that a change of the code shows what it does to them.

The surveys are drives through five buildings with three seeds each, made from one recipe, and the
real recordings that lie beside the project. A drive is recorded with what a VLP-16 and a localiser
on a real rover show: the sweep of the moving sensor, constant errors of its beams, and poses that
drift and jump.
"""

import functools
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
"""Drives of this name lead through buildings drawn at random by the seed behind it.

Between the two may stand the kind of a drive with a 2-D scanner, as in drawn_laser180_201.
"""
_DRAWN: dict[str, dict[str, Any]] = {DRAWN: {}} | {
    f"{DRAWN}_{kind}": planar for kind, planar in PLANAR.items()
}
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
        Only these surveys, of any seed, or real recordings; all but drawn ones if empty.

    Raises
    ------
    subprocess.CalledProcessError
        If git or the workflow fails; it has said why.
    """
    folder.mkdir(parents=True, exist_ok=True)
    code = check_out(project, revision, folder)
    surveys = {name: _find_survey(name, folder, recordings) for name in names or default_names()}
    targets = [f"results/{name}/{table}" for name in surveys for table in _wanted(name)]
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    given = json.dumps([str(path) for path in surveys.values()])
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
    commit = name_commit(project, revision)
    if not code.is_dir():
        _git(project, "clone", "--quiet", "--no-checkout", str(project), str(code))
    _git(code, "fetch", "--quiet", str(project), commit)
    _git(code, "checkout", "--quiet", "--detach", commit)
    return code


def name_commit(project: Path, revision: str) -> str:
    """Return the full name of a commit of the project."""
    return _git(project, "rev-parse", f"{revision}^{{commit}}")


def _git(folder: Path, *words: str) -> str:
    done = subprocess.run(
        ["git", "-C", str(folder), *words], check=True, stdout=subprocess.PIPE, text=True
    )
    return done.stdout.strip()


def default_names() -> tuple[str, ...]:
    """Return the names of all surveys but drawn ones."""
    drives = (f"{name}_{seed}" for name in _drives() if name not in _DRAWN for seed in SEEDS)
    return (*drives, *RECORDINGS)


def _find_survey(name: str, folder: Path, recordings: Path) -> Path:
    """Return the dataset of a survey: a real recording, or a drive's settings, made if missing."""
    kind, _, seed = name.rpartition("_")
    if kind not in _drives() or not seed.isdecimal():
        if (recordings / name).is_dir():
            return recordings / name
        sys.exit(
            f"guard: no survey {name}; there are {', '.join(default_names())}, with any seed,"
            f" and {', '.join(f'{kind}_9' for kind in _DRAWN)}"
        )
    path = folder / f"surveys/{name}.yaml"
    path.parent.mkdir(exist_ok=True)
    drive = {**_drives()[kind], "seed": int(seed), "localiser": LOCALISER}
    if kind in _DRAWN:
        drawing = path.with_suffix(".geojson")
        drawing.write_bytes(drawn_buildings.draw_building(int(seed)))
        drive |= {"building": str(drawing), "site": {"route": "rooms", **_clutter(int(seed))}}
    elif Path(drive["building"]).suffix:
        drive["building"] = str(recordings / "buildings" / drive["building"])
    text = yaml.safe_dump({"simulate": drive})
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
    return path


def _clutter(seed: int) -> dict[str, Any]:
    """Return what stands about every other drawn building."""
    return {"chairs": 12, "doors_ajar": 0.4} if seed % 2 else {}


@functools.cache
def _drives() -> dict[str, dict[str, Any]]:
    """Return settings by drive: in space, and in the plane among chairs."""
    drives = {**BUILDINGS, **_DRAWN}
    for building, settings in BUILDINGS.items():
        clutter = {"chairs": _CHAIRS[building], "doors_ajar": 0.5}
        site = {**settings.get("site", {}), **clutter}
        for kind, planar in PLANAR.items():
            drives[f"{building}_{kind}"] = {**settings, **planar, "site": site}
    return drives


def _wanted(name: str) -> tuple[str, ...]:
    kind = name.rpartition("_")[0]
    if kind == DRAWN:
        return ("selection/wall_length.parquet",)
    wanted = ["plan/plan.svg", "plan/plan.geojson"]
    if kind in _drives():
        wanted.append("evaluation/plan.parquet")
        if kind not in _DRAWN:
            wanted.append("evaluation/walls.parquet")
    return tuple(wanted)


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
    folders = [path.parent.parent for path in before.glob("code/results/*/plan/plan.geojson")]
    fallen = sum(_compare_survey(folder.name, before, after) for folder in sorted(folders))
    print(f"guard: {fallen} measures fell by more than {MAX_DROP:g}")
    return fallen


def _compare_survey(name: str, before: Path, after: Path) -> int:
    """Print what changed of one survey, and return how many measures fell."""
    folders = [folder / "code/results" / name for folder in (before, after)]
    if not all((folder / "plan/plan.geojson").exists() for folder in folders):
        print(f"{name}: not in {after}")
        return 0
    changed = _changed_files(*folders)
    print(f"{name}: {'differ: ' + ', '.join(changed) if changed else 'all tables equal in bytes'}")
    if not (folders[0] / "evaluation/plan.parquet").exists():
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
    frames = {"plan": plan}
    if (folder / "evaluation/walls.parquet").exists():
        walls = pq.read_table(folder / "evaluation/walls.parquet").to_pandas()
        frames["walls"] = walls.groupby(["method", "extractor"]).mean(numeric_only=True)
    measures = {}
    for table, frame in frames.items():
        names = [column for column in frame.columns if _is_measure(column)]
        for index, row in frame[names].dropna(axis=1, how="all").iterrows():
            label = index if isinstance(index, str) else " ".join(index)
            known = row.dropna()
            measures |= {f"{table} {label} {name}": float(known[name]) for name in known.index}
    return measures


def _is_measure(column: str) -> bool:
    return any(name in column for name in _MORE_IS_BETTER) or column.endswith(_LESS_IS_BETTER)
