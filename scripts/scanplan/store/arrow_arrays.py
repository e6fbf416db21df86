"""Arrow's arrays from numpy's and back, without pandas.

Arrow's own conversions import pandas, where it is installed, to look whether what they are given is
a Series: half a second of every process that reads or writes a table.
"""

from collections.abc import Sequence

import numpy as np
import pyarrow as pa

from scanplan.types import Array


def to_arrow(values: Array | Sequence[object], form: pa.DataType) -> pa.Array:
    """Return values (n,) as an Arrow array of a type.

    Raises
    ------
    pyarrow.ArrowException
        If they do not fit the type, or one is None.
    """
    if pa.types.is_string(form) or pa.types.is_binary(form):
        return _pack_bytes(values, form)
    column = np.asarray(values)
    if column.dtype == object:
        raise pa.ArrowInvalid(f"objects in a column of {form}")
    column = np.ascontiguousarray(column)
    if column.dtype == bool:
        packed = np.packbits(column, bitorder="little")
        return pa.Array.from_buffers(pa.bool_(), len(column), [None, pa.py_buffer(packed)])
    own = pa.from_numpy_dtype(column.dtype)
    array = pa.Array.from_buffers(own, len(column), [None, pa.py_buffer(column)])
    return array.cast(form)


def to_numpy(column: pa.ChunkedArray) -> Array:
    """Return a column without nulls as numpy's array (n,), strings and bytes as objects."""
    if pa.types.is_boolean(column.type):
        return np.array(column.to_pylist(), bool)
    if not pa.types.is_primitive(column.type):
        return np.array([*column.to_pylist(), None], object)[:-1]
    chunks = [np.from_dlpack(chunk) for chunk in column.chunks]
    return np.concatenate(chunks or [np.empty(0, column.type.to_pandas_dtype())])


def _pack_bytes(values: Array | Sequence[object], form: pa.DataType) -> pa.Array:
    encoded: list[bytes] = []
    for value in values:
        if not isinstance(value, str | bytes):
            raise pa.ArrowInvalid(f"a column of {form} holds something else")
        encoded.append(value.encode() if isinstance(value, str) else value)
    ends = np.cumsum([0, *map(len, encoded)], dtype=np.int32)
    buffers = [None, pa.py_buffer(ends), pa.py_buffer(b"".join(encoded))]
    return pa.Array.from_buffers(form, len(encoded), buffers)
