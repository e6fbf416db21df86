"""What several tests share."""

from pathlib import Path

import hypothesis
import pytest

# a shared machine is slow at times: how long an example takes says nothing of the code
hypothesis.settings.register_profile(
    "steady", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile("steady")

ROOT = Path(__file__).resolve().parents[1]


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
