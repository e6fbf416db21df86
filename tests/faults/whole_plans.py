"""Faults of whole runs of the tiny office: each stage that fails, and a full disk at every write.

Whatever fails, the rest of what a plan is made of comes out, and the same command ends with the
bytes of a run that was left in peace.
"""

import subprocess
from pathlib import Path

from faults import judging
from helpers.project_copy import Project
from scanplan.project.run import optional_stages

_ROOT = Path(__file__).resolve().parents[2]
_HOOK = Path(__file__).parent / "hook"
_DOES = {
    "raises": "raise RuntimeError('on purpose')",
    "is killed": "__import__('os').kill(__import__('os').getpid(), 9)",
    "exits": "__import__('os')._exit(3)",
    "has no memory": "raise MemoryError",
}
_BEGINS = "with log.log_to_file(snakemake.log[0]):\n"
_DRAWINGS = {f"plan/plan.{suffix}" for suffix in ("geojson", "pdf", "dxf")}
_MADE_BY = {"export_plan": _DRAWINGS, "write_report": {"report.html"}}


def try_whole_plans(folder, tally, *, n_stages=None, n_files=None):
    """Try so many stages, and files that are written; all of them by default."""
    (folder / "whole").mkdir()
    project = Project(_ROOT, folder / "whole")
    run = _run(project)
    if run.returncode:
        tally.add("stages that fail", "none", judging.NO_LINE, run.stderr[-200:])
        return
    right = project.digests()
    stages = [log.stem for log in sorted((project.folder / "logs/demo").glob("*.log"))]
    known = [s for s in stages if (project.folder / f"scripts/{s}.py").is_file()]
    for number, stage in enumerate(known[:n_stages]):
        how = list(_DOES)[number % len(_DOES)]
        outcome, said = _fail_stage(project, stage, _DOES[how])
        _add(tally, "stages that fail", f"{stage} {how}", outcome, said)
    # a title block names the code, which a spoilt script was a part of when sheets were drawn
    for drawn in (project.folder / "results/demo/plan").glob("plan.*"):
        drawn.unlink()
    _add(tally, "stages that fail", "the same command after all", *_compare(project, right))
    written = sorted(
        (project.folder / "results/demo").rglob("*.*"), key=lambda p: p.stat().st_mtime
    )
    stems = dict.fromkeys((path.parent, path.stem) for path in written if path.is_file())
    for place, stem in list(stems)[:n_files]:
        outcome, said = _fill_disk(project, place, stem)
        _add(tally, "disk full at a write", f"{place.name}/{stem}", outcome, said)
    _add(tally, "disk full at a write", "the same command after all", *_compare(project, right))


def _fail_stage(project, stage, does):
    script = project.folder / f"scripts/{stage}.py"
    whole = script.read_text()
    script.write_text(whole.replace(_BEGINS, f"{_BEGINS}        {does}\n"))
    run = _run(project)
    script.write_text(whole)
    outcome, told = _judge(run)
    if outcome == judging.CLEAR and not told.startswith(f"scanplan: {stage}: "):
        return judging.NO_LINE, told
    is_optional = stage in optional_stages.NEEDED_BY
    wanted = (_DRAWINGS | {"report.html"}) - _MADE_BY.get(stage, set())
    here = {name for name in wanted if (project.folder / "results/demo" / name).is_file()}
    if is_optional and here != wanted:
        return judging.SILENT, f"{sorted(wanted - here)} spoilt; {told}"
    return outcome, told


def _fill_disk(project, place, stem):
    for path in place.glob(f"{stem}.*"):
        path.unlink()
    outcome, told = _judge(_run(project, FAULT=f"fsync:ENOSPC:{place.name}/.{stem}."))
    if outcome == judging.CLEAR and "cannot be written" not in told:
        return judging.NO_LINE, told
    if outcome == judging.SILENT and not list(place.glob(f"{stem}.*")):
        return judging.SOUND, "nothing that is made of it was lacking, so it was not written"
    return outcome, told


def _judge(run):
    """Return the outcome of a run that has to fail with a line, and its last line."""
    said = run.stdout + run.stderr
    told = [line for line in said.splitlines() if line.startswith("scanplan: ")]
    last = told[-1] if told else said[-200:]
    if "Traceback" in said:
        return judging.UNEXPECTED, last
    if run.returncode == 0:
        return judging.SILENT, last
    return (judging.CLEAR if told else judging.NO_LINE), last


def _compare(project, right):
    run = _run(project)
    if run.returncode:
        return judging.NO_LINE, run.stderr[-200:]
    return (judging.SOUND if project.digests() == right else judging.SILENT), ""


def _run(project, **env):
    python_path = f"{project.folder / 'scripts/startup'}:{_HOOK}"
    return subprocess.run(
        project.command(),
        cwd=project.folder,
        env=project.env() | {"PYTHONPATH": python_path} | env,
        capture_output=True,
        text=True,
        check=False,
    )


def _add(tally, group, name, outcome, said):
    tally.add(group, name, outcome, said, peak_mb=judging.children_peak_mb())
    print(f"{group:<24}{name:<44}{outcome:<12}{said}"[:320], flush=True)
