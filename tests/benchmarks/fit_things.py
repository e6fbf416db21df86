"""The densities of what surfaces are sides of, fitted on floors of the tuning half.

Surfaces of plans by labels are looked up in the truths of their drives: what most of their length
is. Shares of each range of each feature are counted, rounded, and printed as the table that
`plan/model/things.py` holds; by leaving out a kind of building at a time it is said what they are
worth on others.
"""

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import ablation
import ablation_scores
import numpy as np
from ablation_switches import Function, Rule

from scanplan.lab.evaluation import face_cells
from scanplan.lab.evaluation.scores import false_walls, score_files
from scanplan.plan.model import things
from scanplan.plan.model.roofs import Roof
from scanplan.plan.model.surface_features import Features, Surroundings
from scanplan.rays.ray_set import RaySet
from scanplan.stage import workers
from scanplan.types import FloatArray, IntArray, Settings

_OF_TRUTH = {
    "right": things.WALL,
    "leaf": things.LEAF,
    "bridge": things.LEAF,
    "shut_door": things.LEAF,
    "furniture": things.FURNITURE,
    "mirrored": things.OUTSIDE,
}
"""What is what by `false_walls.KINDS`; what is off, or nothing, teaches nothing."""
_PROCESSES = 2
_RIGHT_SHARE = 0.5  # of its length
_OF_ALL = 2.0  # surfaces of all kinds together that each kind is taken to have besides its own
_TEMPERS = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4)
_LEAST_SHARE = 0.005  # what never was may be


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Surfaces of some drives: features (n, f) in the order of `things.DENSITIES`, and kinds.

    And how often kinds (k, k) meet at outer corners.
    """

    features: FloatArray
    kind: IntArray
    length_m: FloatArray
    corners: IntArray


def bench(folder: Path, names: Sequence[str], settings: Settings) -> None:
    """Print the table, and what it is worth.

    Parameters
    ----------
    folder, names
        See `ablation.choose_floors`.
    settings : dict
        Default settings.
    """
    chosen = ablation.choose_floors(
        folder, names, lambda floor: floor.drive is not None, "fit_things"
    )
    with workers.open_pool(min(_PROCESSES, len(chosen))) as run:
        found: list[Surfaces] = list(run(observe, [(path, settings) for path in chosen]))
    everything = _join(found)
    print(format_table(count_shares(everything), fit(everything)))
    print(f"CORNERS = {fit_corners(everything.corners).round(2).tolist()}")
    kinds = [floor.kind for floor in chosen.values()]
    left_out: list[tuple[Surfaces, FloatArray, FloatArray]] = []
    for kind in sorted(set(kinds)):
        rest = _join([of for of, name in zip(found, kinds, strict=True) if name != kind])
        own = _join([of for of, name in zip(found, kinds, strict=True) if name == kind])
        likely = things.weigh_features(own.features, fit(rest).values())
        left_out.append((own, likely, count_shares(rest)))
    print(_report(left_out))


def observe(results: Path, settings: Settings) -> Surfaces:
    """Return the surfaces of a plan by labels that are something in the truth."""
    recorded = ablation_scores.find_truth(results)
    assert recorded is not None
    observed: list[tuple[Surroundings, list[Features]]] = []

    def record(function: Function) -> Function:
        def asked(surroundings: Surroundings, rays: RaySet, roof: Roof) -> list[Features]:
            observed.append((surroundings, function(surroundings, rays, roof)))
            return observed[-1][1]

        return asked

    rule = Rule({"plan.model.surfaces:observe_surfaces": record}, ())
    with tempfile.TemporaryDirectory() as made:
        ablation.make_plan(results, ablation.own_settings(results, settings), rule, Path(made))
    placed = score_files.place_results(results, recorded.truth, recorded.true_poses)
    ((surroundings, features),) = observed
    parts = surroundings.walls
    sides_m = [
        placed.motion[:2, :2] @ (part.ends + across_m * part.line.normal).T
        for part in parts
        for across_m in ((part.half_m, -part.half_m) if part.right else (0.0,))
    ]
    owner = np.repeat(np.arange(len(parts)), [2 if part.right else 1 for part in parts])
    cells = face_cells.cut_faces(np.array([m.T + placed.motion[:2, 3] for m in sides_m]))
    verdict, _ = false_walls.judge_lines(
        cells, false_walls.attribute_cells(placed.scene, cells), _RIGHT_SHARE
    )
    kind = np.full(len(parts), -1)
    for name, of_thing in reversed(_OF_TRUTH.items()):
        kind[owner[verdict == name]] = of_thing
    taught = np.flatnonzero(kind >= 0).tolist()
    met = kind[surroundings.corners]
    met = met[(met >= 0).all(axis=1)]
    corners = np.zeros((len(things.KINDS), len(things.KINDS)), np.int64)
    np.add.at(corners, (met, met[:, ::-1]), 1)
    rows = [[getattr(features[row], name) for name in things.DENSITIES] for row in taught]
    return Surfaces(
        features=np.array(rows, float).reshape(len(taught), len(things.DENSITIES)),
        kind=kind[taught],
        length_m=np.array([parts[row].length_m for row in taught]),
        corners=corners,
    )


def count_shares(of: Surfaces) -> FloatArray:
    """Return the share (k,) of each kind of all surfaces."""
    return np.bincount(of.kind, minlength=len(things.KINDS)) / len(of.kind)


def fit(of: Surfaces) -> dict[str, FloatArray]:
    """Return the shares (k, e + 1) of the ranges of each feature, of each kind."""
    shares: dict[str, FloatArray] = {}
    for column, (name, density) in enumerate(things.DENSITIES.items()):
        value = of.features[:, column]
        known = ~np.isnan(value)
        place = np.searchsorted(density.edges, value[known], "right")
        count = np.zeros((len(things.KINDS), len(density.edges) + 1))
        np.add.at(count, (of.kind[known], place), 1.0)
        usual = (count.sum(axis=0) + 1) / (count.sum() + count.shape[1])
        count += _OF_ALL * usual
        shares[name] = count / count.sum(axis=1, keepdims=True)
    return shares


def fit_corners(corners: IntArray) -> FloatArray:
    """Return how many times as often as by chance kinds meet (k, k), given how often they do."""
    share = (corners.sum(axis=1) + 1) / (corners.sum() + len(corners))
    by_chance = corners.sum() * np.outer(share, share)
    return (corners + _OF_ALL) / (by_chance + _OF_ALL)


def format_table(shares: FloatArray, densities: Mapping[str, FloatArray]) -> str:
    """Return shares and densities as the source text of `things`."""
    lines = [f"SHARES = ({', '.join(f'{share:.2f}' for share in shares)})"]
    for name, density in things.DENSITIES.items():
        lines.append(f'    "{name}": Density(')
        lines.append(f"        {density.edges},")
        rounded = np.maximum(np.round(densities[name], 2), _LEAST_SHARE).tolist()
        rows = [f"({', '.join(f'{share:.3g}' for share in of_kind)})" for of_kind in rounded]
        lines.append(f"        ({', '.join(rows)}),\n    ),")
    return "\n".join(lines)


def _report(left_out: Sequence[tuple[Surfaces, FloatArray, FloatArray]]) -> str:
    """Return what the densities are worth on kinds of buildings that were left out.

    How improbable what is so is by how much of an answer counts, and how many metres of each kind
    are taken for what.
    """
    lines = ["minus log probability of what is so, mean, by temper:"]
    for temper in _TEMPERS:
        missed = [
            -things.weigh_kinds(likely, shares, temper)[np.arange(len(own.kind)), own.kind]
            for own, likely, shares in left_out
        ]
        lines.append(f"{temper:4.1f} {np.concatenate(missed).mean():.3f}")
    metres = np.zeros((len(things.KINDS), len(things.KINDS)))
    for own, likely, shares in left_out:
        taken = things.weigh_kinds(likely, shares, things.TEMPER).argmax(axis=1)
        np.add.at(metres, (own.kind, taken), own.length_m)
    lines.append("metres of what (rows) taken for what, of kinds of buildings that were left out:")
    lines.append(" " * 10 + "".join(f"{name:>10s}" for name in things.KINDS))
    for name, row in zip(things.KINDS, metres.tolist(), strict=True):
        lines.append(f"{name:10s}" + "".join(f"{length_m:10.0f}" for length_m in row))
    return "\n".join(lines)


def _join(found: Sequence[Surfaces]) -> Surfaces:
    return Surfaces(
        features=np.concatenate([of.features for of in found]),
        kind=np.concatenate([of.kind for of in found]),
        length_m=np.concatenate([of.length_m for of in found]),
        corners=np.sum([of.corners for of in found], axis=0),
    )
