"""The catalogue: buildings of 14 kinds from three seeds each, every one driven with two sensors.

Seven kinds are for tuning the plan's rules, the other seven are only ever reported on; no seed is
in both. A drive's half is part of it, so that a table can tell them apart.
"""

from dataclasses import dataclass
from pathlib import Path

import yaml

from . import buildings, survey_settings

HALVES = {
    "tuning": (
        *("dwelling", "office_cellular", "office_glass", "hospital"),
        *("old_house", "museum", "hall"),
    ),
    "reporting": (
        *("office_open", "school", "hotel", "basement"),
        *("attic", "library", "shop"),
    ),
}
"""Half to its kinds of buildings."""
SEEDS = {"tuning": (101, 102, 103), "reporting": (201, 202, 203)}
SUBSET = (
    *("office_cellular_101_laser360", "office_glass_101_uneven32_tilted"),
    *("hospital_101_rosette_hand", "old_house_101_vlp16_hand"),
    *("museum_101_vlp16_upside_down", "hall_101_vlp16_odometry"),
    *("dwelling_103_laser270_slam", "office_open_201_vlp16_rover"),
    *("hotel_202_ouster64_trolley", "basement_201_vlp16_unconverged"),
    *("library_201_laser270", "attic_203_laser180"),
)
"""Drives with each of the sensors, through buildings that have all there is."""
_SPATIAL = tuple(survey_settings.SPATIAL)
_PLANAR = tuple(survey_settings.PLANAR)


@dataclass(frozen=True)
class Drive:
    """A building, driven with a sensor.

    Attributes
    ----------
    name : str
        Of its dataset.
    kind : str
        Of the building.
    seed : int
        Of the building and the drive.
    sensor : str
        One of `survey_settings.SPATIAL` and `PLANAR`.
    half : {"tuning", "reporting"}
    """

    name: str
    kind: str
    seed: int
    sensor: str
    half: str


def list_drives(*, subset: bool = False) -> tuple[Drive, ...]:
    """Return all drives, two of each building; with `subset` twelve that show everything."""
    drives = tuple(drive for half in HALVES for drive in _drives_of(half))
    return tuple(d for d in drives if d.name in SUBSET) if subset else drives


def _drives_of(half: str) -> list[Drive]:
    """Return the drives of a half: sensors follow one another, three of eight are planar."""
    drives, n_planar = [], 0
    for i, seed in enumerate(SEEDS[half]):
        for j, kind in enumerate(HALVES[half]):
            number = i * len(HALVES[half]) + j
            pair = [_SPATIAL[number % len(_SPATIAL)]]
            if number % 4 == 3:
                pair.append(_SPATIAL[(number + 4) % len(_SPATIAL)])
            else:
                pair.append(_PLANAR[n_planar % len(_PLANAR)])
                n_planar += 1
            drives += [Drive(f"{kind}_{seed}_{s}", kind, seed, s, half) for s in pair]
    return drives


def write_survey(drive: Drive, folder: Path) -> Path:
    """Write a drive's drawing and its settings, where they differ; return the settings' path.

    Parameters
    ----------
    drive : Drive
    folder : pathlib.Path
        Made if need be.

    Returns
    -------
    pathlib.Path
        A dataset of the workflow.
    """
    folder.mkdir(parents=True, exist_ok=True)
    drawing = folder.absolute() / f"{drive.name}.geojson"
    _write(drawing, buildings.draw_building(drive.kind, drive.seed).text())
    settings = survey_settings.survey_settings(drive.sensor, str(drawing), drive.seed)
    path = drawing.with_suffix(".yaml")
    _write(path, yaml.safe_dump(settings))
    return path


def _write(path: Path, text: str) -> None:
    """Write a file unless it holds that: what is older than its results is not made again."""
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
