"""A copy of the project to run the whole workflow in."""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

TINY = "tests/data/tiny.yaml"


class Project:
    """A copy of the project to run in, so that edits and results touch nothing else."""

    def __init__(self, root, folder):
        self.folder = folder
        for name in ("Snakefile", "workflow", "scripts", "config", "tests/data", "profiles"):
            source, target = root / name, folder / name
            if source.is_symlink():
                target.symlink_to(source.readlink())
            elif source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy2(source, target)

    def command(self, *arguments):
        settings = () if "--configfile" in arguments else ("--configfile", TINY)
        return [sys.executable, "-m", "snakemake", *settings, "--cores", "2", *arguments]

    def run(self, *arguments):
        return subprocess.run(
            self.command(*arguments),
            cwd=self.folder,
            env=self.env(),
            capture_output=True,
            text=True,
        )

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
