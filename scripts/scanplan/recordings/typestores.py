"""Definitions of ROS messages: a recording's own, else those of a ROS release."""

import re
from pathlib import Path

from rosbags.interfaces import Connection, MessageDefinitionFormat
from rosbags.typesys import (
    Stores,
    TypesysError,
    get_types_from_idl,
    get_types_from_msg,
    get_typestore,
)
from rosbags.typesys.store import Typestore

from scanplan.errors import StageError
from scanplan.recordings import topics
from scanplan.recordings.driver_messages import LIVOX_DEFINITION
from scanplan.stage import log

_IDL_SEPARATOR = re.compile(r"={80}\n")


def own_store(connection: Connection, path: Path) -> Typestore | None:
    """Return a type store of the connection's own definition, or None if it has no usable one."""
    definition = connection.msgdef
    if definition.format == MessageDefinitionFormat.NONE or not definition.data.strip():
        return None
    try:
        store = get_typestore(Stores.EMPTY)
        if definition.format == MessageDefinitionFormat.MSG:
            store.register(get_types_from_msg(definition.data, connection.msgtype))
        else:
            for part in filter(None, _IDL_SEPARATOR.split(definition.data)):
                text = part.split("\n", 1)[1] if part.startswith("IDL: ") else part
                store.register(get_types_from_idl(text))
        store.get_msgdef(connection.msgtype)
    except (TypesysError, KeyError, IndexError, SyntaxError) as error:
        reason = " ".join(str(error).split())[:80]
        log.log_line(
            f"{path}: definition of {connection.topic} unusable ({reason}),"
            " the standard one is taken"
        )
        return None
    return store


def standard_store(store: Stores) -> Typestore:
    """Return the type store of a release, with the transforms that the one of ROS 1 lacks.

    It has Livox's messages, too, which no release knows.
    """
    typestore = get_typestore(store)
    for msgtype in topics.LIVOX:
        text = LIVOX_DEFINITION.format(package=msgtype.partition("/")[0])
        typestore.register(get_types_from_msg(text, msgtype))
    for msgtype in topics.TRANSFORMS:
        if msgtype not in typestore.fielddefs:
            typestore.register(
                get_types_from_msg("geometry_msgs/TransformStamped[] transforms", msgtype)
            )
    return typestore


def release_store(release: str) -> Stores:
    """Return the name of a ROS 2 release's type store.

    Raises
    ------
    StageError
        If there is no such release.
    """
    releases = [s.value.removeprefix("ros2_") for s in Stores if s.value.startswith("ros2_")]
    if release not in releases:
        raise StageError(
            f"input.ros2_release: {release} is unknown; choose one of {', '.join(releases)}"
        )
    return Stores(f"ros2_{release}")
