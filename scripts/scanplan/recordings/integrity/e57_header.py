"""What an E57 file states of its scans, held against its length before the library reads it.

The header and the XML section are read here: that section may be of any size, and may have
entities that grow without bound.
"""

import math
import struct
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, ParseError

import numpy as np
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import fromstring

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.types import FloatArray

_HEADER = struct.Struct("<8sIIQQQQ")
_SIGNATURE = b"ASTM-E57"
_PAGE_BYTES = 1024  # the last four of each are its checksum
_CONTENT_BYTES = 1020
_MOST_XML_BYTES = 2**24  # two thousand scans with all that a scanner's program states
COLOURS = ("colorRed", "colorGreen", "colorBlue")
"""Fields of a point."""
_NAMESPACE = "{http://www.astm.org/COMMIT/E57/2010-e57-v1.0}"


@dataclass(frozen=True)
class E57Scan:
    """What the XML states of a scan.

    Attributes
    ----------
    world_from_sensor : (4, 4) float64
        The identity where the file states no pose, as the standard says.
    fields : tuple of str
        Of each of its points.
    n_points : int
    colour_limits : tuple of three (float, float), or None
        Of red, green and blue what stands for none and for all; None of points without colours.
    """

    world_from_sensor: FloatArray
    fields: tuple[str, ...]
    n_points: int
    colour_limits: tuple[tuple[float, float], ...] | None = None


def read_scans(path: Path) -> list[E57Scan]:
    """Return what a file states of its scans.

    Raises
    ------
    StageError
        If it is no E57, cut off, its XML is none, or a scan states more points than the file holds.
    """
    length = path.stat().st_size
    root = _read_xml(path, length)
    found = []
    for number, child in enumerate(root.findall(f"{_NAMESPACE}data3D/{_NAMESPACE}vectorChild")):
        try:
            scan, bits = _read_scan(child)
        except (ValueError, TypeError, AttributeError, OverflowError):
            raise StageError(
                f"{path}: scan {number}: damaged: its pose or its points are not stated in numbers;"
                " export it again"
            ) from None
        if scan.n_points * max(bits, 1) > 8 * length:
            raise StageError(
                f"{path}: scan {number}: damaged: states {scan.n_points} points of {bits} bits,"
                f" more than the file's {length} bytes hold; copy or export it again"
            )
        found.append(scan)
    return found


def _read_xml(path: Path, length: int) -> Element:
    with path.open("rb") as file:
        begin = file.read(_HEADER.size)
        if len(begin) < _HEADER.size or not begin.startswith(_SIGNATURE):
            raise StageError(f"{path}: is no E57 file; export it again")
        _, _, _, stated, offset, xml_bytes, page_bytes = _HEADER.unpack(begin)
        if stated != length:
            raise StageError(
                f"{path}: damaged: states {stated} bytes and has {length}; copy it again"
            )
        pages = -(-(offset % _PAGE_BYTES + xml_bytes) // _CONTENT_BYTES)
        is_inside = offset + xml_bytes <= length
        if page_bytes != _PAGE_BYTES or not is_inside or xml_bytes > _MOST_XML_BYTES:
            raise StageError(
                f"{path}: damaged: its description of {xml_bytes} bytes at {offset} does not lie in"
                f" the file's {length}, or is longer than {_MOST_XML_BYTES}; export it again"
            )
        file.seek(offset - offset % _PAGE_BYTES)
        raw = file.read((pages + 1) * _PAGE_BYTES)
    content = b"".join(
        raw[i : i + _CONTENT_BYTES] for i in range(0, len(raw), _PAGE_BYTES)
    )  # without checksums, which the library tests
    try:
        return fromstring(content[offset % _PAGE_BYTES :][:xml_bytes], forbid_dtd=True)
    except (ParseError, DefusedXmlException, ValueError, LookupError):
        raise StageError(
            f"{path}: damaged: its description is no XML, or has definitions of its own; copy or"
            " export it again"
        ) from None


def _read_scan(child: Element) -> tuple[E57Scan, int]:
    """Return a scan, and how many bits each of its points takes at least."""
    points = child.find(f"{_NAMESPACE}points")
    if points is None:
        return E57Scan(np.eye(4), (), 0), 0
    prototype = points.find(f"{_NAMESPACE}prototype")
    fields = [] if prototype is None else list(prototype)
    n_points = int(points.get("recordCount", "0"))
    if n_points < 0:
        raise ValueError("negative count")
    by_name = {field.tag.removeprefix(_NAMESPACE): field for field in fields}
    limits = None
    if set(COLOURS) <= set(by_name):
        limits = tuple(_read_colour_limits(child, name, by_name[name]) for name in COLOURS)
    bits = sum(map(_count_bits, fields))
    return E57Scan(_read_pose(child), tuple(by_name), n_points, limits), bits


def _read_colour_limits(child: Element, name: str, field: Element) -> tuple[float, float]:
    """Return the limits that a scan states of a colour, or else those of its field."""
    of_field = (0.0, 1.0) if field.get("type") == "Float" else (0.0, 255.0)
    found = []
    for end, usual in zip(("Minimum", "Maximum"), of_field, strict=True):
        stated = child.findtext(f"{_NAMESPACE}colorLimits/{_NAMESPACE}{name}{end}")
        if stated is None and field.get("type") == "Integer":
            stated = field.get(end.lower(), str(usual))
        # an element without text is a zero
        found.append(usual if stated is None else float(stated or 0))
    low, high = found
    return (low, high) if -np.inf < low < high < np.inf else of_field


def _read_pose(child: Element) -> FloatArray:
    turn = _numbers(child, "rotation", {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0})
    place = _numbers(child, "translation", dict.fromkeys("xyz", 0.0))
    quat = np.array([*turn[1:], turn[0]])
    # a pose that is none is refused by who reads it, by its name
    is_turn = 0 < np.linalg.norm(quat) < np.inf
    matrix = se3.pose_matrix(np.array([place]), np.array([quat])) if is_turn else [np.eye(4) * 0]
    return np.asarray(matrix[0], np.float64)


def _numbers(child: Element, name: str, defaults: dict[str, float]) -> list[float]:
    """Return the numbers of a part of the pose; an element without text is a zero."""
    part = child.find(f"{_NAMESPACE}pose/{_NAMESPACE}{name}")
    if part is None:
        return list(defaults.values())
    return [float(part.findtext(f"{_NAMESPACE}{axis}", "0") or 0) for axis in defaults]


def _count_bits(field: Element) -> int:
    """Return the bits of a field in a point."""
    kind = field.get("type")
    if kind == "Float":
        return 32 if field.get("precision") == "single" else 64
    if kind not in ("Integer", "ScaledInteger"):
        return 0
    least = int(field.get("minimum", str(-(2**63))))
    most = int(field.get("maximum", str(2**63 - 1)))
    return math.ceil(math.log2(max(most - least + 1, 1)))
