"""A copy of the project to run the whole workflow in."""

import hashlib
import multiprocessing
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

TINY = "tests/data/tiny.yaml"
_ROOT = Path(__file__).resolve().parents[2]
_STARTER = multiprocessing.get_context("forkserver")
_STARTER.set_forkserver_preload(
    ["snakemake.cli", "snakemake.report.html_reporter", "jsonschema", "numpy", "yaml"]
)


_CODE = ("Snakefile", "workflow", "scripts", "config", "tests/data", "profiles")
_MADE = (".snakemake", "benchmarks", "logs", "results")


class Project:
    """A copy of the project to run in, so that edits and results touch nothing else."""

    def __init__(self, root, folder, *, made=False):
        """Copy the code of a project, and what was made in it where that is asked for."""
        self.folder = folder
        for name in (*_CODE, *(_MADE if made else ())):
            source, target = root / name, folder / name
            if source.is_symlink():
                target.symlink_to(source.readlink())
            elif source.is_dir():
                # with what is compiled of it, which each copy would compile anew
                shutil.copytree(source, target)
            else:
                shutil.copy2(source, target)

    def command(self, *arguments):
        settings = () if "--configfile" in arguments else ("--configfile", TINY)
        return [sys.executable, "-m", "snakemake", *settings, "--cores", "2", *arguments]

    def run(self, *arguments):
        """Run Snakemake in a process that has read it already: half of what a dry run takes."""
        command = self.command(*arguments)
        with tempfile.TemporaryDirectory() as said:
            streams = [Path(said, name) for name in ("stdout", "stderr")]
            started = _STARTER.Process(
                target=_run_snakemake, args=(command, self.folder, self.env(), streams)
            )
            started.start()
            started.join()
            stdout, stderr = (stream.read_text(encoding="utf-8") for stream in streams)
        return subprocess.CompletedProcess(command, started.exitcode, stdout, stderr)

    def env(self):
        return {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}

    def would_run(self, *arguments):
        """Rules that a run would execute."""
        result = self.run("--quiet", "reason", "--dry-run", *arguments)
        assert result.returncode == 0, result.stderr
        lines = [line for line in result.stdout.splitlines() if line.startswith("rule ")]
        return {line.split()[1].rstrip(":") for line in lines} - {"all", "comparison"}

    def digests(self):
        # these tell run times
        timed = {"report.html", "seconds.parquet", "summary.html", "summary.parquet"}
        files = [
            p for p in (self.folder / "results").rglob("*") if p.is_file() and p.name not in timed
        ]
        return {
            str(p.relative_to(self.folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(files)
        }


def _run_snakemake(command, folder, env, streams):
    """Run a command `python -m snakemake ...` in this process, which is a new one."""
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(env)
    for stream, path in zip((sys.stdout, sys.stderr), streams, strict=True):
        written = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(written, stream.fileno())
    # as if this were not the tests': their code is not the copy's
    ours = {os.fspath(_ROOT / name) for name in ("", "scripts", "tests")}
    sys.path[:] = [os.fspath(folder), *(place for place in sys.path if place not in ours)]
    sys.argv = command[command.index("snakemake") :]
    # a run that goes on without a failed stage begins again by these
    sys.orig_argv[:] = command
    from snakemake.cli import main

    main()
