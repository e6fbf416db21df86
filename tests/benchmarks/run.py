"""The stages against the algorithms written literally, on simulated surveys, each pair timed in this one process.

Usage: run.py [simulation] [registration] [selection] [walls] [wall_quality] [plans] [FOLDER ...]
       run.py guard REVISION FOLDER [SURVEY ...]
       run.py compare FOLDER FOLDER

Without a name all of them but wall_quality, which takes minutes, and plans, which measures the surveys that the
workflow has finished under results/; a FOLDER holds the dataset folders with the truths of those it did not simulate.

`guard` makes the plans of twelve simulated drives and six real recordings with the code of a commit, in a folder of its
own; `compare` prints what changed between two such folders, and fails where a measure fell.
"""

import sys
from pathlib import Path

# each benchmark imports its own: a stage's workers import this file anew, and would wait for all of them
ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]


from helpers.default_settings import SETTINGS  # noqa: E402


def bench_simulation():
    """Ten minutes of a 10 Hz VLP-16: rays a second, cast and written, and memory."""
    import simulating

    simulating.bench(ROOT, SETTINGS)


def bench_registration():
    """Algorithm 3: the whole stage, from bag to registered scans, against Open3D on full clouds, point to point."""
    import registrationbench

    registrationbench.bench(ROOT, SETTINGS)


def bench_selection():
    """Algorithms 1 and 2 on a drive through a large office."""
    import selecting

    selecting.run(
        ROOT / "config/buildings/ring_office.geojson",
        SETTINGS,
        lambda line: print(line, flush=True),
    )


def bench_walls():
    """Cluster RANSAC against iterative RANSAC, and against itself written literally with sklearn's MeanShift."""
    import wallbench

    wallbench.speed(ROOT, SETTINGS)


def bench_wall_quality():
    """What both extractors and a line detector on a raster of all points find of the truth."""
    import wallbench

    wallbench.quality(ROOT, SETTINGS)


def bench_plans(folders=()):
    """Plans of finished surveys: from the chosen scans, from all scans, and lines on a raster of all points."""
    import plansbench

    plansbench.bench(ROOT / "results", folders, SETTINGS)


def record_guard(revision, folder, *names):
    """Make the guard's plans with the code of a commit."""
    import guard

    guard.record(
        ROOT, revision, Path(folder).resolve(), (ROOT.parent / "shared/data").resolve(), names
    )


def compare_guards(before, after):
    """Compare two folders of the guard."""
    import guard

    sys.exit(guard.compare(Path(before), Path(after)) > 0)


if __name__ == "__main__":
    commands = {"guard": record_guard, "compare": compare_guards}
    if sys.argv[1:] and sys.argv[1] in commands:
        commands[sys.argv[1]](*sys.argv[2:])
        sys.exit()
    benches = {
        "simulation": bench_simulation,
        "registration": bench_registration,
        "selection": bench_selection,
        "walls": bench_walls,
    }
    folders = [Path(name) for name in sys.argv[1:] if Path(name).is_dir()]
    names = [name for name in sys.argv[1:] if Path(name) not in folders]
    more = {"wall_quality": bench_wall_quality, "plans": lambda: bench_plans(folders)}
    unknown = set(names) - set(benches | more)
    if unknown:
        sys.exit(
            f"no benchmark {', '.join(sorted(unknown))}; there are {', '.join(benches | more)}"
        )
    for name in names or benches:
        (benches | more)[name]()
