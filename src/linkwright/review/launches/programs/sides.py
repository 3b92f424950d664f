"""Decide whether a node offers a topic or service, or only uses it."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from enum import Enum
from pathlib import Path

from linkwright.nodes.recorded_names import find_recorded_roles
from linkwright.review.caching import cached_in_review
from linkwright.review.launches.programs.default_names import find_package_folders
from linkwright.review.launches.programs.modules import find_program_modules
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind
from linkwright.review.sources.reading import read_source_names

_SUBSCRIBING_PROGRAM = re.compile(
    r"slam_toolbox/|nav2_\w+/|robot_localization/|cartographer_ros/|rtabmap_\w+/|octomap_server2?/|"
    r"move_base/|amcl/|gmapping/|robot_state_publisher/|depthimage_to_laserscan/|pointcloud_to_laserscan/|laser_filters/|twist_mux/|"
    r"\w+_moveit_config/"
)
_INPUT_TOPIC = re.compile(
    r"(.*/)?(scan|scan_in|cloud|cloud_in|points|odom|odometry/\w+|imu(/\w+)?|gps/fix|joint_states|depth|"
    r"depth_camera_info|(rgb|depth|image)(/\w+)*|camera_info)"
)
"""The topics to which these programs subscribe. They publish their other topics."""
_INPUTS = {
    "controller_manager/ros2_control_node": {"robot_description"},
    "move_base/move_base": {"map", "goal", "move_base_simple/goal"},
    "amcl/amcl": {"map", "initialpose"},
    "map_server/map_saver": {"map"},
}
"""More topics to which well-known programs subscribe, without those of `find_recorded_roles`."""
_OUTPUTS = {
    "move_base/move_base": {"cmd_vel"},
    "amcl/amcl": {"amcl_pose", "particlecloud"},
    "map_server/map_server": {"map"},
    "gmapping/slam_gmapping": {"map"},
    "robot_localization/ekf_localization_node": {"odometry/filtered", "set_pose"},
    "robot_localization/ukf_localization_node": {"odometry/filtered", "set_pose"},
    "depthimage_to_laserscan/depthimage_to_laserscan": {"scan"},
}
"""Topics and services that well-known programs offer, without those of `find_recorded_roles`."""
_ALL_OUTPUTS: dict[str, set[str]] = {
    "move_base/move_base": {"cmd_vel", "current_goal", "goal", "make_plan", "clear_costmaps", "clear_unknown_space"},
    "joint_state_publisher/joint_state_publisher": {"joint_states"},
    "joint_state_publisher_gui/joint_state_publisher_gui": {"joint_states"},
    "robot_state_publisher/robot_state_publisher": {"robot_description"},
    "robot_state_publisher/state_publisher": set(),
    "tf2_ros/static_transform_publisher": set(),
    "tf/static_transform_publisher": set(),
    "controller_manager/spawner": set(),
    "controller_manager/spawner.py": set(),
    "depthimage_to_laserscan/depthimage_to_laserscan": {"scan"},
    "pointcloud_to_laserscan/pointcloud_to_laserscan_node": {"scan"},
    "joy/joy_node": {"joy"},
}
"""The topics, services and actions that well-known programs offer, except names with several parts.

The programs use all other names of one word, or lack them. Those without an entry in their set offer nothing.
"""
_NAMED_INPUT = re.compile(r"(.*[/_])?(in|input)([/_].*)?")
_NAMED_OUTPUT = re.compile(r"(.*[/_])?(out|output)([/_].*)?")
_OFFERING_KINDS = frozenset({NameKind.PUBLISHER, NameKind.SERVICE, NameKind.ACTION})
_USING_KINDS = frozenset({NameKind.SUBSCRIPTION, NameKind.CLIENT, NameKind.ACTION_CLIENT})
_USING_ROLES = frozenset({"subscription", "client", "action client"})
"""The roles in which programs with recorded topics offer nothing."""
_MAX_SOURCES = 80
_LIBRARY_NAMES = frozenset({"tf", "tf_static", "diagnostics", "rosout", "clock", "parameter_events"})
"""The names that libraries of ROS publish for a program, so that its sources need not have them."""
_LITERAL_NAME = re.compile(r"[~/\w]+")
_CONTROLLER_MANAGER = "controller_manager/ros2_control_node"
_KEY, _QUOTED_WORD = re.compile(r"^\s*(\w+):", re.MULTILINE), re.compile(r"[\"'](\w+)[\"']")
_KEY_PATTERNS = {".yaml": _KEY, ".yml": _KEY, ".py": _QUOTED_WORD, ".xml": _QUOTED_WORD, ".launch": _QUOTED_WORD}
"""The names of controllers in parameter files and, for spawners, in launch files, by suffix."""
_LOOKED_UP_FRAMES = dict.fromkeys(
    ("rtabmap_ros/rtabmap", "rtabmap_slam/rtabmap", "rtabmap_ros/rtabmapviz", "rtabmap_viz/rtabmap_viz"),
    frozenset({"frame_id"}),
)
"""The parameters of well-known programs with the frame of the robot, whose pose they look up (``CoreWrapper.cpp``)."""


class Side(Enum):
    """Whether a node offers a name to others."""

    OFFERS = "offers"
    USES = "uses"
    LACKS = "lacks"
    UNKNOWN = "unknown"


def find_side(program: str, name: str, root: Path | None) -> Side:
    """Return whether a node offers a topic or service, uses it, or lacks it.

    The sources of the node or the name decide. Those of a Python program are its script and the modules that it
    imports; those of other programs are all sources of the package.

    Args:
        program: the package and the executable of the node.
        name: the name that the node itself gives to the topic or service.
        root: the folder of the repository, which may have the sources; None if it is unknown.
    """
    relative_name = name.lstrip("~/")
    is_parameter = relative_name == "robot_description"  # in ROS 1
    roles = frozenset() if is_parameter else find_recorded_roles(program, relative_name)
    if roles:
        return Side.USES if roles <= _USING_ROLES else Side.OFFERS
    if relative_name in _OUTPUTS.get(program, ()):
        return Side.OFFERS
    if relative_name in _INPUTS.get(program, ()):
        return Side.USES
    if _SUBSCRIBING_PROGRAM.match(program) and _INPUT_TOPIC.fullmatch(relative_name):
        return Side.USES
    outputs = _ALL_OUTPUTS.get(program)
    is_one_word = re.fullmatch(r"/?\w+", name) is not None
    if outputs is not None and (is_one_word or not outputs) and relative_name not in outputs | _LIBRARY_NAMES:
        return Side.USES
    modules = () if root is None else _find_modules(root, program)
    package = program.partition("/")[0]
    kinds_by_name = _collect_kinds(modules) if modules or root is None else _read_package_kinds(root, package)
    kinds = kinds_by_name.get(_find_own_name(name, kinds_by_name), set())
    if modules and not kinds and _lacks_name(name, modules):
        return Side.LACKS
    if kinds and kinds <= _USING_KINDS:
        return Side.USES
    if kinds & _OFFERING_KINDS or _NAMED_OUTPUT.fullmatch(relative_name):
        return Side.OFFERS
    return Side.USES if _NAMED_INPUT.fullmatch(relative_name) else Side.UNKNOWN


def is_name_of_known_node(name: str) -> bool:
    """Return whether a well-known node offers a full name, such as ``/robot/move_base/make_plan``."""
    node, own_name = name.split("/")[-2:] if "/" in name else ("", name)
    return any(
        program.rpartition("/")[2] == node and own_name in outputs
        for tables in (_OUTPUTS, _ALL_OUTPUTS)
        for program, outputs in tables.items()
    )


def only_looks_up(program: str, parameter: str, root: Path | None) -> bool:
    """Return whether a node uses the value of a parameter only as the name of a frame to look up.

    The sources in the repository show this, or the node is well known.

    Args:
        program: the package and the executable of the node.
        parameter: the name of the parameter.
        root: the folder of the repository, which may have the sources; None if it is unknown.
    """
    if parameter in _LOOKED_UP_FRAMES.get(program, ()):
        return True
    files = () if root is None else _list_sources(root, program.partition("/")[0])
    names = (item for file in files for item in read_source_names(file).default_names)
    return {item.kind for item in names if item.parameter.lstrip("~/.") == parameter} == {NameKind.FRAME_LOOKUP}


def find_old_side(program: str, name: str, old_root: Path | None, new_root: Path | None) -> Side:
    """Return the side of a node before a change: others only use a name that the old sources offer.

    The new sources decide if the old repository does not have the package.

    Args:
        program: the package and the executable of the node.
        name: the name that the node itself gives to the topic or service.
        old_root: the folder of the old repository; None if it is unknown.
        new_root: the folder of the new repository; None if it is unknown.
    """
    has_package = old_root is not None and program.partition("/")[0] in find_package_folders(old_root)
    return find_side(program, name, old_root if has_package else new_root)


def is_new_name(program: str, name: str, old_root: Path | None, new_root: Path | None) -> bool:
    """Return whether only the new sources of a package have a topic or service.

    This also holds for a topic of a controller that only the new parameter files have. No other program can use such a
    name yet.

    Args:
        program: the package and the executable of the node.
        name: the name that the node itself gives to the topic or service.
        old_root: the folder of the old repository; None if it is unknown.
        new_root: the folder of the new repository; None if it is unknown.
    """
    package, relative_name = program.partition("/")[0], name.lstrip("~/")
    if old_root is None or new_root is None:
        return False
    controller, separator, _ = relative_name.partition("/")
    if program == _CONTROLLER_MANAGER and separator and controller in _list_parameter_keys(new_root):
        return controller not in _list_parameter_keys(old_root)
    if package not in find_package_folders(old_root):
        return False
    new_kinds = _read_package_kinds(new_root, package)
    own_name = _find_own_name(name, new_kinds)
    return own_name in new_kinds and own_name not in _read_package_kinds(old_root, package)


def _find_own_name(name: str, known: Collection[str]) -> str:
    """Return the name by which the sources of a node know a topic or service of a remapping.

    An absolute name may begin with the namespace of the node.
    """
    words = name.lstrip("~/").split("/")
    count = len(words) if name.startswith("/") else 1
    names = ["/".join(words[index:]) for index in range(count)]
    return next((own_name for own_name in names if own_name in known), names[0])


@cached_in_review(maxsize=4)
def _list_parameter_keys(root: Path) -> frozenset[str]:
    """Return the keys in the YAML files of a repository, and the quoted words in its launch files and programs."""
    keys: set[str] = set()
    for file in root.rglob("*"):
        pattern = _KEY_PATTERNS.get(file.suffix)
        if pattern is not None and file.is_file():
            keys |= set(pattern.findall(file.read_text("utf-8", "replace")))
    return frozenset(keys)


def _find_modules(root: Path, program: str) -> tuple[Path, ...]:
    """Return the modules of a Python program; empty if none of them makes a node, topic or service."""
    modules = find_program_modules(root, program)
    is_node = any(read_source_names(module).makes_node for module in modules) or bool(_collect_kinds(modules))
    return modules if is_node else ()


def _lacks_name(name: str, modules: Iterable[Path]) -> bool:
    """Return whether the sources of a program, which do not name a topic or service, certainly do not have it.

    They may have it if they compute a name, or if a library publishes it.
    """
    if _LITERAL_NAME.fullmatch(name) is None or name.rpartition("/")[2].lstrip("~") in _LIBRARY_NAMES:
        return False
    return not any(
        item.kind in _OFFERING_KINDS and item.name not in names.wrapper_arguments
        for names in map(read_source_names, modules)
        for item in names.expressions
    )


@cached_in_review(maxsize=64)
def _read_package_kinds(root: Path, package: str) -> dict[str, set[NameKind]]:
    """Return the kinds of topics, services and actions in a package's sources, by name."""
    return _collect_kinds(_list_sources(root, package))


@cached_in_review(maxsize=64)
def _list_sources(root: Path, package: str) -> tuple[Path, ...]:
    """Return the sources of a package, at most as many as are read."""
    folder = find_package_folders(root).get(package)
    suffixes = (*CPP_SUFFIXES, PYTHON_SUFFIX)
    files = () if folder is None else sorted(folder.rglob("*"))
    return tuple(file for file in files if file.suffix in suffixes and file.is_file())[:_MAX_SOURCES]


def _collect_kinds(files: Iterable[Path]) -> dict[str, set[NameKind]]:
    """Return the kinds of topics, services and actions in sources, by name."""
    kinds: dict[str, set[NameKind]] = {}
    for file in files:
        for item in read_source_names(file).names:
            if item.kind in _OFFERING_KINDS | _USING_KINDS:
                kinds.setdefault(item.name.strip("\"'").lstrip("~/"), set()).add(item.kind)
    return kinds
