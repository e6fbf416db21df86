"""The environment for conda, in step with the lock."""

import yaml

from conda_environment import format_conda_environment

LOCK = """\
one==1.0 \\
    --hash=sha256:00
two-more[extra]==2.1.0 ; sys_platform == 'win32' \\
    --hash=sha256:11
"""


def test_every_pin_is_one_of_pips_packages_as_it_stands():
    python, _, of_pip = yaml.safe_load(format_conda_environment(LOCK))["dependencies"]
    assert python == "python=3.11"
    assert of_pip["pip"] == ["one==1.0", "two-more[extra]==2.1.0 ; sys_platform == 'win32'"]


def test_the_file_is_in_step_with_the_lock(project_root):
    lock = (project_root / "environment.lock").read_text()
    assert (project_root / "environment.yaml").read_text() == format_conda_environment(lock)
