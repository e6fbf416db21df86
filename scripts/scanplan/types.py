"""Types that many modules share; shapes stand in the docstrings."""

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

FilePath = str | os.PathLike[str]
Array = npt.NDArray[Any]
FloatArray = npt.NDArray[np.floating[Any]]
IntArray = npt.NDArray[np.integer[Any]]
BoolArray = npt.NDArray[np.bool_]
Columns = Mapping[str, Array]
"""A table: columns of equal length by name."""
Settings = Mapping[str, Any]
"""Nested values of a configuration, as YAML gives them."""
