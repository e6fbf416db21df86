"""How rules of the plan are switched off: a function replaced by one that finds nothing.

A rule is switched off where it is called, so that all before and after it stays as it is. What its
replacement returns is what would be there without its code.
"""

import importlib
import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from scanplan.plan import walls
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.face_raster import CELL_M

Function = Callable[..., Any]
Switch = Callable[[Function], Function]
"""Makes of a function the one that stands for it while the rule is off."""


@dataclass(frozen=True)
class Rule:
    """A rule of the plan.

    Attributes
    ----------
    switches : dict of str to callable
        What makes the replacement of each function, by package.module:name or
        package.module:Class.name below scanplan.
    code : tuple of str
        What would go with the rule: modules below scanplan, or functions and classes in them.
    planar : bool, optional
        Whether it is asked of planar scans alone, or of those in space alone.
    """

    switches: Mapping[str, Switch]
    code: tuple[str, ...]
    planar: bool | None = None


def make_rule(place: str, switch: Switch, *code: str, planar: bool | None = None) -> Rule:
    """Return a rule of one function, whose code that is unless other code is named."""
    return Rule({place: switch}, code or (place,), planar)


@contextmanager
def switched_off(rule: Rule) -> Iterator[None]:
    """Replace the functions of a rule as long as the context lasts."""
    before: list[tuple[Any, str, Function]] = []
    try:
        for place, switch in rule.switches.items():
            holder, name = find_holder(place)
            function = getattr(holder, name)
            before.append((holder, name, function))
            setattr(holder, name, switch(function))
        yield
    finally:
        for holder, name, function in reversed(before):
            setattr(holder, name, function)


def find_holder(place: str) -> tuple[Any, str]:
    """Return the module or class that holds the function at a place, and its name there."""
    module, _, path = place.partition(":")
    holder: Any = importlib.import_module(f"scanplan.{module}")
    *classes, name = path.split(".")
    for of_class in classes:
        holder = getattr(holder, of_class)
    return holder, name


def answer(value: Any) -> Switch:
    """Answer the same whatever is asked."""
    return lambda _: lambda *_args, **_named: value


def find_none(_: Function) -> Function:
    """Find nothing: an empty list, a new one each time."""
    return lambda *_args, **_named: []


def give_back(number: int) -> Switch:
    """Return the argument in a place as it is given."""
    return lambda _: lambda *args, **_named: args[number]


def give_alone(number: int) -> Switch:
    """Return the argument in a place as the only one of a list."""
    return lambda _: lambda *args, **_named: [args[number]]


def give_each(make: Callable[[Any], Any]) -> Switch:
    """Return something for each of what is given first."""
    return lambda _: lambda given, *_args, **_named: [make(one) for one in given]


def ask_with(**values: Any) -> Switch:
    """Ask the same with other keywords."""
    return lambda function: lambda *args, **named: function(*args, **{**named, **values})


def put(number: int, value: Any) -> Switch:
    """Ask the same with another argument in one's place."""
    return lambda function: (
        lambda *args, **named: function(*args[:number], value, *args[number + 1 :], **named)
    )


def keep_fronts(_: Function) -> Function:
    """Return walls as they are, with no furniture and no leaves."""
    return lambda of_plan, *_args, **_named: (of_plan, [], [])


def leave_leaves_alone(_: Function) -> Function:
    """Return the surfaces of leaves without those that show them again."""
    return lambda leaves, *_args, **_named: [leaf.face for leaf in leaves]


def keep_all_returns(_: Function) -> Function:
    """Return that no return is a passer's."""
    return lambda returns, *_args: np.zeros(len(returns.cell), bool)


def keep_whole(_: Function) -> Function:
    """Return walls uncut at what was not seen."""

    def cut(assembly: Any, wall: PlanWall) -> list[PlanWall]:
        spans_m = np.array([np.sort(wall.line.along_m(face.ends)) for face in wall.members])
        gaps = [assembly._classify(wall, *gap_m) for gap_m in walls.find_gaps(spans_m)]
        return [walls._part(wall, spans_m, gaps, -math.inf, math.inf)]

    return cut


def draw_as_seen(_: Function) -> Function:
    """Return the part of the floor itself."""
    return lambda part, *_args: part.simplify(CELL_M)
