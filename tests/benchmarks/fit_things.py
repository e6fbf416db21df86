"""The densities of what surfaces are sides of, fitted on floors of the tuning half.

Surfaces of plans by labels are looked up in the truths of their drives: what most of their length
is. Shares of each range of each feature are counted, rounded, and printed as the tables that
`plan/model/thing_densities.py` holds; by leaving out a kind of building at a time it is said what
they are worth on others.
"""

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import ablation
import ablation_scores
import numpy as np
from ablation_switches import Function, Rule

from scanplan.lab.evaluation import face_cells
from scanplan.lab.evaluation.scores import false_walls, score_files
from scanplan.plan.model import thing_densities, things
from scanplan.plan.model.roofs import Roof
from scanplan.plan.model.surface_features import Features, Surroundings
from scanplan.plan.model.thing_densities import Density, Population
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
    """Surfaces of some drives: features (n, f) in the order of `things.FEATURES`, and kinds.

    And how often kinds (k, k) meet at outer corners.
    """

    features: FloatArray
    kind: IntArray
    length_m: FloatArray
    corners: IntArray


def bench(folder: Path, names: Sequence[str], settings: Settings) -> None:
    """Print the tables, and what they are worth.

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
    kinds = [floor.kind for floor in chosen.values()]
    for name in ("IN_SPACE", "IN_PLANE"):
        population = getattr(thing_densities, name)
        own = [
            (of, kind)
            for of, kind in zip(found, kinds, strict=True)
            if things.choose_population(of.features) is population
        ]
        if own:
            print(f"{name} = {format_population(fit(_join([of for of, _ in own]), population))}")
            print(_report(list(_leave_out(own, population))))
    print(f"CORNERS = {fit_corners(_join(found).corners).round(2).tolist()}")


def _leave_out(
    own: Sequence[tuple[Surfaces, str]], population: Population
) -> Iterator[tuple[Surfaces, Population]]:
    """Yield the surfaces of each kind of building, and what those of all others teach."""
    for kind in sorted({kind for _, kind in own}):
        rest = _join([of for of, other in own if other != kind])
        yield _join([of for of, other in own if other == kind]), fit(rest, population)


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
    return Surfaces(
        features=things.list_values([features[row] for row in taught]),
        kind=kind[taught],
        length_m=np.array([parts[row].length_m for row in taught]),
        corners=corners,
    )


def count_shares(of: Surfaces) -> FloatArray:
    """Return the share (k,) of each kind of all surfaces, and of one more of each."""
    count = np.bincount(of.kind, minlength=len(things.KINDS)) + 1
    return count / count.sum()


def fit(of: Surfaces, population: Population) -> Population:
    """Return a population of the same features and ranges with the shares of some surfaces."""
    densities: dict[str, Density] = {}
    for name, density in population.densities.items():
        value = of.features[:, things.FEATURES.index(name)]
        known = ~np.isnan(value)
        place = np.searchsorted(density.edges, value[known], "right")
        count = np.zeros((len(things.KINDS), len(density.edges) + 1))
        np.add.at(count, (of.kind[known], place), 1.0)
        usual = (count.sum(axis=0) + 1) / (count.sum() + count.shape[1])
        count += _OF_ALL * usual
        shares = count / count.sum(axis=1, keepdims=True)
        densities[name] = Density(density.edges, tuple(map(tuple, shares.tolist())))
    return Population(tuple(count_shares(of).tolist()), densities)


def fit_corners(corners: IntArray) -> FloatArray:
    """Return how many times as often as by chance kinds meet (k, k), given how often they do."""
    share = (corners.sum(axis=1) + 1) / (corners.sum() + len(corners))
    by_chance = corners.sum() * np.outer(share, share)
    return (corners + _OF_ALL) / (by_chance + _OF_ALL)


def format_population(of: Population) -> str:
    """Return shares and densities as the source text of `thing_densities`."""
    lines = [
        "Population(",
        f"    shares=({', '.join(f'{share:.2f}' for share in of.shares)}),",
        "    densities={",
    ]
    for name, density in of.densities.items():
        rounded = np.maximum(np.round(density.shares, 2), _LEAST_SHARE).tolist()
        rows = [f"({', '.join(f'{share:.3g}' for share in of_kind)})" for of_kind in rounded]
        lines.append(f'        "{name}": Density({density.edges}, ({", ".join(rows)})),')
    return "\n".join([*lines, "    },", ")"])


def _report(left_out: Sequence[tuple[Surfaces, Population]]) -> str:
    """Return what the densities are worth on kinds of buildings that were left out.

    How improbable what is so is by how much of an answer counts, and how many metres of each kind
    are taken for what.
    """
    lines = ["minus log probability of what is so, mean, by temper:"]
    likely = [things.weigh_features(own.features, of) for own, of in left_out]
    for temper in _TEMPERS:
        missed = [
            -things.weigh_kinds(of_own, of.shares, temper)[np.arange(len(own.kind)), own.kind]
            for of_own, (own, of) in zip(likely, left_out, strict=True)
        ]
        lines.append(f"{temper:4.1f} {np.concatenate(missed).mean():.3f}")
    metres = np.zeros((len(things.KINDS), len(things.KINDS)))
    for of_own, (own, of) in zip(likely, left_out, strict=True):
        taken = things.weigh_kinds(of_own, of.shares, things.TEMPER).argmax(axis=1)
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
