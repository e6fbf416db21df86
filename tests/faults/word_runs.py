"""Hostile words and surroundings through the real command: few, as each takes seconds."""

import os
import shutil
from functools import partial
from pathlib import Path

from faults import commands, judging
from helpers.project_copy import Project

_ROOT = Path(__file__).resolve().parents[2]
_DRAWN = ("plan/plan.pdf", "figures/walls.svg")
_HOSTILE_RC = "savefig.bbox: tight\nfont.size: 30\naxes.facecolor: red\nsavefig.dpi: 50\n"
_EXPORT = "plan={export: {author: %s}}"
_STOREYS = """\
storeys:
- {dataset: d, name: "{dataset} {x} \\ud83c\\udfe0", elevation_m: 0}
- {dataset: e, name: "a ^ b \\\\ <c>", elevation_m: 3}
"""


def try_words(folder, tally):
    """Try all of them in one copy of the project."""
    (folder / "words_project").mkdir()
    project = Project(_ROOT, folder / "words_project")
    for name in ("d", "e"):
        commands.write_dataset(project.folder / name)
    _try_arguments(project, tally)
    _try_files(project, tally)
    _try_figures(project, tally)


def _try_arguments(project, tally):
    cases = {
        "a dataset with NUL": ['dataset=["a\\0b"]'],
        "a key with a colour code": ["dataset=d", '"\x1b[31m"=1'],
        "+ a value with a colour code": ["dataset=d", 'plan={method: "\\e[31m"}'],
        "+ half of a character": ["dataset=d", _EXPORT % '"\\ud83c"'],
        "+ an author of 201 letters": ["dataset=d", _EXPORT % ("a" * 201)],
    }
    for name, given in cases.items():
        _judge(project, tally, name, ["--config", *given])
    fine = {
        "+ an author in braces": ["dataset=d", _EXPORT % '"{dataset} {wildcards.x}"'],
        "an author of a pair": ["dataset=d", _EXPORT % '"\\ud83c\\udfe0"'],
    }
    for name, given in fine.items():
        _judge(project, tally, name, ["--config", *given], may_pass=True)
    _judge(project, tally, "+ a target with a colour code", ["\x1b[31m", "--config", "dataset=d"])


def _try_files(project, tally):
    put = project.folder
    cases = {
        "d/dataset.yaml": os.mkfifo,
        "d/corrections.yaml": os.mkfifo,
        "floors.tsv": os.mkfifo,
        "matplotlibrc": os.mkfifo,
        "+ ezdxf.ini": lambda path: path.write_text("words"),
        "+ Building.yml": lambda path: path.write_text(_STOREYS),
        "corrections.yml": lambda path: path.write_text("corrections: []"),
        "+ building.yaml with names in braces": lambda path: path.write_text(_STOREYS),
    }
    for name, make in cases.items():
        path = put / {"corrections.yml": "d/corrections.yml"}.get(name, name.removeprefix("+ "))
        path = path.with_name(path.name.partition(" ")[0])
        make(path)
        given = "floors.tsv" if path.suffix == ".tsv" else '["d", "e"]'
        is_told = path.suffix == ".yml"
        is_fine = is_told or path.name == "building.yaml"
        told = "is not used" if is_told else ""
        _judge(project, tally, name, ["--config", f"dataset={given}"], may_pass=is_fine, told=told)
        path.unlink()


def _judge(project, tally, name, arguments, *, may_pass=False, told=""):
    run = partial(commands.run_arguments, project, "--dry-run", *arguments, longest_s=120)
    outcome, said = run(may_pass=may_pass)
    if outcome == judging.SOUND and told:
        outcome = judging.TOLD if told in said else judging.SILENT
    if "\x1b" in said:
        outcome = judging.NO_LINE
    tally.add("words in runs", name, outcome, said, peak_mb=judging.children_peak_mb())


def _try_figures(project, tally):
    """Draw the demo with settings of a user's: the same bytes as without."""
    targets = [f"results/demo/{file}" for file in _DRAWN]
    outcome, said = commands.run_arguments(project, *targets)
    if outcome != judging.SOUND:
        tally.add("foreign settings", "the demo left in peace", outcome, said)
        return
    right = project.digests()
    (project.folder / "matplotlibrc").write_text(_HOSTILE_RC)
    (project.folder / "ezdxf.ini").write_text("[core]\nstore_proxy_graphics = false\n")
    for name, variables in {
        "matplotlibrc, a backend of nonsense": {"MPLBACKEND": "nonsense"},
        "+ MATPLOTLIBRC that is a pipe": {"MATPLOTLIBRC": str(project.folder / "pipe")},
        "+ MPLCONFIGDIR that is a device": {"MPLCONFIGDIR": "/dev/null"},
    }.items():
        shutil.rmtree(project.folder / "results/demo/figures")
        for file in (project.folder / "results/demo/plan").glob("plan.*"):
            file.unlink()
        (project.folder / "pipe").unlink(missing_ok=True)
        os.mkfifo(project.folder / "pipe")
        outcome, said = commands.run_arguments(project, *targets, variables=variables)
        if outcome == judging.SOUND and project.digests() != right:
            outcome = judging.SILENT
        tally.add("foreign settings", name, outcome, said, peak_mb=judging.children_peak_mb())
