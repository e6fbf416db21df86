"""What two simulated drives could see of an edit of their floor: by true rays, no plan is asked.

Rays go from the sensor's true places into the true building, without noise and without people.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from helpers.default_settings import SETTINGS
from scanplan.geometry.lines import Line
from scanplan.lab.simulation import raycast, rover, survey_setup
from scanplan.lab.simulation.sensors import turn_directions
from scanplan.lab.simulation.sweeps import SimulatedSurvey
from scanplan.project.settings import merge_settings
from scanplan.project.stage_settings import select_simulation
from scanplan.types import BoolArray, FloatArray

CELL_M = 0.1
_FEWEST = 3  # rays into a cell: with fewer no plan would know it from strays
_EVERY = 4  # scans: a third of a metre on the way
_HEIGHTS_M = (0.1, 2.0)  # of doors; what is above is over them
_REACHED_M = 0.01  # before a face: what corners of triangles err by


@dataclass(frozen=True)
class Stretch:
    """A stretch of a wall, or of where one is not: its ends (2, 2) and half of its thickness."""

    ends_m: FloatArray
    half_m: float


@dataclass(frozen=True, eq=False)
class TrueRays:
    """Where rays begin and end, (n, 3) float64 each, in the drawing's frame."""

    begin_m: FloatArray
    end_m: FloatArray

    def moved(self, motion: Any) -> "TrueRays":
        """Return them in another frame of the plane."""
        begin_m, end_m = self.begin_m.copy(), self.end_m.copy()
        for of_m in (begin_m, end_m):
            of_m[:, :2] = motion(of_m[:, :2])
        return TrueRays(begin_m, end_m)

    def reach(self, stretch: Stretch) -> BoolArray:
        """Return which cells of a stretch they reach from its left and from its right, (2, c).

        They end at the side that they come from, or behind it.
        """
        way_m = np.diff(stretch.ends_m, axis=0)[0]
        length_m = float(np.hypot(*way_m))
        along = way_m / length_m
        line = Line(stretch.ends_m[0], np.array([-along[1], along[0]]))
        n_cells = max(round(length_m / CELL_M), 1)
        return np.stack(
            [self._reach_side(line, side, stretch.half_m, n_cells) for side in (1.0, -1.0)]
        )

    def _reach_side(self, line: Line, side: float, half_m: float, n_cells: int) -> BoolArray:
        begin_m, end_m = (side * line.offset_m(of[:, :2]) for of in (self.begin_m, self.end_m))
        face_m = half_m + _REACHED_M
        rows = np.flatnonzero((begin_m > face_m) & (end_m <= face_m))
        share = (begin_m[rows] - face_m) / (begin_m[rows] - end_m[rows])
        at_m = self.begin_m[rows] + share[:, None] * (self.end_m[rows] - self.begin_m[rows])
        cells = np.floor(line.along_m(at_m[:, :2]) / CELL_M).astype(np.int64)
        low_m, high_m = _HEIGHTS_M
        is_on = (cells >= 0) & (cells < n_cells) & (low_m <= at_m[:, 2]) & (at_m[:, 2] <= high_m)
        return np.bincount(cells[is_on], minlength=n_cells) >= _FEWEST


def find_shared(reached: tuple[BoolArray, BoolArray], sides: tuple[int, int]) -> float:
    """Return the share of an edit's length that both surveys show.

    Parameters
    ----------
    reached : ((2, c) bool, (2, c) bool)
        Which cells each of them reaches, from the left and the right.
    sides : (int, int)
        From how many sides each has to: 2 from both, 1 from one, the same where both ask for one;
        0 where nothing stands, from any.
    """
    shown = [_SIDES[number](of) for number, of in zip(sides, reached, strict=True)]
    return float((shown[0] & shown[1]).mean(axis=1).max())


_SIDES = {
    0: lambda of: np.broadcast_to(of.any(axis=0), of.shape),
    1: lambda of: of,
    2: lambda of: np.broadcast_to(of.all(axis=0), of.shape),
}


def cast_rays(survey_file: Path) -> TrueRays:
    """Return the rays of a simulated survey in the building that it drives through."""
    own = yaml.safe_load(survey_file.read_text(encoding="utf-8"))
    scene = dict(select_simulation(merge_settings(SETTINGS, own)))
    seed = scene.pop("seed")
    building = Path(own["simulate"]["building"])
    site = survey_setup.prepare_site(
        building.read_bytes(),
        building,
        scene,
        seed=seed,
        planar=scene["sensor"]["model"] == "laser",
    )
    survey = survey_setup.prepare_survey(site, scene, seed=seed)
    mesh = raycast.RayScene(survey.mesh)
    parts = [_cast_scan(survey, mesh, i) for i in range(0, len(survey.t_ns), _EVERY)]
    return TrueRays(*(np.concatenate(of) for of in zip(*parts, strict=True)))


def _cast_scan(
    survey: SimulatedSurvey, mesh: raycast.RayScene, scan_id: int
) -> tuple[FloatArray, FloatArray]:
    sensor = survey.sensor
    fired_ns = survey.t_ns[scan_id] + np.round(sensor.time_s * 1e9).astype(np.int64)
    world_from_sensor = rover.drive_poses(survey.drive, fired_ns) @ survey.base_from_sensor
    rotation = world_from_sensor[:, :3, :3].transpose(0, 2, 1).astype(np.float32)
    direction = turn_directions(sensor, scan_id) @ rotation
    origin_m = world_from_sensor[:, :3, 3]
    range_m = mesh.opaque_hits(origin_m, direction).range_m.astype(float)
    begin_m = np.repeat(origin_m, direction.shape[1], axis=0)
    # a ray that comes back from nowhere goes as far as the sensor measures
    far_m = np.minimum(range_m, sensor.max_range_m)
    end_m = begin_m + far_m[:, None] * direction.reshape(-1, 3)
    is_low = (begin_m[:, 2] < _HEIGHTS_M[1]) | (end_m[:, 2] < _HEIGHTS_M[1])
    return begin_m[is_low], end_m[is_low]
