"""Types that need no NumPy: for modules that every job imports while the workflow is parsed."""

import os
from collections.abc import Mapping
from typing import Any

FilePath = str | os.PathLike[str]
Settings = Mapping[str, Any]
"""Nested values of a configuration, as YAML gives them."""
