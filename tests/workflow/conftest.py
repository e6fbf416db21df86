import fcntl
import os

import pytest

from helpers.project_copy import Project


@pytest.fixture(scope="session")
def planned(project_root, tmp_path_factory):
    """A project with the plan of the demo in two rooms, made once for all processes of tests.

    Whoever changes it copies it; `said.txt` is what its run said.
    """
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "planned"
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "said.txt").exists():
            made = Project(project_root, folder).run(cores=2)
            assert made.returncode == 0, made.stdout + made.stderr
            assert made.stdout == ""
            (folder / "said.txt").write_text(made.stderr)
    return folder
