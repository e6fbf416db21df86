"""A small floor driven through by the simulator: what sensors and localiser said, to be falsified.

Four rooms, as users have them; clouds are taken at once, so that a stamp holds for all of a cloud.
"""

import json
from dataclasses import dataclass, replace
from functools import cached_property
from operator import itemgetter
from pathlib import Path

import numpy as np

from helpers import bag_making
from helpers.default_settings import SETTINGS
from scanplan.geometry import se3
from scanplan.project import stage_settings
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey
from simulate_survey import simulate_survey

_OUTER = [(0, 0), (10.4, 0), (10.4, 7.1), (0, 7.1), (0, 0)]
_WALLS = [(0.24, _OUTER), (0.12, [(5.6, 0), (5.6, 7.1)]), (0.12, [(0, 3.9), (10.4, 3.9)])]
_DOORS = [(0.9, (5.6, 1.8)), (0.9, (2.2, 3.9)), (1.0, (8.4, 3.9))]
_WINDOWS = [(1.4, (0, 2)), (1.2, (2.6, 7.1)), (1.6, (10.4, 5.4)), (1.0, (8, 0))]
_WAY = [
    *[(1.2, 1.2), (4.6, 1.2), (4.6, 1.8), (9.4, 1.8), (8.4, 1.8), (8.4, 5.8), (6.6, 5.8)],
    *[(8.4, 5.8), (8.4, 1.8), (4.6, 1.8), (2.2, 1.8), (2.2, 5.6), (4.4, 5.9), (1.2, 5.9)],
    *[(2.2, 5.6), (2.2, 1.8), (1.2, 1.2)],
]
STOREYS = {
    "rooms": (_WALLS, _DOORS, _WINDOWS, _WAY),
    "rooms again": (_WALLS, _DOORS, _WINDOWS, _WAY[::-1]),
    "storey above": (
        [(0.24, _OUTER), (0.12, [(3.9, 0), (3.9, 7.1)]), (0.12, [(3.9, 3.2), (10.4, 3.2)])],
        [(0.9, (3.9, 1.6)), (0.9, (6.2, 3.2))],
        [(1.4, (0, 5)), (1.2, (8.6, 0)), (1.6, (10.4, 4.6))],
        [(1.2, 1.2), (1.2, 5.9), (2.2, 1.6), (9.2, 1.6), (6.2, 1.6), (6.2, 5.6), (9.2, 5.6)],
    ),
}
"""Walls (thickness, line), doors and windows (width, place) and the way of each storey."""


@dataclass(frozen=True)
class Drive:
    """What was recorded of a drive.

    Attributes
    ----------
    t_ns : (n,) int64
        Stamps of the clouds, at which poses are given, too.
    clouds : list of n (k, 3) float32
        In the sensor's frame.
    map_from_base, odom_from_base : (n, 4, 4) float64
        Localiser and odometry.
    base_from_sensor : (4, 4) float64
        As it is stated.
    late_s : float
        How much later than the clouds' the stamps of poses are.
    has_odometry, is_stated : bool
        Whether odometry, and the mounting, are recorded.
    """

    t_ns: np.ndarray
    clouds: list
    map_from_base: np.ndarray
    odom_from_base: np.ndarray
    base_from_sensor: np.ndarray
    late_s: float = 0.0
    has_odometry: bool = True
    is_stated: bool = True

    @cached_property
    def share(self):
        """How far (n,) the drive had come at each cloud, 0 to 1."""
        return np.linspace(0, 1, len(self.t_ns))

    def take(self, rows):
        """Return some clouds of it, in their order."""
        rows = np.arange(len(self.t_ns))[rows]
        return replace(
            self,
            t_ns=self.t_ns[rows],
            clouds=[self.clouds[row] for row in rows],
            map_from_base=self.map_from_base[rows],
            odom_from_base=self.odom_from_base[rows],
        )

    def write(self, path, kind="ros1"):
        """Write it as a recording; return its path."""
        maker = bag_making.Maker(kind)
        entries = []
        if self.is_stated:
            at, turn = se3.split_pose(self.base_from_sensor[None])
            mounting = maker.transforms((int(self.t_ns[0]), "base_link", "lidar", at[0], turn[0]))
            entries.append(("/tf_static", self.t_ns[0] - 1, mounting))
        places = (se3.split_pose(pose) for pose in (self.map_from_base, self.odom_from_base))
        rows = [zip(*parts, strict=True) for parts in places]
        for now, cloud, at, rolled in zip(self.t_ns.tolist(), self.clouds, *rows, strict=True):
            late_ns = now + int(self.late_s * 1e9)
            # nothing is received before it is stamped
            sent_ns = max(now, late_ns)
            entries.append(("/localiser", sent_ns, maker.pose_stamped(late_ns, *at)))
            if self.has_odometry:
                entries.append(("/odom", sent_ns + 1, maker.odometry(late_ns, *rolled)))
            entries.append(("/points", now + 2, maker.cloud(now, cloud.astype(np.float32))))
        return maker.write(Path(path), sorted(entries, key=itemgetter(1)))


def drive_through(folder, storey="rooms", mirror=None, settings=None):
    """Drive through a storey and return what was recorded of it.

    Parameters
    ----------
    folder : path-like
    storey : str
    mirror : list of (x, y), optional
        A mirror, along the face of a wall.
    settings : dict, optional
        Of the section `simulate`, over the defaults.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    drawing = folder / "floor.geojson"
    drawing.write_text(json.dumps(draw_floor(*STOREYS[storey], mirror)))
    outputs = [folder / name for name in ("drive.bag", "truth.geojson", "a.tum", "b.tum")]
    known = stage_settings.select_simulation(SETTINGS)
    given = {"sensor": {"n_azimuth": 360, "sweep": False, "rate_hz": 4.0}, **(settings or {})}
    known |= {key: {**known[key], **value} for key, value in given.items() if key in known}
    simulate_survey(drawing, *outputs, **known)
    with open_survey(
        [str(outputs[0])], Reading(**stage_settings.select_section(SETTINGS, "input"))
    ) as read:
        t_ns = read.stamps()
        chains = [read.pose_edges(), read.motion_chains()[0][1]]
        found = [frame_edges.chain_poses(chain, t_ns, max_gap_s=2.0) for chain in chains]
        rows = np.flatnonzero(found[0][2] & found[1][2])
        clouds = [scan.xyz_m for scan in read.scans(rows.tolist())]
        mount = read.base_from_sensor(t_ns[:1])[0]
    sensor_from_base = se3.invert_pose(mount)
    poses = [pose[rows] @ sensor_from_base for pose, _, _ in found]
    return Drive(t_ns[rows], clouds, *poses, mount)


def draw_floor(walls, doors, windows, way, mirror=None):
    """Return a drawing of walls (thickness, line), doors and windows (width, place), and a way."""

    def feature(shape, coordinates, **properties):
        geometry = {"type": shape, "coordinates": coordinates}
        return {"type": "Feature", "properties": properties, "geometry": geometry}

    door = {"kind": "opening", "type": "door", "sill_m": 0, "lintel_m": 2.05}
    window = {"kind": "opening", "type": "window", "sill_m": 0.9, "lintel_m": 2.2}
    features = [
        *(feature("LineString", line, kind="wall", thickness_m=t) for t, line in walls),
        *(feature("Point", at, width_m=width, **door) for width, at in doors),
        *(feature("Point", at, width_m=width, **window) for width, at in windows),
        feature("LineString", way, kind="waypoints"),
    ]
    if mirror is not None:
        features.append(feature("LineString", mirror, kind="mirror", sill_m=0.1, lintel_m=2.2))
    return {"type": "FeatureCollection", "height_m": 2.6, "features": features}
