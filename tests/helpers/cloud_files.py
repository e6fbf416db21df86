"""Clouds in files."""

import numpy as np


def write_pcd(path, xyz_m, extra=None):
    """A binary PCD, fields x y z and optionally a float32 field `extra`: (name, values)."""
    columns, names = [np.asarray(xyz_m, np.float32)], "x y z"
    if extra:
        columns.append(np.asarray(extra[1], np.float32)[:, None])
        names += f" {extra[0]}"
    n = names.count(" ") + 1
    header = (
        f"# .PCD v0.7\nVERSION 0.7\nFIELDS {names}\n"
        f"SIZE{' 4' * n}\nTYPE{' F' * n}\nCOUNT{' 1' * n}\n"
        f"WIDTH {len(xyz_m)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(xyz_m)}\nDATA binary\n"
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode() + np.hstack(columns).tobytes())
    return path
