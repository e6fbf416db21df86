"""A copy of the project to run the whole workflow in."""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from helpers.warm_python import serve_python

TINY = "tests/data/tiny.yaml"
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

    def command(self, *arguments, cores=1):
        settings = () if "--configfile" in arguments else ("--configfile", TINY)
        return [sys.executable, "-m", "snakemake", *settings, "--cores", str(cores), *arguments]

    def run(self, *arguments, cores=1):
        """Run Snakemake, and its stages, in processes that have read the libraries already.

        Files of tests run side by side, and a stage with one core begins no processes of its own.
        """
        return run_python(self.folder, self.command(*arguments, cores=cores)[1:], self.env())

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


def run_python(folder, arguments, env):
    """Run Python as a process that has read the libraries already; return it as completed."""
    with tempfile.TemporaryDirectory() as place, serve_python(place) as python:
        command = [python, *arguments]
        return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True)
