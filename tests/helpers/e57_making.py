"""E57 files written by pye57, and their descriptions changed afterwards."""

import struct
from functools import cache
from pathlib import Path

import numpy as np
import pye57
from pye57 import libe57
from scipy.spatial.transform import Rotation

PAGE, CONTENT = 1024, 1020
OF_XML = 24  # in the header: where the description begins, and its length


def write_e57(path, poses, points, rgb=None):
    """Write scans (n, 3) in their own frames with poses (4, 4); a row that is NaN is invalid.

    Points of all scans may have the same colours (n, 3) of 0 to 255.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with pye57.E57(str(path), mode="w") as file:
        for pose, xyz_m in zip(poses, points, strict=True):
            is_point = np.isfinite(xyz_m).all(axis=1)
            columns = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), xyz_m.T, strict=True))
            data = {name: np.where(is_point, column, 0.0) for name, column in columns.items()}
            data["cartesianInvalidState"] = (2 * ~is_point).astype(np.int8)
            if rgb is not None:
                shades = zip(("colorRed", "colorGreen", "colorBlue"), rgb.T, strict=True)
                data |= {name: shade.astype(np.uint8) for name, shade in shades}
            turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
            file.write_scan_raw(data, rotation=turn[[3, 0, 1, 2]], translation=pose[:3, 3])
    return path


def write_spherical(path, range_m, azimuth_rad, elevation_rad):
    """Write one scan in angles and ranges, without a pose."""
    with pye57.E57(str(path), mode="w") as file:
        image = file.image_file
        columns = [np.asarray(values, float) for values in (range_m, azimuth_rad, elevation_rad)]
        names = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
        scan, prototype = libe57.StructureNode(image), libe57.StructureNode(image)
        buffers = libe57.VectorSourceDestBuffer()
        for name, values in zip(names, columns, strict=True):
            prototype.set(name, libe57.FloatNode(image, 0.0, libe57.E57_DOUBLE, -100.0, 100.0))
            buffers.append(libe57.SourceDestBuffer(image, name, values, len(values), True, True))
        points = libe57.CompressedVectorNode(image, prototype, libe57.VectorNode(image, True))
        scan.set("guid", libe57.StringNode(image, "{1}"))
        scan.set("points", points)
        file.data3d.append(scan)
        writer = points.writer(buffers)
        writer.write(len(columns[0]))
        writer.close()
    return path


def change_xml(path, change):
    """Write a file again with another description, of the same file otherwise."""
    data = path.read_bytes()
    offset, length = struct.unpack_from("<QQ", data, OF_XML)
    logical = b"".join(data[i : i + CONTENT] for i in range(0, len(data), PAGE))
    begin = offset // PAGE * CONTENT + offset % PAGE
    text = change(logical[begin : begin + length].decode()).encode()
    logical = bytearray(logical[:begin] + text)
    logical += bytes(-len(logical) % CONTENT)
    n_pages = len(logical) // CONTENT
    struct.pack_into("<QQQ", logical, 16, n_pages * PAGE, offset, len(text))
    pages = [logical[i : i + CONTENT] for i in range(0, len(logical), CONTENT)]
    path.write_bytes(b"".join(bytes(p) + struct.pack(">I", _checksum(bytes(p))) for p in pages))
    return path


def _checksum(data):
    value = 0xFFFFFFFF
    for byte in data:
        value = _table()[(value ^ byte) & 255] ^ (value >> 8)
    return value ^ 0xFFFFFFFF


@cache
def _table():
    """CRC-32C."""
    table = []
    for value in range(256):
        for _ in range(8):
            value = (value >> 1) ^ (0x82F63B78 if value & 1 else 0)
        table.append(value)
    return table
