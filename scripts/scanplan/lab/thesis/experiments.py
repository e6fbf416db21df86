"""The thesis's experiments (chapter 5) as datasets: its two surveys, each with several seeds.

No heavy imports: this runs while the workflow is being parsed.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from scanplan.project.dataset import RESERVED, Dataset, describe_simulated
from scanplan.project.settings import Layer, read_own_layers, settings_of_dataset
from scanplan.types import FilePath

ROOMS = "ring_rooms"
"""Registered scans of all rooms (5.2)."""
DRIVE = "ring_hallways"
"""A drive through the hallways (5.4)."""
LIMITS = "ring_hallways_limits"
"""The same drive with the thesis's limits of registration."""


def list_surveys(
    *,
    defaults: dict[str, Any],
    given: Sequence[Layer],
    schema: dict[str, Any],
    config: FilePath,
) -> dict[str, tuple[Dataset, ...]]:
    """Gather the surveys of the thesis's experiments.

    Parameters
    ----------
    defaults, schema : dict
        See `settings.settings_of_dataset`.
    given : sequence of settings.Layer
        The command line's settings; section `thesis` says which seeds.
    config : path-like
        The folder that holds `surveys`, `buildings` and `thesis.yaml`.

    Returns
    -------
    dict of str to tuple of dataset.Dataset
        `ROOMS`, `DRIVE` and `LIMITS`, each by seed. Of `LIMITS` the recordings are those of
        `DRIVE`.
    """
    config = Path(config)
    chosen = settings_of_dataset(defaults, given, schema)["thesis"]
    limits = read_own_layers(config / "thesis.yaml", may_lack=False)

    def simulated(
        kind: str, seeds: Sequence[int], over: Sequence[Layer] = (), survey: str | None = None
    ) -> tuple[Dataset, ...]:
        own = read_own_layers(config / f"surveys/{survey or kind}.yaml", may_lack=False)
        settings = settings_of_dataset(defaults, (*own, *over, *given), schema)
        return tuple(
            describe_simulated(
                f"{RESERVED}/{kind}_{seed}", replace_seeds(settings, seed), config / "buildings"
            )
            for seed in seeds
        )

    drives = simulated(DRIVE, chosen["drive_seeds"])
    strict = simulated(LIMITS, chosen["drive_seeds"], limits, survey=DRIVE)
    return {
        ROOMS: simulated(ROOMS, chosen["seeds"]),
        DRIVE: drives,
        LIMITS: tuple(
            replace(dataset, recordings=drive.recordings, truth=drive.truth, building=None)
            for dataset, drive in zip(strict, drives, strict=True)
        ),
    }


def replace_seeds(settings: dict[str, Any], seed: int) -> dict[str, Any]:
    """Return settings with every seed replaced; the given ones are not changed."""
    walls = {extractor: values | {"seed": seed} for extractor, values in settings["walls"].items()}
    sections = {
        name: settings[name] | {"seed": seed} for name in ("simulate", "hulls", "selection")
    }
    return settings | sections | {"walls": walls}
