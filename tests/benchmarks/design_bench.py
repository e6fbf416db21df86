"""What is told of buildings that were built otherwise than designed, from simulated surveys.

Published building models are the designs; surveys lead through copies of them in which walls were
moved and taken away and openings walled up, so that each deviation is known.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import design_prior_bench
import ifcopenshell
import ifcopenshell.util.unit
import numpy as np
import office_surveys

from scanplan.design import as_built, design_reading, deviations
from scanplan.design.deviations import DEVIATES, MISSING, Deviation
from scanplan.design.tolerances import make_tolerances
from scanplan.errors import StageError
from scanplan.project.tolerance_file import read_tolerances
from scanplan.types import Settings

_LOCALISER = {"noise_m": 0.05, "noise_deg": 1.0, "jumps_per_min": 1.0}


@dataclass(frozen=True)
class Case:
    """A design, and what was built otherwise.

    Attributes
    ----------
    model, storey : str
    moved_m : dict of str to (float, float)
        By the GlobalId of a wall, along x and y.
    gone, closed : tuple of str
        Walls that were not built, and openings.
    seed : int
    """

    model: str
    storey: str
    moved_m: dict[str, tuple[float, float]] = field(default_factory=dict)
    gone: tuple[str, ...] = ()
    closed: tuple[str, ...] = ()
    seed: int = 1


_FZK, _DUPLEX = "AC20-FZK-Haus.ifc", "duplex.ifc"
CASES = {
    "fzk_same": Case(_FZK, "Erdgeschoss", seed=1),
    "fzk_alt": Case(
        _FZK,
        "Erdgeschoss",
        {"2ptk1k7qn8_Qk22vjh$0DE": (0.1, 0.0), "3PfS__Y_DBAfq5naM6zD2Z": (-0.05, 0.0)},
        ("1$wmdwWPjDYuku_ghVkynE",),
        ("2lV07gym5YkPLv5gWQeAr4",),
        seed=2,
    ),
    "duplex_same": Case(_DUPLEX, "Level 1", seed=3),
    "duplex_alt": Case(
        _DUPLEX,
        "Level 1",
        {
            "2O2Fr$t4X7Zf8NOew3FKGS": (-0.08, 0.0),
            "2O2Fr$t4X7Zf8NOew3FNld": (0.08, 0.0),
            "2O2Fr$t4X7Zf8NOew3FKIu": (0.0, -0.15),
        },
        (),
        ("1xS3BCk291UvhgP2dvNrfE",),
        seed=4,
    ),
}
"""By the name of a survey."""


def bench(project: Path, settings: Settings, folder: Path, models: Path) -> None:
    """Simulate and plan surveys as far as they are not there, and print what is told of them.

    And what plans are worth that have the designs as a prior, beside those without.
    """
    for name, case in CASES.items():
        altered = folder / f"models/{name}.ifc"
        altered.parent.mkdir(parents=True, exist_ok=True)
        if not altered.exists():
            _alter(models / case.model, case, altered)
        simulated: dict[str, Any] = {
            "building": str(altered.resolve()),
            "site": {"route": "rooms", "storey": case.storey},
            "seed": case.seed,
            "localiser": _LOCALISER,
        }
        office_surveys.plan_survey(project, folder, name, simulated)
    evaluate(folder, models)
    designs = {name: models / case.model for name, case in CASES.items()}
    design_prior_bench.print_table(folder, designs, settings)


def evaluate(folder: Path, models: Path) -> None:
    """Print what is told of each survey against both designs, and the median error."""
    errors_m: list[float] = []
    invented = 0
    allowed = make_tolerances(read_tolerances("din_18202"))
    for name, case in CASES.items():
        plan, scans = office_surveys.read_survey(folder / "results" / name)
        for model in (_FZK, _DUPLEX):
            storeys = design_reading.read_design(models / model)
            try:
                found = as_built.compare_design(storeys, model, plan, scans)
            except StageError as fault:
                print(f"design, {name} against {model}: refused, {fault}"[:150])
                continue
            rated = deviations.rate_deviations(found.compared, found.storey, allowed)
            of_case, false = _judge(rated, case)
            print(
                f"design, {name} against {model}, {found.storey.name}: errors of"
                f" {len(of_case)} deviations {np.round(1000 * np.array(of_case), 1)} mm,"
                f" {false} invented"
            )
            errors_m += of_case
            invented += false
    print(f"design, all: median error {1000 * np.median(errors_m):.1f} mm, {invented} invented")


def _judge(rated: list[Deviation], case: Case) -> tuple[list[float], int]:
    """Return what deviations of walls that were moved are off by, and how many were not made.

    A room beside what was altered has changed with it.
    """
    errors_m: list[float] = []
    invented = 0
    for of in rated:
        if of.verdict == DEVIATES and of.is_fault and of.guid in case.moved_m:
            way_m = np.array(of.change.moved_m) - case.moved_m[of.guid]
            errors_m.append(float(np.hypot(*way_m)))
        elif of.is_fault and of.change.table != "room":
            invented += not (of.verdict == MISSING and of.guid in case.gone)
    return errors_m, invented


def _alter(model: Path, case: Case, target: Path) -> None:
    file: Any = ifcopenshell.open(model)
    scale_m = ifcopenshell.util.unit.calculate_unit_scale(file)
    for guid, by_m in case.moved_m.items():
        place = file.by_guid(guid).ObjectPlacement.RelativePlacement.Location
        x, y, *z = place.Coordinates
        place.Coordinates = [x + by_m[0] / scale_m, y + by_m[1] / scale_m, *z]
    for guid in case.closed:
        _close(file, file.by_guid(guid))
    for guid in case.gone:
        wall = file.by_guid(guid)
        for relation in list(wall.HasOpenings):
            _close(file, relation.RelatedOpeningElement)
        file.remove(wall)
    file.write(str(target))


def _close(file: Any, hole: Any) -> None:
    remove: Callable[[Any], None] = file.remove
    for relation in list(hole.HasFillings):
        filling = relation.RelatedBuildingElement
        remove(relation)
        remove(filling)
    for relation in list(hole.VoidsElements):
        remove(relation)
    remove(hole)
