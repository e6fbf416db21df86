"""What somebody has to look into as topics of a BCF file (BIM Collaboration Format 2.1)."""

import io
import uuid
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from bcf.v2 import model as bcf
from bcf.xml_parser import XmlParserSerializer
from xsdata.models.datatype import XmlDateTime

_NAMESPACE = uuid.UUID("0d7c0a51-2c1b-5d57-9b0e-6f3f5b1c8e42")  # ours, drawn once
_ABOVE_M = 10.0  # from where a viewer looks down: above the ceilings of most storeys
_VIEW_M = 8.0  # how much it shows across: a room and what is beside it
_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the first date that zip files know
_AUTHOR = "scanplan"


@dataclass(frozen=True)
class Topic:
    """Something to look into.

    Attributes
    ----------
    title, text : str
    kind : str
        What viewers sort topics by.
    guid : str
        GlobalId of the element; empty of what the model lacks.
    place_m : (float, float, float)
        In the model's frame.
    """

    title: str
    text: str
    kind: str
    guid: str
    place_m: tuple[float, float, float]


def format_topics(name: str, topics: Sequence[Topic], t_ns: int) -> bytes:
    """Return topics as a BCF file.

    Parameters
    ----------
    name : str
        Of the project.
    t_ns : int
        When what is told was found: the survey's time.

    Returns
    -------
    bytes
        The same for the same topics.
    """
    writer = XmlParserSerializer()
    project = bcf.Project(name=name, project_id=_identify(name))
    files: dict[str, object] = {
        "bcf.version": bcf.Version(version_id="2.1"),
        "project.bcfp": bcf.ProjectExtension(project=project, extension_schema=""),
    }
    for number, topic in enumerate(topics):
        folder = _identify(f"{name}/{number}/{topic.title}")
        view = _identify(f"{folder}/view")
        files[f"{folder}/markup.bcf"] = _mark_up(topic, folder, view, number, t_ns)
        files[f"{folder}/viewpoint.bcfv"] = _look_at(topic, view)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, of in files.items():
            archive.writestr(zipfile.ZipInfo(path, _LONG_AGO), writer.serialize(of))
    return packed.getvalue()


def _identify(words: str) -> str:
    return str(uuid.uuid5(_NAMESPACE, words))


def _mark_up(topic: Topic, guid: str, view: str, number: int, t_ns: int) -> bcf.Markup:
    at = XmlDateTime.from_datetime(datetime.fromtimestamp(t_ns // 10**9, UTC))
    stated = bcf.Topic(
        title=topic.title,
        index=number,
        creation_date=at,
        creation_author=_AUTHOR,
        description=topic.text,
        guid=guid,
        topic_type=topic.kind,
        topic_status="Open",
    )
    viewpoints = [bcf.ViewPoint(viewpoint="viewpoint.bcfv", guid=view)]
    return bcf.Markup(topic=stated, viewpoints=viewpoints)


def _look_at(topic: Topic, guid: str) -> bcf.VisualizationInfo:
    """Return a view from above with the element selected."""
    x_m, y_m, z_m = topic.place_m
    selected = [bcf.Component(ifc_guid=topic.guid)] if topic.guid else []
    return bcf.VisualizationInfo(
        components=bcf.Components(
            selection=bcf.ComponentSelection(component=selected) if selected else None,
            visibility=bcf.ComponentVisibility(default_visibility=True),
        ),
        orthogonal_camera=bcf.OrthogonalCamera(
            camera_view_point=bcf.Point(x=x_m, y=y_m, z=z_m + _ABOVE_M),
            camera_direction=bcf.Direction(x=0.0, y=0.0, z=-1.0),
            camera_up_vector=bcf.Direction(x=0.0, y=1.0, z=0.0),
            view_to_world_scale=_VIEW_M,
        ),
        guid=guid,
    )
