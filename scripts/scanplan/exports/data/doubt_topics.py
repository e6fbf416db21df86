"""What is to be verified on site, as topics of a BCF file."""

from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.data.model_topics import Topic, format_topics
from scanplan.exports.model_origin import ModelOrigin
from scanplan.plan.floorplan import FloorPlan
from scanplan.validation.doubts import Doubt, list_doubts

_CUT_M = 1.2  # above the floor: where plans are cut


def format_bcf(plan: FloorPlan, ids: ElementIds, origin: ModelOrigin) -> bytes:
    """Return the doubts about a plan as a BCF file, that first which costs most.

    A topic each, with the question to ask on site and a view from above, cut at the height of a
    plan, in which its element is selected. Elements are those of `plan.ifc` and, as far as they
    are drawn there, of `presentation.ifc`. The same for the same plan, ids and origin.
    """
    floor_m, _ = plan.storey_m
    topics = [
        Topic(
            key=f"{doubt.element}/{doubt.about}",
            title=f"{doubt.name}: {doubt.reason}" if doubt.reason else doubt.name,
            text=doubt.question,
            kind="Inquiry",
            guid=_find_id(plan, ids, doubt) or "",
            place_m=(float(doubt.place_m[0]), float(doubt.place_m[1]), floor_m + _CUT_M),
            labels=[label for label in (doubt.kind, doubt.room) if label],
            is_cut=True,
        )
        for doubt in list_doubts(plan)
    ]
    return format_topics(plan.name, topics, origin.t_ns, origin.author)


def _find_id(plan: FloorPlan, ids: ElementIds, doubt: Doubt) -> str | None:
    """Return the GlobalId of what is doubtful, of a face that of its wall, if it has one."""
    kind, number = doubt.kind, doubt.number
    if kind == "face":
        kind, number = "wall", int(plan.faces["wall"][plan.faces["face"] == number][0])
    numbers = {"wall": plan.walls, "opening": plan.openings, "room": plan.rooms}[kind][kind]
    known = dict(zip(numbers.tolist(), ids[kind], strict=True))
    return known.get(number)
