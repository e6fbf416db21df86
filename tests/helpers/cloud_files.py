"""Clouds in files."""

import struct

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


def write_ply(path, xyz_m):
    """A PLY of text, in single precision."""
    lines = "\n".join(" ".join(map(repr, row)) for row in np.asarray(xyz_m, np.float32).tolist())
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        f"ply\nformat ascii 1.0\nelement vertex {len(xyz_m)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"end_header\n{lines}\n"
    )
    return path


def write_binary_ply(path, xyz_m, order="little", x="double"):
    """A binary PLY of doubles with an intensity; x may be of another type."""
    header = (
        f"ply\nformat binary_{order}_endian 1.0\nelement vertex {len(xyz_m)}\n"
        f"property {x} x\nproperty double y\nproperty double z\nproperty uchar intensity\n"
        "end_header\n"
    )
    kinds = [{"double": "f8", "float": "f4"}[x], "f8", "f8", "u1"]
    points = np.zeros(len(xyz_m), [(n, k) for n, k in zip("xyzi", kinds, strict=True)])
    points = points.astype(points.dtype.newbyteorder("<" if order == "little" else ">"))
    points["x"], points["y"], points["z"] = np.asarray(xyz_m).T
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode() + points.tobytes())
    return path


def write_compressed_pcd(path, n_points, unpacked, packed=b""):
    """A PCD that states so many points, and so many bytes to unpack."""
    header = (
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
        f"WIDTH {n_points}\nHEIGHT 1\nPOINTS {n_points}\nDATA binary_compressed\n"
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode() + struct.pack("<II", len(packed), unpacked) + packed)


def write_by_open3d(path, xyz_m, *, packed=False):
    """Any cloud that Open3D writes, in double precision, a PCD packed or not."""
    import open3d

    path.parent.mkdir(parents=True, exist_ok=True)
    cloud = open3d.t.geometry.PointCloud(np.ascontiguousarray(xyz_m, np.float64))
    open3d.t.io.write_point_cloud(str(path), cloud, compressed=packed)
    return path


def write_table(path, rows, form):
    """A PCD or PLY of a structured array, its fields as they are; text in full digits."""
    ply = path.suffix == ".ply"
    kinds = [rows.dtype[name] for name in rows.dtype.names]
    if ply:
        called = {"f4": "float", "f8": "double", "u4": "uint", "i4": "int", "u1": "uchar"}
        fields = zip(kinds, rows.dtype.names, strict=True)
        stated = [f"property {called[kind.str[1:]]} {name}" for kind, name in fields]
        head = ["ply", f"format {form} 1.0", f"element vertex {len(rows)}", *stated, "end_header"]
    else:
        head = [
            f"VERSION 0.7\nFIELDS {' '.join(rows.dtype.names)}",
            f"SIZE {' '.join(str(kind.itemsize) for kind in kinds)}",
            f"TYPE {' '.join(kind.kind.upper() for kind in kinds)}",
            f"COUNT {' '.join('1' for _ in kinds)}\nWIDTH {len(rows)}\nHEIGHT 1",
            f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(rows)}\nDATA {form}",
        ]
    if form == "ascii":
        data = "".join(" ".join(map(repr, row)) + "\n" for row in rows.tolist()).encode()
    else:
        order = ">" if form == "binary_big_endian" else "<"
        data = rows.astype(rows.dtype.newbyteorder(order)).tobytes()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes("\n".join([*head, ""]).encode() + data)
    return path
