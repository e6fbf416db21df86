"""The thesis's experiments (chapter 5) as datasets: its surveys simulated, with several seeds.

No heavy imports: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project.dataset import describe_simulated
from scanplan.project.dataset_files import RESERVED
from scanplan.project.settings import read_own_layers, settings_of_dataset

if TYPE_CHECKING:
    from collections.abc import Sequence

    from scanplan.project.dataset import Dataset
    from scanplan.project.settings import Layer
    from scanplan.project.settings_schema import Schema
    from scanplan.types import FilePath, Settings

ROOMS, DRIVE, LIMITS = "ring_rooms", "ring_hallways", "ring_hallways_limits"
"""Scans of all rooms (5.2); a drive through the hallways (5.4); it with the thesis's limits."""
PAGES = {
    RESERVED: f"results/{RESERVED}/report.html",
    "thesis_more": f"results/{RESERVED}/more.html",
}
"""What the targets make, by their names."""


def list_wanted(
    words: Sequence[str],
    *,
    defaults: Settings,
    given: Sequence[Layer],
    schema: Schema,
    config: FilePath,
) -> dict[str, tuple[Dataset, ...]]:
    """Gather the surveys of the experiments as far as they are asked for.

    Parameters
    ----------
    words : sequence of str
        Of the command: targets, results and whatever else.
    defaults, given, schema, config
        See `list_surveys`.

    Returns
    -------
    dict of str to tuple of dataset.Dataset
        See `list_surveys`; empty where settings that are meant for another survey unfit these and
        no word asks for them.

    Raises
    ------
    StageError
        If settings unfit surveys that a word asks for.
    """
    try:
        return list_surveys(defaults=defaults, given=given, schema=schema, config=config)
    except StageError:
        if any(word in PAGES or word.startswith(f"results/{RESERVED}/") for word in words):
            raise
        return {}


def list_surveys(
    *, defaults: Settings, given: Sequence[Layer], schema: Schema, config: FilePath
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
        `ROOMS` and `DRIVE`, each by seed; `LIMITS`, of the first seed of `DRIVE` and its recording:
        the thesis drove once, and no verdict goes by it.
    """
    config = Path(config)
    chosen = settings_of_dataset(defaults, given, schema)["thesis"]
    limits = read_own_layers(config / "thesis.yaml", may_lack=False)

    def simulated(
        kind: str, seeds: Sequence[int], over: Sequence[Layer] = (), survey: str | None = None
    ) -> tuple[Dataset, ...]:
        own = read_own_layers(config / f"surveys/{survey or kind}.yaml", may_lack=False)
        settings = settings_of_dataset(defaults, (*own, *over, *given), schema)
        # how long calls take hardly hangs on the seed, and timing is most of the experiments' time:
        # a fifth is enough to see whether it does
        fewer = max(settings["thesis"]["timed_scans"] // 5, 2)
        timed_less = settings | {"thesis": settings["thesis"] | {"timed_scans": fewer}}
        return tuple(
            describe_simulated(
                f"{RESERVED}/{kind}_{seed}",
                replace_seeds(settings if seed == seeds[0] else timed_less, seed),
                config / "buildings",
            )
            for seed in seeds
        )

    drives = simulated(DRIVE, chosen["drive_seeds"])
    (strict,) = simulated(LIMITS, chosen["drive_seeds"][:1], limits, survey=DRIVE)
    first = drives[0]
    return {
        ROOMS: simulated(ROOMS, chosen["seeds"]),
        DRIVE: drives,
        LIMITS: (replace(strict, recordings=first.recordings, truth=first.truth, building=None),),
    }


def replace_seeds(settings: dict[str, Any], seed: int) -> dict[str, Any]:
    """Return settings with their seed and the simulation's replaced; the given stay as they are."""
    return settings | {"seed": seed, "simulate": settings["simulate"] | {"seed": seed}}
