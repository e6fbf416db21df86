"""The stages against the algorithms written literally, each pair timed in this one process.

Usage: run.py [simulation] [registration] [selection] [walls] [wall_quality] [plans] [validation]
              [FOLDER ...]
       run.py pipeline [big | big=BAGS] [FOLDER] [REVISION ...]
       run.py guard REVISION FOLDER [SURVEY ...]
       run.py table FOLDER [SURVEY ...]
       run.py compare FOLDER FOLDER
       run.py ablate FOLDER [SURVEY | HALF | KIND | subset | RULE ...]
       run.py fit_things FOLDER [HALF | KIND | FLOOR ...]
       run.py fit_partings FOLDER [HALF | KIND | FLOOR ...]
       run.py confidence FOLDER
       run.py next_visit FOLDER [SURVEY ...]
       run.py changes FOLDER [SURVEY ...]
       run.py design FOLDER
       run.py sheets RESULTS FOLDER [SURVEY ...]
       run.py presentation RESULTS TRUTHS [DRIVE ...]
       run.py redraw RESULTS [SURVEY ...]
       run.py files RESULTS SURVEY ... [node=FOLDER]
       run.py ids RESULTS FOLDER SURVEY ...
       run.py odometry FOLDER [DRIVE ...]
       run.py overlays [COUNT [FIRST SEED]]
       run.py edits RESULTS TRUTH FOLDER
       run.py stations FOLDER [COUNT ...]
       run.py growth FOLDER [scans | rooms | extent | glass | TIMES ...]
       run.py realistic FOLDER [REVISION] [HALF | KIND | subset | FLOOR | KEY=VALUE ...]
       run.py compare_realistic SCORES SCORES

Without a name all of them but wall_quality, which takes minutes, plans, which measures the surveys
that `make compare` has finished under results/, and validation, which damages the plans there; a
FOLDER holds the dataset folders with the truths of those it did not simulate, or is one in which
`realistic` has finished.

`pipeline` runs the default target on a drive of 6,000 scans, or of 60,000 in ten bags (big; or in
as many bags as are said, as big=3), with the code of the last commit, after that of other commits
where some are named: time, memory and bytes of every stage, beside a raw read. The drives, 6 and
5 GB, are simulated once and kept in FOLDER.

`guard` makes the plans of 45 simulated drives and six real recordings with the code of a
commit, in a folder of its own, or those of any seed and recording that are named; `table` prints
what they are worth; `compare` what changed between two such folders, and fails where a measure
fell.

`ablate` makes the plans of surveys that a bench has finished in FOLDER again, without one rule of
the plan at a time, and prints what each rule is worth: two drives at once, a few seconds a rule.
Surveys and rules may be named, as in ablate FOLDER intel "narrow places"; else what is only ever
reported on is left out.

`fit_things` fits what tells walls from leaves, furniture and what is outside on the tuning floors
that `realistic` has finished in FOLDER, and prints the table for `plan/model/things.py`, and what
it is worth on kinds of buildings that it was not fitted on; `fit_partings` likewise what parts
rooms, for `plan/model/parting_odds.py`.

`confidence` fits how likely elements of a plan are right on the tuning floors that `realistic` has
finished in FOLDER, prints how well that holds on the others, and writes the coefficients into the
package, with a reliability diagram in FOLDER.

`growth` runs the default target on drives that are 1, 2, 4 and 8 times as long, as many rooms or
as wide (or as many TIMES as are said), and on a hall of glass with and without ground around it,
and prints what every stage takes of each.

`stations` reads 10, 20 and 30 stations (or as many as are said) of 5 million points from one E57
file, and plans an office as stations and as a merged cloud, with scores by what is true of it.

`realistic` makes the plans of 84 drives through 42 buildings drawn from seeds, and of real floors
with a truth, by the code of a commit, and scores them in the terms of the field: tables of measures
and elements, and a page with a picture of every floor, in FOLDER/scores/COMMIT, or COMMIT+WORDS
where floors are named: HALF is tuning, reporting or real, subset twelve drives. Recordings are
simulated once and kept. Half of the kinds of buildings are for tuning, the others are only reported
on. Words with an equals sign are settings that the plans are made with, as
plan.merge.min_scans=3. `compare_realistic` says what changed between two such folders,
element by element.

`next_visit` cuts drives short, drives to where their plans say that a second visit should stand,
and as far again at random, and counts what is settled rightly. Surveys are named as those of
`guard`, with any seed; drives and plans are kept in FOLDER.

`design` holds surveys of altered copies of published building models against these, and prints
what plans of whole drives and parts are worth with the model as a prior and without; surveys are
kept in FOLDER.

`changes` compares surveys of the demo office with those of it after it was rebuilt, by other
sensors and in another frame, and counts what is told rightly; surveys are kept in FOLDER.

`sheets` counts words that lie on others on the sheets of surveys that are registered in RESULTS,
and `ids` the elements that keep their GlobalIds over twenty changes of settings. Their plans are
made with this code, and kept in FOLDER.

`presentation` holds regular drawings of simulated drives that are planned in RESULTS against their
truths, beside what was measured: rooms, walls, directions, and the share of walls whose thickness
is the true one.

`redraw` counts what an architect would redraw of the sheets of surveys in RESULTS, measured and
regular, by one list: doubled walls, ends that nearly meet, words on walls and others.

`files` asks validators and readers that are not ours about the files of surveys in RESULTS: schema,
rules and demands of models, drawings by ezdxf and LibreCAD, PDF by qpdf, layers by GDAL; with
node=FOLDER, where gltf-validator and web-ifc of npm are, also these.

`odometry` registers drives with odometry alone, of 200 and 600 m with a planar and a spatial
scanner, two seeds each, and a real one, and fails where poses are farther off than they may be;
drives are named 200_2d_1 to 600_3d_2, and intel_odometry.

`walk` mends a plan on its page in a browser, as somebody would who knows the floor and has nothing
else, in ten minutes by the keystroke-level model; its errors by the truth before and after, and
what was done. Results are those of a demo, or of a floor with a truth: drawn by hand or of a map.

`overlays` unites, cuts and parts 100,000 arrangements of areas that rounding makes hard, or as many
as are said, and fails where an overlay raises or areas do not add up.
"""

import inspect
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

# each benchmark imports its own: a stage's workers import this file anew, and would wait for all
ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]


from helpers.default_settings import SETTINGS  # noqa: E402


def bench_simulation() -> None:
    """Ten minutes of a 10 Hz VLP-16: rays a second, cast and written, and memory."""
    import simulation_bench

    simulation_bench.bench(ROOT, SETTINGS)


def bench_registration() -> None:
    """Algorithm 3: the whole stage against Open3D on full clouds, point to point."""
    import registration_bench

    registration_bench.bench(ROOT, SETTINGS)


def bench_selection() -> None:
    """Algorithms 1 and 2 on a drive through a large office."""
    import selection_bench

    selection_bench.bench(ROOT, SETTINGS)


def bench_walls() -> None:
    """Cluster RANSAC against iterative RANSAC, and against itself written literally."""
    import walls_bench

    walls_bench.bench_speed(ROOT, SETTINGS)


def bench_wall_quality() -> None:
    """What both extractors and a line detector on a raster of all points find of the truth."""
    import walls_bench

    walls_bench.bench_quality(ROOT, SETTINGS)


def bench_plans(folders: Sequence[Path] = ()) -> None:
    """Plans of finished surveys: of the chosen scans, of all, and lines on a raster."""
    import plans_bench

    plans_bench.bench(ROOT / "results", folders, SETTINGS)


def bench_validation(folders: Sequence[Path] = ()) -> None:
    """Prediction of left-out scans against the truth, over damaged plans of finished surveys."""
    import validation_bench

    realistic = [folder for folder in folders if (folder / "code/results").is_dir()]
    for folder in realistic:
        validation_bench.bench(folder / "code/results", [folder / "truths"], SETTINGS)
    others = [folder for folder in folders if folder not in realistic]
    if others or not realistic:
        validation_bench.bench(ROOT / "results", others, SETTINGS)


def record_guard(revision: str, folder: str, *names: str) -> None:
    """Make the guard's plans with the code of a commit."""
    import guard

    recordings = (ROOT.parent / "shared/data").resolve()
    guard.record(ROOT, revision, Path(folder).resolve(), recordings, names)


def print_table(folder: str, *names: str) -> None:
    """Print what the plans of the guard's drives are worth."""
    import drive_table

    drive_table.print_table(Path(folder), names)


def compare_guards(before: str, after: str) -> None:
    """Compare two folders of the guard."""
    import guard

    sys.exit(guard.compare(Path(before), Path(after)) > 0)


def ablate_rules(folder: str, *names: str) -> None:
    """Price the rules of the plan."""
    import ablation

    ablation.bench(Path(folder), names, SETTINGS)


def bench_pipeline(*words: str) -> None:
    """Bag to plan and report on a long drive."""
    import pipeline_bench

    big = [word for word in words if word.partition("=")[0] == "big"]
    given = [word for word in words if word not in big]
    n_big = int(big[0].partition("=")[2] or 10) if big else None
    kept = Path(given[0]) if given else Path(tempfile.gettempdir()) / "scanplan_drives"
    pipeline_bench.bench(ROOT, SETTINGS, kept.resolve(), given[1:], n_big=n_big)


def fit_things(folder: str, *names: str) -> None:
    """Densities of what surfaces are sides of."""
    import fit_things

    fit_things.bench(Path(folder), names, SETTINGS)


def fit_partings(folder: str, *names: str) -> None:
    """Weights of what parts rooms."""
    import fit_partings

    fit_partings.bench(Path(folder), names, SETTINGS)


def fit_confidence(folder: str) -> None:
    """Write the coefficients of the confidence in a plan's elements."""
    import confidence_bench

    package = ROOT / "scripts/scanplan/validation"
    confidence_bench.bench(
        Path(folder),
        coefficients=package / "confidence_coefficients.py",
        figure=Path(folder) / "reliability.png",
    )


def bench_next_visit(folder: str, *names: str) -> None:
    """Second drives as planned, and at random with as many scans and more."""
    import visit_bench

    recordings = (ROOT.parent / "shared/data").resolve()
    surveys = names or ("demo_4", "duplex_4")
    visit_bench.bench(ROOT, SETTINGS, Path(folder).resolve(), recordings, surveys)


def bench_walk(results: str, truth: str | None = None) -> None:
    """A plan before and after ten minutes with its page and nothing else."""
    import walk_bench

    walk_bench.bench(results, truth)


def bench_design(folder: str) -> None:
    """What is told of buildings built otherwise than designed; what their designs tell a plan."""
    import design_bench

    models = (ROOT.parent / "shared/data/buildings").resolve()
    design_bench.bench(ROOT, SETTINGS, Path(folder).resolve(), models)


def bench_changes(folder: str, *names: str) -> None:
    """What is told of a floor that was rebuilt, against what was done to it."""
    import changes_bench

    changes_bench.bench(ROOT, Path(folder), names)


def bench_sheets(results: str, folder: str, *names: str) -> None:
    """Words on sheets that lie on others, and the least height of letters."""
    import exchange_bench

    exchange_bench.bench_sheets(Path(results), Path(folder), names, SETTINGS)


def bench_ids(results: str, folder: str, *names: str) -> None:
    """GlobalIds that stay over twenty changes of settings."""
    import exchange_bench

    exchange_bench.bench_ids(Path(results), Path(folder), names, SETTINGS)


def bench_models(results: str, *surveys: str) -> None:
    """What models and drawings hold, read back, beside the models that were driven through."""
    import models_bench

    models = (ROOT.parent / "shared/data/buildings").resolve()
    models_bench.bench(Path(results), models, surveys)


def bench_files(results: str, *words: str) -> None:
    """What validators and readers of others say of files."""
    import files_bench

    node = [word.removeprefix("node=") for word in words if word.startswith("node=")]
    surveys = [word for word in words if not word.startswith("node=")]
    files_bench.bench(ROOT, Path(results), surveys, *node)


def bench_presentation(results: str, truths: str, *names: str) -> None:
    """Regular drawings of simulated drives against their truths."""
    import presentation_bench

    presentation_bench.bench(Path(results), Path(truths), names, SETTINGS)


def bench_redraw(results: str, *names: str) -> None:
    """What would be redrawn of sheets."""
    import redraw_bench

    redraw_bench.bench(Path(results), names, SETTINGS)


def bench_odometry(folder: str, *names: str) -> None:
    """Poses of drives without a localiser against the truth."""
    import odometry_bench

    recordings = (ROOT.parent / "shared/data").resolve()
    drives = names or odometry_bench.drive_names()
    kept = Path(folder).resolve()
    sys.exit(not odometry_bench.bench(ROOT, SETTINGS, kept, recordings, drives))


def bench_overlays(count: str = "100000", first: str = "0") -> None:
    """Arrangements of slivers, arcs and near-coincident edges, by seeds."""
    import overlays_bench

    overlays_bench.bench(int(count), int(first), os.cpu_count() or 1)


def bench_growth(folder: str, *words: str) -> None:
    """What every stage takes of drives of several sizes."""
    import growth_bench

    times = [int(word) for word in words if word.isdigit()]
    series = [word for word in words if not word.isdigit()]
    kept = Path(folder).resolve()
    growth_bench.bench(ROOT, kept, times or (1, 2, 4, 8), series or growth_bench.SERIES)


def bench_stations(folder: str, *counts: str) -> None:
    """Stations of a terrestrial scanner: reading, and plans of them and of a merged cloud."""
    import stations_bench

    numbers = [int(count) for count in counts] or [10, 20, 30]
    stations_bench.bench(ROOT, SETTINGS, Path(folder).resolve(), numbers)


def bench_realistic(folder: str, revision: str = "HEAD", *words: str) -> None:
    """Plans of realistic buildings and real floors against what is true of them."""
    import realistic

    data = (ROOT.parent / "shared/data").resolve()
    realistic.run(ROOT, data, Path(folder).resolve(), revision, words)


def compare_realistic(before: str, after: str) -> None:
    """What two commits make of the same floors, element by element."""
    import realistic

    realistic.compare(Path(before), Path(after))


APART: dict[str, Callable[..., None]] = {
    "models": bench_models,
    "files": bench_files,
    "presentation": bench_presentation,
    "redraw": bench_redraw,
    "realistic": bench_realistic,
    "compare_realistic": compare_realistic,
    "ablate": ablate_rules,
    "guard": record_guard,
    "table": print_table,
    "compare": compare_guards,
    "fit_things": fit_things,
    "fit_partings": fit_partings,
    "confidence": fit_confidence,
    "next_visit": bench_next_visit,
    "odometry": bench_odometry,
    "overlays": bench_overlays,
    "walk": bench_walk,
    "growth": bench_growth,
    "stations": bench_stations,
    "pipeline": bench_pipeline,
    "changes": bench_changes,
    "design": bench_design,
    "sheets": bench_sheets,
    "ids": bench_ids,
}
USAGE = f"for what each takes see the first lines of {Path(__file__).relative_to(ROOT)}"
BENCHES: dict[str, Callable[[], None]] = {
    "simulation": bench_simulation,
    "registration": bench_registration,
    "selection": bench_selection,
    "walls": bench_walls,
}


def run_benches(words: Sequence[str]) -> None:
    """Run the benchmarks that are named, or those that take no minutes."""
    folders = [Path(word) for word in words if Path(word).is_dir()]
    names = [word for word in words if Path(word) not in folders]
    more = {"wall_quality": bench_wall_quality, "plans": lambda: bench_plans(folders)}
    more["validation"] = lambda: bench_validation(folders)
    known = BENCHES | more
    unknown = sorted(set(names) - set(known))
    if unknown:
        sys.exit(f"no benchmark {', '.join(unknown)}; there are {', '.join(known)}")
    for name in names or BENCHES:
        known[name]()


def run_named(words: Sequence[str]) -> None:
    """Run what a command names; refuse options, which there are none of, and words too few."""
    options = [word for word in words if word.startswith("-")]
    if options:
        sys.exit(f"{options[0]}: benchmarks have no options; {USAGE}")
    name, *given = words or [""]
    if name not in APART:
        return run_benches(words)
    try:
        inspect.signature(APART[name]).bind(*given)
    except TypeError as err:
        sys.exit(f"{name}: {err}; {USAGE}")
    return APART[name](*given)


if __name__ == "__main__":
    run_named(sys.argv[1:])
