"""Decide which changes of sources are breaking, by the names that other programs use."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import frames_reason, message_frame_reason, names_reason, quote_first
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind, SourceName, SourceNames

_HARMLESS_KINDS = (
    *(NameKind.CLIENT, NameKind.ACTION_CLIENT, NameKind.GAZEBO_CLIENT),
    *(NameKind.FRAME_LOOKUP, NameKind.MESSAGE_FRAME),
    *(NameKind.CLAIMED_INTERFACE, NameKind.PLUGINLIB_CLASS, NameKind.HARDWARE_ELEMENT),
)
_REQUESTS = frozenset({NameKind.CLIENT, NameKind.ACTION_CLIENT})
_OTHER_NODES = frozenset(
    {"move_group", "move_base", "amcl", "gazebo", "controller_manager", "robot_state_publisher", "map_server"}
)
"""The usual names of nodes of common packages. Other first words of parameters may be namespaces without a node."""
_COMMON_TOPICS = frozenset({"clock", "diagnostics", "joint_states", "parameter_events", "rosout", "tf", "tf_static"})
"""Topics that many nodes read. Nothing publishes them for one subscription."""
_HEADER_FOLDER = "include"


def is_used_by_others(kind: NameKind, path: str, names: SourceNames) -> bool:
    """Return whether other files can use the names of a kind in a source.

    C++ definitions count in headers for other packages, and Python functions in modules that are not programs.

    Args:
        kind: the kind of the names.
        path: the path of the source.
        names: the names in the source.
    """
    if kind not in (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER):
        return True
    pure_path = PurePosixPath(path)
    if pure_path.suffix == PYTHON_SUFFIX:
        return not names.is_program or kind is NameKind.CLASS
    return pure_path.suffix in CPP_SUFFIXES and _HEADER_FOLDER in pure_path.parts


def find_removal_reason(
    items: Sequence[SourceName], names: SourceNames, new_names: SourceNames, path: str
) -> Phrase | None:
    """Return the reason why removing names is breaking, or None.

    Args:
        items: the names, all of the same kind.
        names: all names in the old source.
        new_names: all names in the new source.
        path: the path of the old source.
    """
    kind = items[0].kind
    if kind is NameKind.PARAMETER:
        items = [item for item in items if not _belongs_to_other_node(item, names)]
    if kind is NameKind.SUBSCRIPTION:
        items = [item for item in items if item.name.lstrip("/") not in _COMMON_TOPICS]
    if kind is NameKind.NODE:
        items = [item for item in items if item.name not in names.helper_nodes]
    if not items or kind in _HARMLESS_KINDS or (kind is NameKind.NODE and _only_sends_requests(names)):
        return None
    item_names = [item.name for item in items]
    text = quote_first(item_names)
    if kind is NameKind.PARAMETER:
        return phrase("values that launch files and parameter files give to {names} have no effect", names=text)
    if kind is NameKind.ELEMENT:
        return phrase("values that worlds and descriptions give to {names} have no effect", names=text)
    if kind is NameKind.YAML_KEY:
        return phrase("values that YAML files give to {names} have no effect", names=text)
    if kind is NameKind.HARDWARE_PARAMETER:
        return phrase("values that descriptions give to {names} have no effect", names=text)
    if kind is NameKind.FRAME:
        return frames_reason(item_names)
    if kind in (NameKind.COMMAND_INTERFACE, NameKind.STATE_INTERFACE):
        return phrase("controllers that claim {names} do not start", names=text)
    if kind is NameKind.OPTION:
        return phrase("callers that pass {names} get an error", names=text)
    if kind is NameKind.PLUGIN:
        return phrase("programs and configurations that load the class do not find it")
    if kind is NameKind.SIMULATION_PLUGIN:
        return phrase("worlds and descriptions that load {names} do not find it", names=text)
    if kind is NameKind.LIBRARY_PLUGIN:
        is_left = any(True for _ in new_names.of_kind(kind))
        return None if is_left else phrase("worlds and descriptions that load the library get no plugin")
    if kind is NameKind.TREE_NODE:
        return phrase("behavior trees that use {names} cannot be loaded", names=text)
    if kind is NameKind.TREE_PORT:
        return phrase("behavior trees that set {names} cannot be loaded", names=text)
    if kind is NameKind.IMPORT:
        return phrase("programs that import {names} do not find it", names=text)
    if kind in (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER):
        if names.is_program:
            return None
        if path.endswith(PYTHON_SUFFIX) and kind is NameKind.MEMBER:
            return make_member_reason(item_names)
        if path.endswith(PYTHON_SUFFIX) and all("." in item.name for item in items):
            return phrase("programs that call {names} do not find it", names=text)
        if path.endswith(PYTHON_SUFFIX):
            return phrase("programs that import {names} do not find it", names=text)
        return phrase("code of other packages that uses {names} does not build", names=text)
    return names_reason(item_names)


def make_reader_reason(name: str, path: str) -> Phrase:
    """Return the reason why a source fails that gets a parameter which nothing declares any more."""
    return phrase("'{file}' still gets '{name}', which no source declares", file=PurePosixPath(path).name, name=name)


def make_member_reason(names: Sequence[str]) -> Phrase:
    """Return the reason why removed attributes of a class in Python are breaking."""
    return phrase("programs that set or read {names} fail", names=quote_first(names))


def _belongs_to_other_node(parameter: SourceName, names: SourceNames) -> bool:
    """Return whether a parameter has an absolute name in the namespace of a node of a common package."""
    node, separator, _ = parameter.name.lstrip("/").partition("/")
    is_below_node = parameter.name.startswith("/") and bool(separator)
    return (
        is_below_node
        and node in _OTHER_NODES
        and all(item.name.strip("/") != node for item in names.of_kind(NameKind.NODE))
    )


def _only_sends_requests(names: SourceNames) -> bool:
    """Return whether all names of a source are those of its node and of services and actions that it requests."""
    kinds = {item.kind for item in (*names.names, *names.expressions)} - {NameKind.FUNCTION, NameKind.OPTION}
    return bool(kinds & _REQUESTS) and kinds <= {NameKind.NODE, *_REQUESTS}


def find_message_frame_reason(item: SourceName, names: SourceNames) -> Phrase | None:
    """Return the reason why messages in another frame are breaking, or None if the source publishes no messages.

    Args:
        item: the old frame.
        names: all names in the old source.
    """
    if all(other.kind is not NameKind.PUBLISHER for other in (*names.names, *names.expressions)):
        return None
    return message_frame_reason(item.name)
