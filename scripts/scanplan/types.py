"""Types that many modules share; shapes stand in the docstrings."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from scanplan.plain_types import FilePath, Settings

__all__ = ["Array", "BoolArray", "Columns", "FilePath", "FloatArray", "IntArray", "Settings"]

Array = npt.NDArray[Any]
FloatArray = npt.NDArray[np.floating[Any]]
IntArray = npt.NDArray[np.integer[Any]]
BoolArray = npt.NDArray[np.bool_]
Columns = Mapping[str, Array]
"""A table: columns of equal length by name."""
