"""The names in parameter files that other programs use: controllers, their joints and frames, and their types."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.breaking import name_reason
from linkwright.review.files.yaml_values import YamlValue
from linkwright.review.list_changes import list_items

_FRAMES = re.compile(r"(^|[._])frame_id$")
"""The parameters with frames that any node offers to other programs."""
_USED_FRAMES = re.compile(r"(^|[._])(base|odom|map|global|world|target|reference)_frame_id$")
"""The parameters with frames that localization and navigation only use. Controllers publish them."""
_JOINTS = re.compile(r"(^|[._])(joints?|joint_names?|wheel_names)$")
"""The parameters with joints that a controller offers. Other nodes only use them."""
_CONTROLLER_TYPE = re.compile(r"(?:[^.]+\.)?controller_manager\.ros__parameters\.(?P<controller>[^.]+)\.type")
_OWN_TYPE = re.compile(r"(?:.+\.)?(?P<controller>[^.]+)\.ros__parameters\.type")
_NODE = re.compile(r"(?P<node>.*)\.ros__parameters\.")
_STAMPED = re.compile(r"stamped", re.IGNORECASE)
"""The parameters that choose between messages with and without a header, such as ``use_stamped_vel``."""
_STAMPED_BY_DEFAULT = "use_stamped_vel"
"""The parameter of diff_drive_controller and its relatives, which is true by default."""
_NUMBER_OR_TRUTH = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|true|false", re.IGNORECASE)
_PLUGINS = re.compile(r"(^|[._])(plugins|plugin_names|plugin_ids)$")
"""The parameters with the names of plugins, which trees of behaviors and goals name."""
_SEPARATOR = re.compile(r"(?<=.)[.\[]")
"""The separators of the names in a path."""
_MIN_FACTS = 6
"""The number of parameters and values from which a part can be recognized under another name."""
_MIN_SIMILARITY = 0.6


class NameRules:
    """The rules for breaking changes of a parameter file.

    Args:
        old: the old values by path.
        new: the new values by path.
    """

    def __init__(self, old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> None:
        self._new = new
        self._controllers = {*controllers(old), *controllers(new)}
        self._new_controllers = set(controllers(new))

    def change_reason(self, parameter: str, old_value: YamlValue, new_value: YamlValue) -> Phrase | None:
        """Return why a changed value is breaking, or None if it is not."""
        old, new = old_value.text, new_value.text
        if _STAMPED.search(parameter) and {old.lower(), new.lower()} == {"true", "false"}:
            return phrase("the message type of a topic changes between one with and one without a header")
        controller = _CONTROLLER_TYPE.fullmatch(parameter)
        if controller is not None:
            return phrase("the controller '{name}' offers other topics and actions", name=controller["controller"])
        gone = _items(old) - _items(new)
        is_offered = offers_frame(parameter)
        if self._is_controllers(parameter):
            is_offered = _FRAMES.search(parameter) is not None or _JOINTS.search(parameter) is not None
        if gone and is_offered:
            return name_reason(", ".join(sorted(gone)))
        if gone and _PLUGINS.search(parameter):
            return _plugin_reason(gone)
        return type_reason(old_value, new_value) if is_parameter(parameter) else None

    def removal_reason(self, parameter: str, old: str) -> Phrase | None:
        """Return why a removed parameter is breaking, or None if it is not.

        The type of a controller can also be one of its own parameters.
        """
        if parameter.endswith(_STAMPED_BY_DEFAULT) and old.lower() == "false" and self._has_node(parameter):
            return phrase("the message type of a topic changes between one with and one without a header")
        controller = _CONTROLLER_TYPE.fullmatch(parameter)
        if controller is not None and controller["controller"] not in self._new_controllers:
            name = controller["controller"]
            return phrase("programs that load or command the controller '{name}' do not find it", name=name)
        node = _NODE.match(parameter)
        if node is not None and not self._has_node(parameter):
            return phrase("the node '{name}' starts without these parameters", name=node["node"])
        if _PLUGINS.search(parameter) and _items(old):
            return _plugin_reason(_items(old))
        return None

    def _is_controllers(self, parameter: str) -> bool:
        """Return whether a parameter belongs to a controller."""
        node = _NODE.match(parameter)
        name = node["node"].rpartition(".")[2] if node else parameter.partition(".")[0]
        return name in self._controllers or name.endswith("controller")

    def _has_node(self, parameter: str) -> bool:
        """Return whether the new version has other parameters of the same node."""
        node = _NODE.match(parameter)
        return node is not None and any(name.startswith(node[0]) for name in self._new)


def offers_frame(parameter: str) -> bool:
    """Return whether a parameter names a frame that any node offers to other programs."""
    return _FRAMES.search(parameter) is not None and not _USED_FRAMES.search(parameter)


def is_parameter(name: str) -> bool:
    """Return whether a path is that of a parameter of a node."""
    return _NODE.match(name) is not None


def node_of_parameter(name: str) -> str | None:
    """Return the name of the node in the path of a parameter, or None for another path."""
    match = _NODE.match(name)
    return None if match is None else match["node"]


def has_other_type(old: YamlValue, new: YamlValue) -> bool:
    """Return whether two values have types that differ. Empty values fit all types."""
    if old.is_list != new.is_list and None not in (old.type, new.type):
        return True
    return None not in (old.type, new.type) and old.type is not new.type


def type_reason(old: YamlValue, new: YamlValue) -> Phrase | None:
    """Return why it is breaking that a parameter has a value of another type, or None if the type is the same."""
    if not has_other_type(old, new):
        return None
    return phrase(
        "a node that declares the parameter as {old} does not accept {new}", old=old.type_name, new=new.type_name
    )


def _plugin_reason(names: Collection[str]) -> Phrase:
    return phrase("programs that name the plugins {names} do not find them", names=quoted_names(sorted(names)))


def controllers(values: Mapping[str, YamlValue]) -> Iterator[str]:
    """Yield the names of the controllers that a file gives a type."""
    for name in values:
        match = _CONTROLLER_TYPE.fullmatch(name) or _OWN_TYPE.fullmatch(name)
        if match is not None:
            yield match["controller"]


def _items(text: str) -> set[str]:
    """Return the items of a value that is a list, or the value itself, without numbers and truth values."""
    return {item for item in list_items(text) if item and not _NUMBER_OR_TRUTH.fullmatch(item)}


def renamed_parts(old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> dict[str, str]:
    """Return the parts of a file that have another name but similar values: the new names, by old name.

    Nodes, and plugins of a node, are such parts.
    """
    old_parts, new_parts = _lone_parts(old, new), _lone_parts(new, old)
    renamed: dict[str, str] = {}
    for old_name, first in old_parts.items():
        for new_name, second in new_parts.items():
            if new_name in renamed.values() or _parent(old_name) != _parent(new_name):
                continue
            similarity = 2 * (first & second).total() / (first.total() + second.total())
            if first.total() >= _MIN_FACTS and similarity >= _MIN_SIMILARITY:
                renamed[old_name] = new_name
                break
    return renamed


def renamed_node_reason(part: str, values: Mapping[str, YamlValue]) -> Phrase | None:
    """Return why it is breaking to rename a part of the old file, or None if it has no parameters of a node."""
    inside = next((match for name in values if (match := _NODE.match(name)) and name.startswith(f"{part}.")), None)
    if inside is None or len(inside[0]) < len(part) or inside["node"] in controllers(values):
        return None
    return phrase("the node '{name}' starts without these parameters", name=inside["node"])


def part_names(name: str) -> list[str]:
    """Return the paths of the mappings and items that contain a value, the outermost first, and that of the value."""
    return [*(name[: match.start()] for match in _SEPARATOR.finditer(name)), name]


def _parent(part: str) -> str:
    return (["", *part_names(part)])[-2]


def _lone_parts(values: Mapping[str, YamlValue], others: Mapping[str, YamlValue]) -> dict[str, Counter[str]]:
    """Return the largest parts that other values do not have: their names and values, alone and together."""
    other_parts = {part for name in others for part in part_names(name)}
    parts: dict[str, Counter[str]] = {}
    for name, value in values.items():
        part = next((part for part in part_names(name) if part not in other_parts), name)
        if part != name:
            inside = name.removeprefix(part)
            parts.setdefault(part, Counter()).update([inside, f"{inside}={value.text}"])
    return parts
