"""The weights of what parts rooms, fitted on planar floors of the tuning half.

Floor is cut into cells by all lines that may part it. Cells of one true room are joined, in an
order by chance, and at each step it is noted of some pairs of regions what is weighed of them, and
whether they are two rooms. A logistic regression of that is what `plan/model/parting_odds.py`
holds; without a kind of building at a time it is said how far the weights swing.
"""

import random
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import ablation
import ablation_scores
import numpy as np
import shapely
from ablation_switches import Function, Rule
from catalogue import survey_settings
from realistic.floors import Floor
from sklearn.linear_model import LogisticRegression

from scanplan.geometry import overlays
from scanplan.geometry.ground_cells import GroundCells
from scanplan.plan.model import parting_odds
from scanplan.plan.model.room_partition import JoinedCells, RegionGraph
from scanplan.stage import workers
from scanplan.types import Array, BoolArray, FloatArray, IntArray, Settings

_PROCESSES = 2
_PAIRS = 6  # of regions, noted at each step
_ROUNDS = 2
_PURE = 0.6  # of a cell, in one true room; of another it is not known where it belongs


@dataclass(frozen=True, eq=False)
class Ground:
    """A piece of floor in cells, and the true room of each, -1: not known."""

    cells: GroundCells
    terms: FloatArray
    is_visited: BoolArray
    room: IntArray


def bench(folder: Path, names: Sequence[str], settings: Settings) -> None:
    """Print the weights.

    Parameters
    ----------
    folder, names
        See `ablation.choose_floors`.
    settings : dict
        Default settings.
    """
    chosen = ablation.choose_floors(folder, names, _is_planar, "fit_partings")
    with workers.open_pool(min(_PROCESSES, len(chosen))) as run:
        found = list(run(observe, [(path, settings) for path in chosen]))
    terms, is_apart = _stack(found)
    weights = fit(terms, is_apart)
    print(f"WEIGHTS = {tuple(weights[:-2].round(2).tolist())}")
    print(f"AREA, UNVISITED = {tuple(weights[-2:].round(2).tolist())}")
    kinds = [floor.kind for floor in chosen.values()]
    for kind in sorted(set(kinds)):
        rest = [of for of, name in zip(found, kinds, strict=True) if name != kind]
        if rest:
            print(f"without {kind}: {fit(*_stack(rest)).round(2).tolist()}")


def _is_planar(floor: Floor) -> bool:
    """Return whether a floor was driven with a planar sensor, as all real ones were."""
    return floor.drive is None or floor.sensor in survey_settings.PLANAR


def observe(results: Path, settings: Settings) -> tuple[FloatArray, BoolArray]:
    """Return what is weighed (n, t) of pairs of regions of a floor, and which are two rooms."""
    terms: list[FloatArray] = []
    parts: list[tuple[GroundCells, BoolArray]] = []

    def record(_: Function) -> Function:
        def asked(cells: GroundCells, _: FloatArray, is_visited: BoolArray) -> JoinedCells:
            parts.append((cells, is_visited))
            n_cells = len(cells.cells)  # of what is recorded all is asked, later
            return JoinedCells(np.zeros(n_cells, np.int64), np.zeros(n_cells), np.zeros(n_cells))

        return asked

    def record_terms(_: Function) -> Function:
        def asked(measures: parting_odds.LineMeasures) -> FloatArray:
            terms.append(measures.list_terms())
            return np.zeros(len(terms[-1]))  # what is unlikely by the weights of today teaches, too

        return asked

    rule = Rule(
        {
            "plan.rooms.partings:weigh_lines": record_terms,
            "plan.rooms.partings:join_cells": record,
        },
        (),
    )
    with tempfile.TemporaryDirectory() as made:
        ablation.make_plan(results, ablation.own_settings(results, settings), rule, Path(made))
    placed = ablation_scores.place(results)
    back = np.linalg.inv(placed.motion)
    rooms = shapely.transform(placed.scene.rooms, lambda xy: xy @ back[:2, :2].T + back[:2, 3])
    return note_floor(terms, parts, rooms, random.Random(results.name))


def note_floor(
    terms: Sequence[FloatArray],
    parts: Sequence[tuple[GroundCells, BoolArray]],
    rooms: Array,
    choose: random.Random,
) -> tuple[FloatArray, BoolArray]:
    """Return what is weighed (n, t) of pairs of regions of a floor, and which are two rooms."""
    noted: list[tuple[FloatArray, bool]] = []
    for of_lines, (cells, is_visited) in zip(terms, parts, strict=True):
        ground = Ground(cells, of_lines, is_visited, find_true_rooms(cells.cells, rooms))
        for _ in range(_ROUNDS):
            noted += note_joins(ground, choose)
    n_terms = len(parting_odds.WEIGHTS) + 2
    return (
        np.array([terms for terms, _ in noted]).reshape(-1, n_terms),
        np.array([is_apart for _, is_apart in noted], bool),
    )


def find_true_rooms(cells: Array, rooms: Array) -> IntArray:
    """Return the room that most of each cell (c,) lies in; -1: none is known."""
    tree = shapely.STRtree(rooms)
    cell, room = tree.query(cells, predicate="intersects")
    share = shapely.area(overlays.intersect_areas(cells[cell], rooms[room])) / shapely.area(
        cells[cell]
    )
    found = np.full(len(cells), -1)
    found[cell[share > _PURE]] = room[share > _PURE]
    return found


def note_joins(ground: Ground, choose: random.Random) -> list[tuple[FloatArray, bool]]:
    """Join regions of one true room, one after another; of some pairs note what is weighed."""
    graph: RegionGraph[FloatArray] = RegionGraph(ground.cells, ground.terms, ground.is_visited)
    room = dict(enumerate(ground.room.tolist()))
    noted: list[tuple[FloatArray, bool]] = []
    while True:
        pairs = graph.list_pairs()
        known = [(one, other) for one, other in pairs if min(room[one], room[other]) >= 0]
        one_room = [
            (one, other)
            for one, other in pairs
            if room[one] == room[other] or min(room[one], room[other]) < 0
        ]
        asked = choose.sample(known, min(_PAIRS, len(known))) if one_room else known
        noted += [(_list_terms(graph, *pair), room[pair[0]] != room[pair[1]]) for pair in asked]
        if not one_room:
            return noted
        one, other = choose.choice(one_room)
        room[one] = max(room[one], room[other])
        graph.join(one, other)


def _list_terms(graph: RegionGraph[FloatArray], one: int, other: int) -> FloatArray:
    """Return what is weighed of whether two regions are apart."""
    apart, beside = graph.regions[one], graph.regions[other]
    of_rooms = [
        np.array(parting_odds.list_room_terms(of.area_m2, is_visited=of.is_visited))
        for of in (apart, beside, apart.join(beside))
    ]
    return np.append(graph.borders[one][other], of_rooms[0] + of_rooms[1] - of_rooms[2])


def fit(terms: FloatArray, is_apart: BoolArray) -> FloatArray:
    """Return the weights (t,) of a logistic regression."""
    model = LogisticRegression(fit_intercept=False, max_iter=2000)
    return np.asarray(model.fit(terms, is_apart).coef_[0], float)


def _stack(found: Sequence[tuple[FloatArray, BoolArray]]) -> tuple[FloatArray, BoolArray]:
    terms, is_apart = zip(*found, strict=True)
    return np.concatenate(terms), np.concatenate(is_apart)
