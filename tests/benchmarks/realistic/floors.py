"""The floors of the bench: simulated drives of the catalogue, and real recordings with a truth."""

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import catalogue

HALVES = ("tuning", "reporting", "real")
"""Drives that may be tuned on, drives that are only reported on, and real floors."""
_DRAWN_BY_HAND = Path(__file__).parents[1] / "truth"


@dataclass(frozen=True)
class Floor:
    """A recording with a truth.

    Attributes
    ----------
    name : str
    kind : str
        Of building; `real` or `map` of recordings that lie beside the project.
    sensor : str
        By the catalogue's name; "" where it is not of the catalogue.
    half : str
        One of `HALVES`.
    drive : catalogue.Drive or None
        None of a real recording.
    recording, truth : Path or None
        Dataset folder, and file of the truth, of a real recording.
    """

    name: str
    kind: str
    sensor: str
    half: str
    drive: catalogue.Drive | None = None
    recording: Path | None = None
    truth: Path | None = None


def list_floors(data: Path) -> list[Floor]:
    """Return all floors, those of the catalogue first; real ones as far as `data` has them."""
    drives = [Floor(d.name, d.kind, d.sensor, d.half, drive=d) for d in catalogue.list_drives()]
    return [*drives, *_list_real(data)]


def choose_floors(data: Path, words: Sequence[str]) -> list[Floor]:
    """Return the floors that words name: halves, `subset`, kinds of building, or floors themselves.

    All of them without any word.
    """
    floors = list_floors(data)
    if not any(floor.half == "real" for floor in floors):
        print(f"realistic: no real floor under {data}, so none is measured", flush=True)
    unknown = [word for word in words if not any(is_named(floor, word) for floor in floors)]
    if unknown:
        kinds = ", ".join(dict.fromkeys(floor.kind for floor in floors))
        sys.exit(
            f"realistic: no floor {', '.join(unknown)}; name halves ({', '.join(HALVES)}), subset,"
            f" kinds ({kinds}) or floors"
        )
    return [f for f in floors if not words or any(is_named(f, word) for word in words)]


def is_named(floor: Floor, word: str) -> bool:
    """Return whether a word names a floor: its own, its kind's or its half's, or `subset`."""
    return word in (floor.name, floor.kind, floor.half) or (
        word == "subset" and floor.name in catalogue.SUBSET
    )


def find_real_truth(recording: Path) -> Path | None:
    """Return the truth of a real recording: of a map, or drawn by hand, here or beside it."""
    drawn = f"{recording.name}.geojson"
    places = (recording / "truth.npz", _DRAWN_BY_HAND / drawn, recording.parent / "truth" / drawn)
    return next((place for place in places if place.is_file()), None)


def _list_real(data: Path) -> Iterator[Floor]:
    for kind, folder in (("map", data / "maps"), ("log", data)):
        for recording in sorted(folder.glob("*/")):
            if truth := find_real_truth(recording):
                yield Floor(recording.name, kind, "", "real", recording=recording, truth=truth)
