"""Runs of the whole command in odd surroundings: what is heard, what is told, and the same bytes.

Streams, variables, working folders, a disk that fails, memory, other runs, files that come and go.
"""

import os
import re
import shutil
import subprocess
import time
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from faults import judging
from helpers import bag_making
from helpers.project_copy import Project

_ROOT = Path(__file__).resolve().parents[2]
_HOOK = Path(__file__).parent / "hook"
_LONGEST_S = 600
_TARGET = "results/d/registration.parquet"
_GIVEN = ("--config", 'dataset=["d"]')
_TRACE = re.compile("Traceback|unexpected failure")
_NO_READER = "> >(exec true)"
_STREAMS = {
    **dict.fromkeys((">&-", "2>&-", "<&-", ">/dev/full", "2>/dev/full", "</dev/full"), True),
    **dict.fromkeys((_NO_READER, f"2{_NO_READER}", "2>&0", ">/dev/null"), True),
    **dict.fromkeys((">&- 2>&-", ">&- 2>&- <&-", ">/dev/full 2>/dev/full"), False),
    **dict.fromkeys((">&- 2>/dev/full", ">/dev/full 2>&-", f"{_NO_READER} 2>&1"), False),
    **dict.fromkeys(("2>/dev/null", "2>&0 0>&-  >&-"), False),
}
"""What a shell does to the streams, and whether anybody can hear what is said."""
_VARIABLES = {
    **{f"HOME={place}": {"HOME": place} for place in ("/dev/null", "/nowhere", "", "/dev/full")},
    **{f"TMPDIR={place}": {"TMPDIR": place} for place in ("/dev/null", "/nowhere", ".", "/proc")},
    "XDG_CACHE_HOME=/dev/full": {"XDG_CACHE_HOME": "/dev/full"},
    "XDG_CONFIG_HOME=/dev/null": {"XDG_CONFIG_HOME": "/dev/null"},
    "MPLCONFIGDIR=/dev/null": {"MPLCONFIGDIR": "/dev/null"},
    "SNAKEMAKE_PROFILE=nowhere": {"SNAKEMAKE_PROFILE": "nowhere"},
    "SNAKEMAKE_PROFILE=": {"SNAKEMAKE_PROFILE": ""},
    "SNAKEMAKE_OUTPUT_CACHE=/nowhere": {"SNAKEMAKE_OUTPUT_CACHE": "/nowhere"},
    **{
        f"{name}={value}": {name: value}
        for name, value in (
            ("PYTHONWARNINGS", "error"),
            ("PYTHONWARNINGS", "nonsense::"),
            ("PYTHONOPTIMIZE", "2"),
            ("PYTHONDEVMODE", "1"),
            ("PYTHONUNBUFFERED", "1"),
            ("PYTHONIOENCODING", "ascii:strict"),
            ("PYTHONIOENCODING", "utf-16"),
            ("PYTHONUTF8", "0"),
            ("PYTHONSAFEPATH", "1"),
            ("PYTHONHASHSEED", "0"),
            ("PYTHONPYCACHEPREFIX", "/dev/null"),
            ("PYTHONTRACEMALLOC", "5"),
            ("PYTHONMALLOC", "debug"),
            ("PYTHONNOUSERSITE", "1"),
            ("PYTHONBREAKPOINT", "nowhere.at_all"),
            ("PYTHONINTMAXSTRDIGITS", "640"),
            ("PYTHONPLATLIBDIR", "lib"),
            ("LC_ALL", "C"),
            ("LC_ALL", "nonsense"),
            ("LANG", ""),
            ("TZ", "nonsense/nowhere"),
            ("COLUMNS", "0"),
            ("COLUMNS", "-1"),
            ("TERM", "nonsense"),
            ("OMP_NUM_THREADS", "0"),
            ("OMP_NUM_THREADS", "many"),
            ("OPENBLAS_NUM_THREADS", "999"),
            ("NUMEXPR_MAX_THREADS", "0"),
            ("MALLOC_ARENA_MAX", "nonsense"),
            ("MALLOC_PERTURB_", "170"),
            ("SHELL", "/bin/false"),
            ("BASH_ENV", "/dev/null"),
            ("CDPATH", "/"),
            ("IFS", "/"),
            ("POSIXLY_CORRECT", "1"),
            ("USER", ""),
            ("SCANPLAN_LEFT_OUT", "d/plan_next_visit x/y"),
            ("SCANPLAN_MEMORY_KILLS", "0"),
        )
    },
}
_FAILING = (
    *("fsync:EIO:", "fsync:EIO:registration", "fsync:ENOSPC:scans", "fsync:EDQUOT:poses"),
    *("fsync:EINVAL:", "fsync:ESTALE:motion", "replace:EIO:", "replace:EPERM:results"),
    *("replace:ENOENT:scans", "unlink:EPERM:results", "unlink:EROFS:", "unlink:EIO:.snakemake"),
    *("chmod:EPERM:", "chmod:ENOTSUP:results", "mkdir:ENOSPC:logs", "mkdir:EIO:results"),
    *("utime:EPERM:", "symlink:EPERM:", "listdir:EIO:results", "link:EPERM:"),
)
_FOLDERS = {
    "bytes": b"n\xff",
    "bytes of Latin 1": "büro".encode("latin"),
    "a line break": b"a\nb",
    "an escape": b"a\x1b[31mb",
    "spaces": b" a  b ",
    "signs": b"$(touch pwned);'\"`",
    "wide letters": "図面 🏠".encode(),
    "a wildcard": b"{dataset}",
    "a glob": b"[a-z]*?",
    "a percent": b"%s%n",
    "3,750 bytes": b"/".join([b"x" * 200] * 18 + [b"y" * 140]),
}


@dataclass
class _Place:
    """A copy of the project with a dataset, and what an undisturbed run makes of it."""

    project: Project
    right: dict = field(default_factory=dict)

    def run(self, line, *, is_heard=True, may_fail=True, fresh=True, target=_TARGET, **env):
        """Run a line of a shell in which "$@" is the command; return outcome and last line."""
        if fresh:
            shutil.rmtree(self.project.folder / "results", ignore_errors=True)
        python_path = os.pathsep.join([str(self.project.folder / "scripts/startup"), str(_HOOK)])
        command = self.project.command(*([target] if target else []), *_GIVEN)
        try:
            run = subprocess.run(
                ["bash", "-c", line, "bash", *command],
                cwd=self.project.folder,
                env=self.project.env() | {"PYTHONPATH": python_path} | env,
                capture_output=True,
                timeout=_LONGEST_S,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return judging.HANG, ""
        said = (run.stdout + run.stderr).decode(errors="replace").splitlines()
        told = [s for s in said if s.startswith("scanplan: ")]
        last = " | ".join(told[-2:]) or (said[-1] if said else "")
        if _TRACE.search(" ".join(said)):
            return judging.UNEXPECTED, last
        is_right = {
            f: d for f, d in self.project.digests().items() if f in self.right
        } == self.right
        if run.returncode == 0 or (not is_heard and is_right):
            return (judging.SOUND if is_right else judging.SILENT), last
        if not may_fail:
            return judging.NO_LINE, last
        return (judging.CLEAR if told or not is_heard else judging.NO_LINE), last


def try_kind(kind, folder, tally, _):
    """Try one of `KINDS`."""
    kind(_make_place(folder / f"odd {kind.__name__}"), partial(_add, tally))


def try_streams(place, add):
    """Streams that carry nothing, of a sound run and of one that has a fault to tell."""
    for streams, is_heard in _STREAMS.items():
        given = {"line": f'"$@" {streams}', "is_heard": is_heard}
        add("streams", streams, place.run(**given))
        outcome, said = place.run(**given, target="results/e/x")
        # what cannot be made has to be said
        is_passed = outcome in (judging.SOUND, judging.SILENT)
        add("streams, of a fault", streams, (judging.SILENT if is_passed else outcome, said))


def try_variables(place, add):
    """Variables of the environment, and names of working folders."""
    for name, variables in _VARIABLES.items():
        add("variables", name, place.run('"$@"', **variables))
    for kind, name in _FOLDERS.items():
        add("working folders", kind, _run_in(place, name))


def try_disk(place, add):
    """Calls of the system that fail in every process, and the same command after that."""
    for fault in _FAILING:
        outcome = place.run('"$@"', FAULT=fault)
        add("calls that fail", fault, outcome)
        add("calls that fail", f"after {fault}", place.run('"$@"', may_fail=False, fresh=False))


def try_others(place, add):
    """Files, clocks and other runs that change what a run works on."""
    for ahead_s in (7200, -7200, 3e9, -1e9, 30):
        given = f"clock:{ahead_s}:"
        add("clocks", f"files dated {ahead_s:g} s ahead", place.run('"$@"', FAULT=given))
        again = place.run('"$@"', fresh=False)
        add("clocks", f"after {ahead_s:g} s", again)
    script = place.project.folder / "scripts/interpolate_poses.py"
    bag = place.project.folder / "d/run.bag"
    for name, change in _CHANGES.items():
        sound, content = script.read_text(), bag.read_bytes()
        script.write_text(f"{sound}\n    import os\n    {change}\n")
        add("recordings that change", name, place.run('"$@"'))
        script.write_text(sound)
        bag.write_bytes(content)
        add("recordings that change", f"after: {name}", place.run('"$@"', may_fail=False))
    _try_two_runs(place, add)


_CHANGES = {
    "gone": "os.unlink('d/run.bag')",
    "cut": "os.truncate('d/run.bag', 5000)",
    "emptied": "os.truncate('d/run.bag', 0)",
    "grown": "open('d/run.bag', 'ab').write(bytes(100))",
    "a folder": "os.unlink('d/run.bag'); os.mkdir('d/run.bag'); os.rmdir('d/run.bag')",
    "a dangling link": "os.unlink('d/run.bag'); os.symlink('nowhere', 'd/run.bag')",
    "unreadable": "os.replace('d/run.bag', 'd/x'); os.symlink('x', 'd/run.bag'); os.unlink('d/x')",
}


def _try_two_runs(place, add):
    """Two runs at once, in one folder and in two with one results/."""
    other = place.project.folder.with_name("beside")
    shutil.rmtree(other, ignore_errors=True)
    shutil.copytree(
        place.project.folder, other, symlinks=True, ignore=shutil.ignore_patterns(".snakemake")
    )
    shutil.rmtree(other / "results", ignore_errors=True)
    (other / "results").symlink_to(place.project.folder / "results")
    for name, where in (("one folder", place.project.folder), ("one results/", other)):
        for delay_s in (0.0, 1.0, 3.0):
            add("two runs", f"{name}, {delay_s:g} s apart", _run_twice(place, where, delay_s))
    shutil.rmtree(other)


def _run_twice(place, where, delay_s):
    shutil.rmtree(place.project.folder / "results", ignore_errors=True)
    (place.project.folder / "results").mkdir()
    runs = []
    for folder in (place.project.folder, where):
        command = place.project.command(_TARGET, *_GIVEN)
        python_path = str(folder / "scripts/startup")
        env = place.project.env() | {"PYTHONPATH": python_path}
        runs.append(
            subprocess.Popen(
                command, cwd=folder, env=env, stdout=-1, stderr=subprocess.STDOUT, text=True
            )
        )
        time.sleep(delay_s)
    said = [run.communicate(timeout=_LONGEST_S)[0] for run in runs]
    told = " | ".join(line for text in said for line in text.splitlines() if "scanplan: " in line)
    if _TRACE.search(" ".join(said)):
        return judging.UNEXPECTED, told
    failed = [text for run, text in zip(runs, said, strict=True) if run.returncode]
    if any("another run" not in text for text in failed):
        return judging.NO_LINE, " ".join(failed)[-200:]
    if len(failed) == 2:
        return judging.CLEAR, told
    is_right = place.project.digests() == place.right
    return (judging.SILENT if not is_right else judging.CLEAR if failed else judging.SOUND), told


def _make_place(folder):
    (folder / "project").mkdir(parents=True)
    project = Project(_ROOT, folder / "project")
    maker = bag_making.Maker()
    (project.folder / "d").mkdir()
    maker.write(project.folder / "d/run", bag_making.survey(maker, n_scans=12))
    place = _Place(project)
    place.run('"$@"')
    place.right = project.digests()
    return place


def _run_in(place, name):
    folder = os.fsencode(place.project.folder.parent) + b"/" + name
    Path(os.fsdecode(folder)).mkdir(parents=True, exist_ok=True)
    for entry in ("Snakefile", "workflow", "scripts", "config", "tests", "profiles", "d"):
        Path(os.fsdecode(folder), entry).symlink_to(place.project.folder / entry)
    # the dataset lies elsewhere from there, and its note of the source says so
    right = {file: digest for file, digest in place.right.items() if "source.txt" not in file}
    moved = _Place(_Moved(place.project, folder), right)
    return moved.run('cd "$WHERE" && "$@"', fresh=False, WHERE=os.fsdecode(folder))


class _Moved:
    """A project whose command is given in another working folder."""

    def __init__(self, project, folder):
        self.folder = project.folder
        self.command, self.env = project.command, project.env
        self._where = Path(os.fsdecode(folder))

    def digests(self):
        results = self._where / "results"
        shown = Project.__new__(Project)
        shown.folder = results.parent
        return shown.digests()


def _add(tally, group, name, judged):
    outcome, said = judged
    tally.add(group, name, outcome, said, peak_mb=judging.children_peak_mb())
    print(f"{group:<24}{name[:40]!r:<44}{outcome:<12}{said}"[:320], flush=True)


KINDS = {
    "streams": try_streams,
    "variables": try_variables,
    "disk": try_disk,
    "others": try_others,
}
"""Kinds of odd surroundings by name."""
