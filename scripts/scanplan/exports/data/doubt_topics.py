"""What is to be verified on site, as topics of a BCF file."""

from collections.abc import Mapping

from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.data.model_topics import Topic, format_topics
from scanplan.exports.model_origin import ModelOrigin
from scanplan.plan.floorplan import FloorPlan
from scanplan.validation.doubts import Doubt, list_doubts

_CUT_M = 1.2  # above the floor: where plans are cut


def format_bcf(
    plan: FloorPlan,
    ids: ElementIds,
    origin: ModelOrigin,
    models: Mapping[str, str] | None = None,
) -> bytes:
    """Return the doubts about a plan as a BCF file in a language, that first which costs most.

    A topic each, with the question to ask on site and a view from above, cut at the height of a
    plan, in which its element is selected. The same for the same plan, ids, origin and models.

    Parameters
    ----------
    models : dict of str to str, optional
        Texts of models by the names of their files. A topic is of the first that has its element,
        and selects none where no model has it; without models it names no file.
    """
    floor_m, _ = plan.storey_m
    locale = origin.locale
    topics = []
    for doubt in list_doubts(plan, locale):
        model, guid = _find_model(_find_id(plan, ids, doubt) or "", models or {})
        topics.append(
            Topic(
                key=f"{doubt.element}/{doubt.about}",
                title=f"{doubt.name}: {doubt.reason}" if doubt.reason else doubt.name,
                text=doubt.question,
                kind="Inquiry",
                guid=guid,
                place_m=(float(doubt.place_m[0]), float(doubt.place_m[1]), floor_m + _CUT_M),
                labels=[label for label in (locale.say(doubt.kind), doubt.room) if label],
                is_cut=True,
                model=model,
            )
        )
    return format_topics(plan.name, topics, origin.t_ns, origin.author)


def _find_model(guid: str, models: Mapping[str, str]) -> tuple[str, str]:
    """Return the file that a topic is of, and the GlobalId of what it selects there."""
    for name, text in models.items():
        if guid and f"'{guid}'" in text:
            return name, guid
    return next(iter(models), ""), "" if models else guid


def _find_id(plan: FloorPlan, ids: ElementIds, doubt: Doubt) -> str | None:
    """Return the GlobalId of what is doubtful, of a face that of its wall, if it has one."""
    kind, number = doubt.kind, doubt.number
    if kind == "face":
        kind, number = "wall", int(plan.faces["wall"][plan.faces["face"] == number][0])
    numbers = {"wall": plan.walls, "opening": plan.openings, "room": plan.rooms}[kind][kind]
    known = dict(zip(numbers.tolist(), ids[kind], strict=True))
    return known.get(number)
