"""Write environment.yaml, for conda and its kin, with the versions that environment.lock pins."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEAD = """\
# The packages of environment.lock for conda and its kin: conda env create -f environment.yaml
# Written by tests/conda_environment.py from the lock, which alone has hashes.
name: scanplan
channels:
  - conda-forge
  - nodefaults
dependencies:
  - python=3.11
  - pip
  - pip:
"""
_PIN = re.compile(r"^\w[\w.\[\]-]*==[^\\\n]*", re.MULTILINE)


def format_conda_environment(lock):
    """Return the text of environment.yaml."""
    pins = [f'      - "{pin.strip()}"\n' for pin in _PIN.findall(lock)]
    return HEAD + "".join(pins)


if __name__ == "__main__":
    lock = (ROOT / "environment.lock").read_text()
    (ROOT / "environment.yaml").write_text(format_conda_environment(lock))
