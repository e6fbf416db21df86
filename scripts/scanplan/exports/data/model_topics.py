"""What somebody has to look into, as topics that programs for building models show (BCF 2.1).

Written as buildingSMART's schemas markup.xsd and visinfo.xsd have it; the library for it is under
the GPL, which this project's code is not.
"""

import io
import uuid
import zipfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from xml.etree import ElementTree

_NAMESPACE = uuid.UUID("0d7c0a51-2c1b-5d57-9b0e-6f3f5b1c8e42")  # ours, drawn once
_ABOVE_M = 10.0  # of the camera above what it shows: any, as the view has no perspective
_AROUND_M = 8.0  # the height of a view: a room with what is beside it
_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the first date that zip files know
_VERSION = "2.1"


@dataclass(frozen=True)
class Topic:
    """Something to look into.

    Attributes
    ----------
    key : str
        What it is about: the same of the next run.
    title, text : str
    kind : str
        What viewers sort topics by.
    guid : str
        GlobalId of the element; empty of what the model lacks.
    place_m : (float, float, float)
        In the model's frame.
    labels : sequence of str
    is_cut : bool
        Whether the view leaves out what is above the place.
    model : str
        Name of the file that the element is in; empty where none is stated.
    """

    key: str
    title: str
    text: str
    kind: str
    guid: str
    place_m: tuple[float, float, float]
    labels: Sequence[str] = ()
    is_cut: bool = False
    model: str = ""


def format_topics(name: str, topics: Sequence[Topic], t_ns: int, author: str = "") -> bytes:
    """Return topics as a BCF file, each with a view from above in which its element is selected.

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
    files = {
        "bcf.version": _node("Version", _node("DetailedVersion", _VERSION), VersionId=_VERSION),
        "project.bcfp": _node(
            "ProjectExtension",
            _node("Project", _node("Name", name), ProjectId=_identify(name)),
            _node("ExtensionSchema"),
        ),
    }
    at = datetime.fromtimestamp(t_ns // 10**9, UTC).isoformat()
    for number, topic in enumerate(topics, 1):
        folder = _identify(f"{name}/{topic.key}")
        view = _identify(f"{folder}/view")
        files[f"{folder}/markup.bcf"] = _node(
            "Markup",
            *_name_model(topic),
            _node(
                "Topic",
                _node("Title", topic.title),
                _node("Index", str(number)),
                *(_node("Labels", label) for label in topic.labels),
                _node("CreationDate", at),
                _node("CreationAuthor", author or "scanplan"),
                _node("Description", topic.text),
                Guid=folder,
                TopicType=topic.kind,
                TopicStatus="Open",
            ),
            _node("Viewpoints", _node("Viewpoint", "viewpoint.bcfv"), Guid=view),
        )
        files[f"{folder}/viewpoint.bcfv"] = _look_at(topic, view)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for path, root in files.items():
            text = ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
            archive.writestr(zipfile.ZipInfo(path, _LONG_AGO), text, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _name_model(topic: Topic) -> list[ElementTree.Element]:
    """Return the header that says in which file the element is, which lies beside the topics."""
    if not topic.model:
        return []
    return [_node("Header", _node("File", _node("Filename", topic.model), isExternal="true"))]


def _look_at(topic: Topic, guid: str) -> ElementTree.Element:
    x_m, y_m, z_m = topic.place_m
    chosen = [_node("Component", IfcGuid=topic.guid)] if topic.guid else []
    cut = _node(
        "ClippingPlane",
        _point("Location", (x_m, y_m, z_m)),
        _point("Direction", (0.0, 0.0, 1.0)),
    )
    return _node(
        "VisualizationInfo",
        _node(
            "Components",
            *([_node("Selection", *chosen)] if chosen else []),
            _node("Visibility", DefaultVisibility="true"),
        ),
        _node(
            "OrthogonalCamera",
            _point("CameraViewPoint", (x_m, y_m, z_m + _ABOVE_M)),
            _point("CameraDirection", (0.0, 0.0, -1.0)),
            _point("CameraUpVector", (0.0, 1.0, 0.0)),
            _node("ViewToWorldScale", str(_AROUND_M)),
        ),
        *([_node("ClippingPlanes", cut)] if topic.is_cut else []),
        Guid=guid,
    )


def _point(tag: str, place_m: Iterable[float]) -> ElementTree.Element:
    return _node(tag, *(_node(a, repr(v)) for a, v in zip("XYZ", place_m, strict=True)))


def _node(tag: str, *content: str | ElementTree.Element, **attributes: str) -> ElementTree.Element:
    element = ElementTree.Element(tag, attributes)
    for part in content:
        if isinstance(part, str):
            element.text = part
        else:
            element.append(part)
    return element


def _identify(words: str) -> str:
    return str(uuid.uuid5(_NAMESPACE, words))
