"""PTX files, written as Leica's programs do: a header and a line for every beam."""

from pathlib import Path

import numpy as np


def write_ptx(path, poses, points, rgb=None, *, moved=False):
    """Write scans (n, 3) in their own frames with poses (4, 4); NaN is a beam without a return.

    With `moved` points are in the world, and the transformation says nothing. Points of all scans
    may have the same colours (n, 3) of 0 to 255.
    """
    text = []
    for pose, xyz_m in zip(poses, points, strict=True):
        shown = xyz_m @ pose[:3, :3].T + pose[:3, 3] if moved else xyz_m
        matrix = np.eye(4) if moved else pose
        rows = [[len(xyz_m)], [1], pose[:3, 3], *pose[:3, :3].T, *matrix.T]
        text += [" ".join(f"{value:.9g}" for value in row) for row in rows]
        lines = [
            "0 0 0 0.500000" if np.isnan(x) else f"{x:.6f} {y:.6f} {z:.6f} 0.500000"
            for x, y, z in shown.tolist()
        ]
        shades = [""] * len(lines) if rgb is None else [f" {r} {g} {b}" for r, g, b in rgb.tolist()]
        text += [line + shade for line, shade in zip(lines, shades, strict=True)]
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\r\n".join(text) + "\r\n")
    return path
