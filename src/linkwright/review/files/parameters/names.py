"""Check shared names and the types of parameters in parameter files.

The names are those of controllers, joints and frames.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, counted, phrase, quoted_names
from linkwright.review.breaking import name_reason, names_reason
from linkwright.review.files.parameters.costmap_topics import CostmapTopics, FindRemappings
from linkwright.review.files.parameters.declared_types import has_recorded_type
from linkwright.review.files.parameters.key_readers import KeyReaders
from linkwright.review.files.parameters.replaced_classes import find_replaced_classes, is_below_any
from linkwright.review.files.parameters.unread_plugins import is_unread_plugin
from linkwright.review.files.parameters.yaml_values import YamlType, YamlValue
from linkwright.review.texts.list_changes import EMPTY, list_items

_FRAME_PARAMETER = re.compile(r"(^|[._])frame_id$")
"""The parameters that name a frame which the node publishes."""
_USED_FRAME_PARAMETER = re.compile(r"(^|[._])(base|odom|map|global|world|target|reference)_frame_id$")
"""The parameters that name a frame which localization and navigation use but do not publish."""
_ODOMETRY_FRAME = re.compile(r"(^|[._])(odometry_frame|odom_child_frame|wheel_odom_\w+_frame)(_id)?$")
"""The parameters that name a frame of the odometry which the node publishes."""
_ODOM_FRAME = re.compile(r"(?P<node>(?:.*\.)?)odom_frame")
"""A parameter that programs with a child frame of the odometry publish, and others use."""
_CLIENT = re.compile(r"(^|[_.])client(_|$)")
"""The names of programs that send requests, and of their files."""
_TRANSFORM_SWITCH = re.compile(
    r"(^|[._])(publish_tf|tf[._]send|enable_odom_tf|broadcast_tf|publish_odom_tf|pub_tf|tf_broadcast)$"
)
"""The parameters that enable and disable a transform of a node."""
_OUTPUT_SWITCH = re.compile(
    r"(^|[./_ ])(publish_(planning_scene|geometry_updates|state_updates|transforms_updates)"
    r"|publish_robot_description(_semantic)?|publish_voxel_map|publish_cost_grid(_pc)?)$"
)
"""The parameters of MoveIt and of navigation that enable and disable a topic."""
_FILTER_FRAME = re.compile(r"(?P<node>(?:.*\.)?)world_frame")
"""The parameter of robot_localization with the frame whose transform the filter publishes.

A file of ROS 1 may contain the parameters of one node without its name."""
_FILTER_FRAMES = ("odom_frame", "base_link_frame")
"""The other frames of a filter of robot_localization."""
_CLAIM = re.compile(r"(?:[^.]+\.)*(?P<controller>[^.]+)\.ros__parameters\.(command|state)_interfaces")
"""The parameters that only controllers have."""
_JOINT_PARAMETER = re.compile(r"(^|[._])(joints?|joint_names?|wheel_names)$")
"""The parameters that name joints of a controller. Other nodes only use the joints."""
_CONTROLLER_TOPIC = re.compile(r"(^|[._])(odom|odometry|command|cmd_vel)_topic$")
"""The parameters that name the topics of a controller. Other nodes only use the topics."""
_CONTROLLER_TYPE = re.compile(r"(?:[^.]*[./])?controller_manager\.ros__parameters\.(?P<controller>[^.]+)\.type")
_CLASS_SEPARATOR = re.compile(r"/|::")
_OWN_TYPE = re.compile(r"(?:.+\.)?(?P<controller>[^.]+)\.ros__parameters\.type")
_CONTROLLER_LIST = re.compile(r"(^|[._])(\w*controllers|controller_names|controller_list)$")
"""The parameters that name controllers which a program loads or commands."""
_METAPACKAGES = ("ros_controllers", "ros2_controllers")
"""Packages without controllers of their own, which others have."""
_ROS1_CLASS = re.compile(r"\w+/\w+")
"""The class of a plugin in the notation of ROS 1."""
_NODE = re.compile(r"(?P<node>.*)\.ros__parameters\.")
_PARAMETERS_KEY = "ros__parameters"
_MOTION = re.compile(r"(?:.*[./])?play_motion2?(?:_node)?\.(?:ros__parameters\.)?motions\.(?P<name>[\w-]+)\.")
"""The beginning of the parameters of a motion of play_motion, whose name clients send."""
_STAMPED = re.compile(r"stamped", re.IGNORECASE)
"""The parameters that choose between messages with and without a header, such as ``use_stamped_vel``."""
_STAMPED_BY_DEFAULT = "use_stamped_vel"
"""The parameter of diff_drive_controller and its relatives, which is true by default."""
_UNSTAMPED_BY_DEFAULT = ("enable_stamped_cmd_vel", "publish_stamped_twist", "stamped")
"""The parameters of Nav2's nodes with velocity commands, teleop_twist_joy and teleop_twist_keyboard.

They are false by default (that of Nav2 in most releases)."""
_CLOCK_PARAMETER = "use_sim_time"
"""The parameter of all nodes that launch files give, too."""
_NUMBER_OR_BOOLEAN = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|true|false", re.IGNORECASE)
_PLUGIN_LIST = re.compile(r"(^|[._])(plugins|plugin_names|plugin_ids)$")
"""The parameters that list plugin names, which behavior trees and goals use."""
_PLUGIN_LISTS = re.compile(r"(^|[._])(plugins|\w+_plugins|plugin_lib_names)$")
"""The parameters of Nav2 that are lists of names."""
_SEPARATOR = re.compile(r"(?<=.)[.\[]")
"""The separators of the names in a path."""
_SUBSTITUTION = re.compile(r"\\\$\\\([\w\\ -]+\\\)")
"""A substitution of launch in a name, after `re.escape`."""
_WILDCARDS = ("**", "*")
"""The wildcards in the names of nodes in parameter files."""


class NameRules:
    """Decide which changes in a parameter file are breaking.

    Args:
        old: the old values by path.
        new: the new values by path.
        readers: the programs that may read the values.
        find_remappings: a function that returns the remappings of the nodes that load either version of the file.
        has_types: whether another type of a value is another type of a parameter.
    """

    def __init__(
        self,
        old: Mapping[str, YamlValue],
        new: Mapping[str, YamlValue],
        readers: KeyReaders,
        find_remappings: FindRemappings,
        *,
        has_types: bool = True,
    ) -> None:
        self._readers = readers
        self._has_types = has_types
        self._new_nodes = {node for name in new if (node := find_node_name(name)) is not None}
        self._added_nodes = self._new_nodes - {find_node_name(name) for name in old}
        self._controllers = {*find_controllers(old), *find_controllers(new)}
        self._controllers |= {match["controller"] for name in old if (match := _CLAIM.fullmatch(name)) is not None}
        self._ros1_controllers = set(_find_ros1_controllers({name: value.text for name, value in new.items()}))
        self._old, self._new = old, new
        self._clock_nodes = {node for name in old if (node := find_node_name(name)) and name.endswith(_CLOCK_PARAMETER)}
        self._clock_nodes -= {find_node_name(name) for name in old if not name.endswith(f".{_CLOCK_PARAMETER}")}
        self._new_controllers = set(find_controllers(new))
        old_types, new_types = (_read_controller_types(values) for values in (old, new))
        self._told_controllers = {
            name
            for name, old_type in old_types.items()
            if name not in self._new_controllers or new_types.get(name, old_type) != old_type
        }
        """The lost controllers and those with another class, which the lines about their types tell."""
        self._new_parts = {part for name in new for part in list_part_paths(name)}
        self._topics = CostmapTopics(old, new, find_remappings, readers.was_replaced)
        self._replaced = find_replaced_classes(old, new)
        self._new_frames = {value.text for name, value in new.items() if offers_frame(name)}

    def find_change_reason(self, parameter: str, old_value: YamlValue, new_value: YamlValue) -> Phrase | None:
        """Return the reason why a changed value is breaking, or None if it is not."""
        old, new = old_value.text, new_value.text
        if _STAMPED.search(parameter) and {old.lower(), new.lower()} == {"true", "false"}:
            return phrase("the message type of a topic changes between one with and one without a header")
        controller = _find_typed_controller(parameter, old, new)
        if controller is not None:
            return phrase(
                "the controller '{name}' has the type '{new}' instead of '{old}', with other topics and interfaces",
                name=controller,
                old=old,
                new=new,
            )
        removed = _find_name_items(old) - _find_name_items(new)
        removed -= {name for name in removed if any(can_evaluate_to(item, name) for item in _find_name_items(new))}
        switch_reason = find_switch_reason(parameter, old, new)
        if switch_reason is not None:
            return switch_reason
        if removed and self._is_lost_filter_frame(parameter, old):
            return phrase("the filter no longer publishes the transform of the frame '{name}'", name=old)
        is_offered = offers_frame(parameter) or self._is_frame_of_odometry(parameter)
        is_offered = is_offered and not self._belongs_to_client(parameter)
        if is_offered:
            removed -= self._new_frames
        if self._belongs_to_controller(parameter):
            patterns = (_FRAME_PARAMETER, _JOINT_PARAMETER, _ODOMETRY_FRAME, _CONTROLLER_TOPIC)
            is_offered = any(pattern.search(parameter) is not None for pattern in patterns)
        if removed and is_offered:
            return names_reason(sorted(removed))
        if removed and _PLUGIN_LIST.search(parameter):
            lost = removed - self._find_plugins(parameter) - self._topics.find_replaced_layers(parameter)
            return _make_plugin_reason(parameter, lost) if lost else None
        if removed and old_value.is_list and _CONTROLLER_LIST.search(parameter):
            return make_controllers_reason(sorted(removed))
        reason = self._topics.find_reason(parameter)
        if reason is not None or not is_parameter(parameter) or self._readers.is_replaced(new):
            return reason
        if is_below_any(parameter, self._replaced):
            return None  # a parameter of another plugin
        if not self._has_types or (new_value.is_list and _PLUGIN_LISTS.search(parameter)):
            return None  # ROS 1 has no types, and the lists of Nav2 accept nothing else
        type_reason, node = find_type_reason(old_value, new_value), find_node_name(parameter)
        if type_reason is None or node is None or has_recorded_type(parameter, self._new):
            return None
        own_name = parameter.partition(".ros__parameters.")[2]
        return None if self._readers.declare_type(node, own_name, new_value) else type_reason

    def find_addition_reason(self, parameter: str, value: str) -> Phrase | None:
        """Return the reason why adding a parameter is breaking, or None if it is not. A new node is not breaking."""
        if _is_nested(parameter) and not any(map(_is_nested, self._old)):
            return phrase("no node gets parameters below a second '{name}'", name=_PARAMETERS_KEY)
        node = find_node_name(parameter)
        if node is not None and node not in self._added_nodes and _changes_header(parameter, value):
            return phrase("the message type of a topic changes between one with and one without a header")
        return None

    def find_removal_reason(self, parameter: str, old: str) -> Phrase | None:
        """Return the reason why removing a parameter is breaking, or None if it is not.

        The type of a controller can also be declared among its own parameters.
        """
        motion = _MOTION.match(parameter)
        if motion is not None and motion["name"] not in self._new_motions:
            return name_reason(motion["name"])
        if _changes_header(parameter, old) and self._has_node(parameter):
            return phrase("the message type of a topic changes between one with and one without a header")
        controller = _CONTROLLER_TYPE.fullmatch(parameter)
        if controller is not None and controller["controller"] not in self._new_controllers:
            return make_controller_reason(controller["controller"])
        node = _NODE.match(parameter)
        if node is not None and not self._has_node(parameter):
            if node["node"].rpartition(".")[2].rpartition("/")[2] in self._told_controllers:
                return None  # the line about its type has the reason
            if node["node"] in self._clock_nodes or self._readers.have_renamed_node(node["node"], self._added_nodes):
                return None
            group = list_part_paths(parameter)[len(list_part_paths(node[0].rstrip("."))) :][0]
            if self._readers.is_package_without_node(node["node"]):
                return None
            if self._readers.have_stopped_reading(group.rpartition(".")[2]):
                return None
            return _make_lost_parameters_reason(node["node"])
        lost = _find_name_items(old) - self._find_plugins(parameter) if _PLUGIN_LIST.search(parameter) else set[str]()
        if lost:
            return _make_plugin_reason(parameter, lost)
        topic_reason = self._topics.find_reason(parameter)
        if topic_reason is not None or self._topics.is_dropped_source(parameter):
            return topic_reason
        root = "" if node is None else node[0].rstrip(".")
        if node is not None and controller is None and self._is_in_lost_group(parameter, root):
            return _make_lost_parameters_reason(node["node"])
        if node is not None and controller is None and self._is_removed_like_group(parameter, root):
            return _make_lost_parameters_reason(node["node"])
        if any(map(_NODE.match, self._old)):
            return None  # ROS 2 refuses the whole file because of a part without `ros__parameters`
        ros1_controller = next(_find_ros1_controllers({parameter: old}), None)
        return None if ros1_controller is None else make_controller_reason(_separate_by_slashes(ros1_controller))

    def _find_plugins(self, parameter: str) -> set[str]:
        """Return the plugins that other lists of the node of a parameter newly have."""
        node = find_node_name(parameter)
        names = [name for name in self._new if _PLUGIN_LIST.search(name) and find_node_name(name) == node]
        return {
            item
            for name in names
            for item in _find_name_items(self._new[name].text)
            if name not in self._old or item not in _find_name_items(self._old[name].text)
        }

    def _is_in_lost_group(self, parameter: str, root: str) -> bool:
        """Return whether the group of a parameter was removed, and a program may still read it.

        The node uses its default for a single removed value.
        """
        group = list_part_paths(parameter)[-2]
        is_lost = root in self._new_parts and group not in self._new_parts
        if is_below_any(parameter, self._replaced) or is_unread_plugin(parameter, root, self._old, self._new):
            return False
        return is_lost and not self._readers.have_stopped_reading(group.rpartition(".")[2])

    def _is_removed_like_group(self, parameter: str, root: str) -> bool:
        """Return whether a file for any node, which gives all parameters of one, also loses a group of them.

        The node may have no defaults, as for the parameters of the group.
        """
        if root.partition(".")[0].rpartition("/")[2] not in _WILDCARDS or parameter in self._new:
            return False
        removed = (name for name in self._old if name.startswith(f"{root}.") and name not in self._new)
        own_name = parameter.rpartition(".")[2]
        is_read = not self._readers.have_stopped_reading(own_name) and not is_below_any(parameter, self._replaced)
        return is_read and any(self._is_in_lost_group(name, root) for name in removed)

    @cached_property
    def _new_motions(self) -> frozenset[str]:
        """The names of the motions in the new file."""
        return frozenset(match["name"] for name in self._new if (match := _MOTION.match(name)) is not None)

    def _is_lost_filter_frame(self, parameter: str, frame: str) -> bool:
        """Return whether no filter of robot_localization in the file publishes the transform of a frame any more."""
        match = _FILTER_FRAME.fullmatch(parameter)
        if match is None or any(f"{match['node']}{name}" not in self._new for name in _FILTER_FRAMES):
            return False
        switch = self._new.get(f"{match['node']}publish_tf")
        filters = [other["node"] for name in self._new if (other := _FILTER_FRAME.fullmatch(name)) is not None]
        frames = (self._new.get(f"{node}{name}") for node in filters for name in ("world_frame", *_FILTER_FRAMES))
        is_used = any(value is not None and value.text == frame for value in frames)
        return not is_used and (switch is None or switch.text.lower() != "false")

    def _belongs_to_controller(self, parameter: str) -> bool:
        """Return whether a parameter belongs to a controller."""
        node = _NODE.match(parameter)
        name = node["node"].rpartition(".")[2] if node else parameter.partition(".")[0]
        is_of_ros1 = any(parameter.startswith(f"{controller}.") for controller in self._ros1_controllers)
        return name in self._controllers or name.endswith("controller") or is_of_ros1

    def _is_frame_of_odometry(self, parameter: str) -> bool:
        """Return whether a parameter names the parent frame of the odometry that its node publishes."""
        match = _ODOM_FRAME.fullmatch(parameter)
        return match is not None and f"{match['node']}odom_child_frame" in self._new

    def _belongs_to_client(self, parameter: str) -> bool:
        """Return whether a parameter belongs to a client, by the name of its node or file. Clients use frames."""
        return any(
            _CLIENT.search(name) for name in (find_node_name(parameter) or "", PurePosixPath(self._readers.path).stem)
        )

    def _has_node(self, parameter: str) -> bool:
        """Return whether the new version has other parameters of the same node."""
        node = find_node_name(parameter)
        return node is not None and any(matches_node(other, node) for other in self._new_nodes)


def _changes_header(parameter: str, value: str) -> bool:
    """Return whether a value is the opposite of a default that chooses messages with or without a header."""
    name = parameter.rpartition(".")[2]
    return (name == _STAMPED_BY_DEFAULT and value.lower() == "false") or (
        name in _UNSTAMPED_BY_DEFAULT and value.lower() == "true"
    )


def offers_frame(parameter: str) -> bool:
    """Return whether a parameter names a frame that a node publishes for other programs."""
    if _ODOMETRY_FRAME.search(parameter) is not None:
        return True
    return _FRAME_PARAMETER.search(parameter) is not None and not _USED_FRAME_PARAMETER.search(parameter)


def find_switch_reason(parameter: str, old: str, new: str) -> Phrase | None:
    """Return the reason why switching off a parameter is breaking, or None if it switches off no transform or topic."""
    if (old.lower(), new.lower()) != ("true", "false"):
        return None
    if switches_transform(parameter):
        return phrase("the node no longer publishes its transform")
    match = _OUTPUT_SWITCH.search(parameter)
    name = "" if match is None else match[0].lstrip("./_ ")
    return phrase("the data that '{name}' enables is no longer published", name=name) if name else None


def find_lost_output_reason(parameter: str, old: str, others: Iterable[str]) -> Phrase | None:
    """Return the reason why it is breaking that a node no longer gets a parameter which enabled a topic, or None.

    These parameters are false by default.

    Args:
        parameter: the lost parameter.
        old: its value.
        others: the parameters that the node gets, maybe this one in another section.
    """
    match = _OUTPUT_SWITCH.search(parameter)
    is_kept = match is None or any(other.endswith(match[0].lstrip("./_ ")) for other in others)
    return None if is_kept else find_switch_reason(parameter, old, "false")


def switches_transform(parameter: str) -> bool:
    """Return whether a parameter enables and disables a transform of its node."""
    return _TRANSFORM_SWITCH.search(parameter) is not None


def is_parameter(name: str) -> bool:
    """Return whether a path is the path of a node parameter."""
    return _NODE.match(name) is not None


def find_node_name(name: str) -> str | None:
    """Return the name of the node in the path of a parameter, or None for other paths."""
    match = _NODE.match(name)
    return None if match is None else match["node"]


def has_different_type(old: YamlValue, new: YamlValue) -> bool:
    """Return whether two values differ in type. An empty value fits all types."""
    if old.is_list != new.is_list and None not in (old.type, new.type):
        return True
    return None not in (old.type, new.type) and old.type is not new.type


def find_type_reason(old: YamlValue, new: YamlValue) -> Phrase | None:
    """Return the reason why a different type is breaking; None for the same type, or if no parameter had the old one.

    No parameter of ROS 2 is a list of several types.
    """
    if not has_different_type(old, new) or old.type is YamlType.MIXED:
        return None
    return phrase(
        "a node that declares the parameter as {old} does not accept {new}", old=old.type_name, new=new.type_name
    )


def make_controller_reason(name: str) -> Phrase:
    """Return the reason why removing a controller is breaking."""
    return phrase("programs that load or command the controller '{name}' do not find it", name=name)


def make_controllers_reason(names: Sequence[str]) -> Phrase:
    """Return the reason why removing some controllers is breaking."""
    if len(names) == 1:
        return make_controller_reason(names[0])
    return phrase("programs that load or command the controllers {names} do not find them", names=quoted_names(names))


def _find_ros1_controllers(values: Mapping[str, str]) -> Iterator[str]:
    """Yield the paths of ROS 1 controllers: parts with a type outside of node parameters."""
    for name, text in values.items():
        part, _, key = name.rpartition(".")
        is_controller = "controller" in f"{part} {text}".lower() and "[" not in part
        if key == "type" and part and is_controller and _ROS1_CLASS.fullmatch(text) and not _NODE.match(name):
            yield part


def _find_typed_controller(parameter: str, old: str, new: str) -> str | None:
    """Return the controller whose type a parameter sets; None for other parameters and for types that never exist."""
    if old.partition("/")[0] in _METAPACKAGES:
        return None
    match = _CONTROLLER_TYPE.fullmatch(parameter) or _OWN_TYPE.fullmatch(parameter)
    if match is not None:
        is_class = match.re is _CONTROLLER_TYPE or (_ROS1_CLASS.fullmatch(old) and _ROS1_CLASS.fullmatch(new))
        return match["controller"] if is_class else None
    part = next(_find_ros1_controllers({parameter: old}), None)
    return _separate_by_slashes(part) if part is not None and _ROS1_CLASS.fullmatch(new) else None


def _separate_by_slashes(part: str) -> str:
    return part.replace(".", "/")


def _make_plugin_reason(parameter: str, names: Collection[str]) -> Phrase:
    """Return the reason why a list without plugins is breaking. Programs name those of servers, but no layers."""
    texts = quoted_names(sorted(names))
    if "costmap" in (find_node_name(parameter) or ""):
        return counted(
            "the costmap lacks the layer {names}", "the costmap lacks the layers {names}", len(names), names=texts
        )
    return counted(
        "programs that name the plugin {names} do not find it",
        "programs that name the plugins {names} do not find them",
        len(names),
        names=texts,
    )


def _read_controller_types(values: Mapping[str, YamlValue]) -> dict[str, str]:
    """Return the classes of the controllers of a file, without their packages, by the name of the controller."""
    return {name: _CLASS_SEPARATOR.split(text)[-1] for name, text in read_controller_classes(values).items()}


def read_controller_classes(values: Mapping[str, YamlValue]) -> dict[str, str]:
    """Return the classes that a controller manager loads, as its file writes them, by the name of the controller."""
    matches = ((_CONTROLLER_TYPE.fullmatch(name), value) for name, value in values.items())
    return {match["controller"]: value.text for match, value in matches if match is not None}


def find_controllers(values: Mapping[str, YamlValue]) -> Iterator[str]:
    """Yield the names of the controllers whose types a file sets."""
    for name in values:
        match = _CONTROLLER_TYPE.fullmatch(name) or _OWN_TYPE.fullmatch(name)
        if match is not None:
            yield match["controller"]


def find_all_controllers(values: Mapping[str, YamlValue]) -> Iterator[str]:
    """Yield the names of the ROS 2 and ROS 1 controllers whose types a file sets."""
    yield from find_controllers(values)
    yield from map(_separate_by_slashes, _find_ros1_controllers({name: value.text for name, value in values.items()}))


def _find_name_items(text: str) -> set[str]:
    """Return the items of a list or the value itself, without numbers and booleans."""
    return {item for item in list_items(text) if item not in ("", EMPTY) and not _NUMBER_OR_BOOLEAN.fullmatch(item)}


def _is_nested(parameter: str) -> bool:
    """Return whether a parameter is inside of two nested sections with parameters."""
    return parameter.split(".").count(_PARAMETERS_KEY) > 1


def _make_lost_parameters_reason(node: str) -> Phrase:
    """Return the reason why removing parameters is breaking."""
    if node.rpartition("/")[2] in _WILDCARDS:
        return phrase("the nodes that load the file start without these parameters")
    return phrase("the node '{name}' starts without these parameters", name=node)


class RenamingRules:
    """Decide which renamed and moved parts of a parameter file are breaking.

    Args:
        values: the old values by path.
    """

    def __init__(self, values: Mapping[str, YamlValue]) -> None:
        self._ros1_controllers = list(_find_ros1_controllers({name: value.text for name, value in values.items()}))
        self._controllers = set(find_controllers(values))
        self._node_parameters = index_parts(name for name in values if _NODE.match(name))

    def find_reason(self, part: str, new_part: str) -> Phrase | None:
        """Return the reason why renaming or moving a part is breaking; None if it is not.

        Args:
            part: the old path: a node, parameters of a node, or a controller of ROS 1.
            new_part: the new path.
        """
        motions = _MOTION.fullmatch(f"{part}."), _MOTION.fullmatch(f"{new_part}.")
        if motions[0] is not None and (motions[1] is None or motions[1]["name"] != motions[0]["name"]):
            return name_reason(motions[0]["name"])
        names = [name for name in self._ros1_controllers if name == part or name.startswith(f"{part}.")]
        names = [name for name in names if not can_evaluate_to(f"{new_part}{name.removeprefix(part)}", name)]
        if names:
            return make_controllers_reason(list(map(_separate_by_slashes, names)))
        node, new_node = find_node_name(f"{part}."), find_node_name(f"{new_part}.")
        if node is None or list_part_paths(part)[:-1] == list_part_paths(new_part)[:-1]:
            return self._find_node_reason(part, new_part)
        if new_node is not None and matches_node(new_node, node):
            return phrase("values that are set under the old names no longer have an effect")
        return _make_lost_parameters_reason(node)

    def _find_node_reason(self, part: str, new_part: str) -> Phrase | None:
        """Return the reason why renaming or moving node parameters is breaking.

        Returns None if the new name also matches the old node, or if the old name matches any node.
        """
        parameter = self._node_parameters.get(part, "")
        match = _NODE.match(parameter) if parameter.startswith(f"{part}.") else None
        if match is None or len(match[0]) < len(part) or match["node"] in self._controllers:
            return None
        new_node = find_node_name(f"{new_part}{parameter.removeprefix(part)}")
        is_for_any_node = any(word in match["node"] for word in _WILDCARDS)
        if new_node is None or matches_node(new_node, match["node"]) or is_for_any_node:
            return None
        return phrase("the node '{name}' starts without these parameters", name=match["node"])


def index_parts(names: Iterable[str]) -> dict[str, str]:
    """Return the first path in or below each part of some paths."""
    first_paths: dict[str, str] = {}
    for name in names:
        for part in list_part_paths(name):
            first_paths.setdefault(part, name)
    return first_paths


def matches_node(name: str, node: str) -> bool:
    """Return whether a name in a parameter file, such as ``/**/amcl``, matches a node.

    The rules are those of rcl.
    """
    words = [word for word in re.split(r"[./]", name) if word]
    pattern = "".join(
        r"(?:/[^/]+)*" if word == "**" else r"/[^/]+" if word == "*" else f"/{re.escape(word)}" for word in words
    )
    return re.fullmatch(pattern, "/" + "/".join(word for word in re.split(r"[./]", node) if word)) is not None


def can_evaluate_to(text: str, name: str) -> bool:
    """Return whether a text such as ``$(arg arm)_joint1`` can evaluate to a name."""
    pattern, count = _SUBSTITUTION.subn(".*", re.escape(text))
    return count > 0 and re.fullmatch(pattern, name) is not None


def list_part_paths(name: str) -> list[str]:
    """Return the paths of the mappings and items around a value, and its own path.

    The outermost comes first.
    """
    return [*(name[: match.start()] for match in _SEPARATOR.finditer(name)), name]
