"""What several tests share."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import hypothesis
import pytest
from shapely.geometry.base import BaseGeometry

from helpers import browser

# a shared machine is slow at times: how long an example takes says nothing of the code
hypothesis.settings.register_profile(
    "steady", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile("steady")

ROOT = Path(__file__).resolve().parents[1]


def refuse_in_scripts(operator: Callable[..., Any]) -> Callable[..., Any]:
    """Return an operator of geometries that the code of `scripts/` may not use, as tests may.

    What a name is of cannot be read from the code, as for the calls that `test_house` looks for.
    """
    scripts = str(ROOT / "scripts")

    def checked(one: BaseGeometry, other: BaseGeometry) -> Any:
        caller = sys._getframe(1).f_code
        assert not caller.co_filename.startswith(scripts), f"{caller}: ask geometry/overlays.py"
        return operator(one, other)

    return checked


for name in ("__or__", "__and__", "__sub__", "__xor__"):
    setattr(BaseGeometry, name, refuse_in_scripts(getattr(BaseGeometry, name)))


@pytest.fixture(scope="session")
def project_root():
    return ROOT


@pytest.fixture(scope="session")
def recordings_dir():
    """Return the folder of the real recordings beside the project; skip where there is none."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("no real recordings beside the project (../shared/data)")
    return folder


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the workflow's tests first: the short ones fill what is left at the end of each core."""
    items.sort(key=lambda item: item.get_closest_marker("workflow") is None)


@pytest.fixture(scope="module")
def chromium(tmp_path_factory):
    """A headless browser for the tests of a file."""
    with browser.Page(tmp_path_factory.mktemp("browser")) as page:
        yield page
