"""What is to be verified on site as topics that programs for building models show (BCF 2.1)."""

import io
import uuid
import zipfile
from datetime import UTC, datetime

import bcf.v2.model as bcf
from bcf.xml_parser import XmlParserSerializer
from xsdata.models.datatype import XmlDateTime

from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.model_origin import ModelOrigin
from scanplan.plan.floorplan import FloorPlan
from scanplan.validation.doubts import Doubt, list_doubts

_NAMESPACE = uuid.UUID("6f2c1c1e-0c5e-4d0a-9f0e-5a3b7d1c2e4f")  # any, and always the same
_AROUND_M = 6.0  # the height of a view: a room with what is beside it
_CUT_M = 1.2  # above the floor: where plans are cut
_ABOVE_M = 10.0  # of the camera above the cut: any, as the view has no perspective
_DATED = (1980, 1, 1, 0, 0, 0)  # the first day of zip: its files have no other date


def format_bcf(plan: FloorPlan, ids: ElementIds, origin: ModelOrigin) -> bytes:
    """Return the doubts about a plan as a BCF file, that first which costs most.

    A topic each, with the question to ask on site and a view from above, cut at the height of a
    plan, in which its element is selected. Elements are those of `plan.ifc` and, as far as they
    are drawn there, of `presentation.ifc`. The same for the same plan, ids and origin.
    """
    xml = XmlParserSerializer()
    project = bcf.Project(name=plan.name, project_id=_identify(plan.name))
    files = {
        "bcf.version": xml.serialize(bcf.Version(version_id="2.1", detailed_version="2.1")),
        "project.bcfp": xml.serialize(bcf.ProjectExtension(project=project, extension_schema="")),
    }
    for number, doubt in enumerate(list_doubts(plan), 1):
        topic_id = _identify(plan.name, doubt.element, doubt.about)
        view_id = _identify(topic_id, "view")
        markup = bcf.Markup(
            topic=_make_topic(doubt, number, topic_id, origin),
            viewpoints=[bcf.ViewPoint(guid=view_id, viewpoint="viewpoint.bcfv", index=0)],
        )
        files[f"{topic_id}/markup.bcf"] = xml.serialize(markup)
        view = _make_view(plan, doubt, view_id, _find_id(plan, ids, doubt))
        files[f"{topic_id}/viewpoint.bcfv"] = xml.serialize(view)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, _DATED)
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _make_topic(doubt: Doubt, number: int, topic_id: str, origin: ModelOrigin) -> bcf.Topic:
    surveyed = datetime.fromtimestamp(origin.t_ns // 10**9, UTC)
    return bcf.Topic(
        guid=topic_id,
        title=f"{doubt.name}: {doubt.reason}" if doubt.reason else doubt.name,
        description=doubt.question,
        index=number,
        labels=[label for label in (doubt.kind, doubt.room) if label],
        topic_type="Inquiry",
        topic_status="Open",
        creation_author=origin.author or "scanplan",
        creation_date=XmlDateTime.from_datetime(surveyed),
    )


def _make_view(
    plan: FloorPlan, doubt: Doubt, view_id: str, global_id: str | None
) -> bcf.VisualizationInfo:
    floor_m, _ = plan.storey_m
    x_m, y_m = doubt.place_m.tolist()
    selected = [] if global_id is None else [bcf.Component(ifc_guid=global_id)]
    return bcf.VisualizationInfo(
        guid=view_id,
        components=bcf.Components(
            selection=bcf.ComponentSelection(component=selected),
            visibility=bcf.ComponentVisibility(default_visibility=True),
        ),
        orthogonal_camera=bcf.OrthogonalCamera(
            camera_view_point=bcf.Point(x=x_m, y=y_m, z=floor_m + _CUT_M + _ABOVE_M),
            camera_direction=bcf.Direction(x=0.0, y=0.0, z=-1.0),
            camera_up_vector=bcf.Direction(x=0.0, y=1.0, z=0.0),
            view_to_world_scale=_AROUND_M,
        ),
        clipping_planes=bcf.VisualizationInfoClippingPlanes(
            clipping_plane=[
                bcf.ClippingPlane(
                    location=bcf.Point(x=x_m, y=y_m, z=floor_m + _CUT_M),
                    direction=bcf.Direction(x=0.0, y=0.0, z=1.0),
                )
            ]
        ),
    )


def _find_id(plan: FloorPlan, ids: ElementIds, doubt: Doubt) -> str | None:
    """Return the GlobalId of what is doubtful, of a face that of its wall, if it has one."""
    kind, number = doubt.kind, doubt.number
    if kind == "face":
        kind, number = "wall", int(plan.faces["wall"][plan.faces["face"] == number][0])
    numbers = {"wall": plan.walls, "opening": plan.openings, "room": plan.rooms}[kind][kind]
    known = dict(zip(numbers.tolist(), ids[kind], strict=True))
    return known.get(number)


def _identify(*words: str) -> str:
    return str(uuid.uuid5(_NAMESPACE, "/".join(words)))
