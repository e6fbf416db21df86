"""Solid boxes as triangles, to build small buildings of: every face of them is known."""

import numpy as np
import trimesh


def box(x0, y0, z0, x1, y1, z1):
    """Twelve triangles (12, 3, 3), normals outwards."""
    made = trimesh.creation.box(bounds=[[x0, y0, z0], [x1, y1, z1]])
    return np.array(made.triangles, float)


def room(height_m=2.5, door=(1.5, 2.5)):
    """Walls of 0.2 m round 4 m x 3 m clear with a door in the south, floor, ceiling: (t, 3, 3)."""
    a, b = door
    walls = [
        box(-0.2, -0.2, 0, a, 0, height_m),
        box(b, -0.2, 0, 4.2, 0, height_m),
        box(a, -0.2, 2.0, b, 0, height_m),
        box(-0.2, 0, 0, 0, 3, height_m),
        box(4, 0, 0, 4.2, 3, height_m),
        box(-0.2, 3, 0, 4.2, 3.2, height_m),
    ]
    slabs = [
        box(-0.2, -0.2, -0.2, 4.2, 3.2, 0),
        box(-0.2, -0.2, height_m, 4.2, 3.2, height_m + 0.2),
    ]
    return np.concatenate(walls + slabs)


def written(triangles_m, file_type):
    """The bytes of a mesh file: stl (binary), stl_ascii, obj or ply."""
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles_m), process=False)
    data = mesh.export(file_type=file_type)
    return data.encode() if isinstance(data, str) else data
