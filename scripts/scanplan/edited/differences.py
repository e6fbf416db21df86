"""What was changed in an edited file: elements that it shares with the one that it was made of."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan.edited.elements import Drawing, Element
from scanplan.types import FloatArray

TOUCHED_M = 0.005
"""What was moved by less was only touched: editors round to centimetres."""
NEAR_M = 0.5
"""From an element to the one that another program made of it, under an id of its own."""
_COSINE = 0.996  # of 5 degrees: between lines of one wall
_IN_LINE_M = 0.02  # of two pieces of one wall, across
_BESIDE_M = 0.3  # from the middle of a wall to that of an opening in it
_GAP_M = 0.05  # between them, along


@dataclass(frozen=True, eq=False)
class Change:
    """An element before and after it was edited; None where there was, or is, none."""

    before: Element | None
    after: Element | None

    def divide_places(self, factor: float) -> "Change":
        """Return it with both elements' places so many times nearer to the origin."""
        before, after = (of and of.divide_places(factor) for of in (self.before, self.after))
        return Change(before, after)

    @property
    def kind(self) -> str:
        """Of the element."""
        element = self.before or self.after
        assert element is not None
        return element.kind


def count_same(base: Drawing, edited: Drawing) -> int:
    """Return how many elements of a file are in an edited one as they were."""
    return sum(not list_changed(change) for change in pair_elements(base, edited) if change.before)


def find_changes(base: Drawing, edited: Drawing) -> list[Change]:
    """Return what an edited file changed of the one that it was made of, in the base's order."""
    changes = [change for change in pair_elements(base, edited) if list_changed(change)]
    gone = {c.before.key for c in changes if c.kind == "wall" and c.before and c.after is None}
    # with a wall go its openings
    return [change for change in changes if not _goes_along(change, gone)]


def _goes_along(change: Change, gone: set[str]) -> bool:
    before = change.before
    return change.after is None and before is not None and before.host in gone


def pair_elements(base: Drawing, edited: Drawing) -> list[Change]:
    """Return each element of a file with what became of it, then those that were added.

    Elements are matched by their keys, those left over by their place. A wall that was parted, as
    editors do where others end at it, is one again.
    """
    edited_walls = _join_parted(base.of("wall"), edited.of("wall"))
    others = [element for element in edited.elements if element.kind != "wall"]
    after = [*edited_walls, *others]
    of_key: dict[tuple[str, str], Element] = {}
    extra: list[Element] = []
    for element in after:
        if of_key.setdefault((element.kind, element.key), element) is not element:
            extra.append(element)
    changes: list[Change] = []
    lost: list[Element] = []
    for element in base.elements:
        found = of_key.pop((element.kind, element.key), None)
        if found is None:
            lost.append(element)
        else:
            changes.append(Change(element, found))
    added = [*of_key.values(), *extra]
    for element in lost:
        near = [other for other in added if _is_in_place(element, other)]
        if near:
            added.remove(near[0])
        changes.append(Change(element, near[0] if near else None))
    order: dict[Element | None, int] = {element: row for row, element in enumerate(base.elements)}
    changes.sort(key=lambda change: order[change.before])
    walls = [change for change in changes if change.kind == "wall"]
    changes = [part for change in changes for part in _slide(change, walls)]
    return [*changes, *(Change(None, element) for element in added)]


def _slide(change: Change, walls: Sequence[Change]) -> Iterator[Change]:
    """Yield what became of an opening: it goes across with its wall, and along it by itself.

    One that is in another wall is another opening.
    """
    before, after = change.before, change.after
    if change.kind != "opening" or before is None or after is None:
        yield change
        return
    hosts = [of for of in walls if of.before is not None and of.before.key == before.host]
    host = hosts[0].after if hosts else None
    if host is None or host.is_bent or after.line_m is None or before.line_m is None:
        yield change
        return
    assert host.line_m is not None and after.middle is not None
    if shapely.LineString(host.line_m).distance(after.middle) > _BESIDE_M:
        yield from (Change(before, None), Change(None, after))
        return
    by_m = (align(after.line_m, before.line_m) - before.line_m) @ host.along
    line_m = before.line_m + by_m[:, None] * host.along
    facts = dict(after.facts)
    if "opens_m" in facts:
        facts["opens_m"] = facts["opens_m"] + line_m.mean(axis=0) - after.line_m.mean(axis=0)
    yield Change(before, replace(after, line_m=line_m, facts=facts))


def list_changed(change: Change) -> list[str]:
    """Return the names of what was changed of an element: `line`, `outline`, or facts of it.

    `exists` where it was added or removed.
    """
    before, after = change.before, change.after
    if before is None or after is None:
        return ["exists"]
    changed: list[str] = []
    if before.line_m is not None and after.line_m is not None:
        moved_m = np.abs(align(after.line_m, before.line_m) - before.line_m).max()
        changed += ["line"] if moved_m > TOUCHED_M else []
    if before.outline is not None and after.outline is not None:
        # within a hair of one another: no corner was moved
        far_m = shapely.hausdorff_distance(before.outline, after.outline)
        changed += ["outline"] if far_m > TOUCHED_M else []
    for name in sorted(after.facts):
        value = after.facts[name]
        is_other = (
            _hangs_elsewhere(before, after)
            if name == "opens_m"
            else _is_other(before.facts.get(name), value)
        )
        changed += [name] if is_other else []
    return changed


def align(line_m: FloatArray, other_m: FloatArray) -> FloatArray:
    """Return a line (2, 2) so that it runs the way of another."""
    return line_m if np.vdot(line_m[1] - line_m[0], other_m[1] - other_m[0]) >= 0 else line_m[::-1]


def _is_other(before: object, after: object) -> bool:
    if isinstance(before, float) and isinstance(after, float):
        return abs(before - after) > TOUCHED_M
    return before != after


def _hangs_elsewhere(before: Element, after: Element) -> bool:
    """Return whether a leaf stands elsewhere, seen from the middle of its door."""
    if "opens_m" not in before.facts:
        return True
    places_m = [
        of.facts["opens_m"] - of.line_m.mean(axis=0)
        for of in (before, after)
        if of.line_m is not None
    ]
    return bool(np.hypot(*(places_m[0] - places_m[1])) > NEAR_M)


def _is_in_place(element: Element, other: Element) -> bool:
    """Return whether an element of another key lies where one did."""
    if element.kind != other.kind or element.middle is None or other.middle is None:
        return False
    near = element.middle.distance(other.middle) <= NEAR_M
    if element.kind != "wall":
        return near
    lines = [shapely.LineString(of.line_m) for of in (element, other)]
    is_parallel = abs(float(element.along @ other.along)) > _COSINE
    return is_parallel and (near or lines[0].hausdorff_distance(lines[1]) <= NEAR_M)


def _join_parted(base: Sequence[Element], walls: Sequence[Element]) -> list[Element]:
    """Return walls with those joined that are in one line with one that was longer before."""
    known = {wall.key: wall for wall in base}
    joined = [wall for wall in walls if wall.key in known]
    new = [wall for wall in walls if wall.key not in known]
    for row, wall in enumerate(joined):
        before = known[wall.key]
        if wall.is_bent or wall.length_m > before.length_m - _GAP_M:
            continue
        while (part := next(_list_next(wall, before, new), None)) is not None:
            new.remove(part)
            wall = replace(wall, line_m=_reach_over(wall, part))
        joined[row] = wall
    return [*joined, *new]


def _list_next(wall: Element, before: Element, new: Sequence[Element]) -> Iterator[Element]:
    """Yield new walls that go on with one, within where it was before."""
    assert wall.line_m is not None and before.line_m is not None
    normal = np.array([-wall.along[1], wall.along[0]])
    for part in new:
        assert part.line_m is not None
        off_m = np.abs((part.line_m - wall.line_m[0]) @ normal).max()
        at_m = np.sort((part.line_m - wall.line_m[0]) @ wall.along)
        low_m, high_m = np.sort((before.line_m - wall.line_m[0]) @ wall.along)
        follows = min(abs(at_m[0] - wall.length_m), abs(at_m[1])) <= _GAP_M
        is_inside = low_m - _GAP_M <= at_m[0] and at_m[1] <= high_m + _GAP_M
        if not part.is_bent and off_m <= _IN_LINE_M and follows and is_inside:
            yield part


def _reach_over(wall: Element, part: Element) -> FloatArray:
    assert wall.line_m is not None and part.line_m is not None
    places_m = np.concatenate([wall.line_m, part.line_m])
    at_m = (places_m - wall.line_m[0]) @ wall.along
    return places_m[[int(np.argmin(at_m)), int(np.argmax(at_m))]]
