"""Find plugins that a parameter file newly loads, and that do not exist or whose package no ``package.xml`` names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.files.parameters.yaml_values import YamlValue
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.required_packages import is_undeclared_and_new
from linkwright.review.versions import Versions

_CLASS = re.compile(r"(?P<package>[a-z][a-z0-9]*(?:_[a-z0-9]+)+)(?:/|::)(?:\w+::)*[A-Z]\w*")
"""The class of a plugin, such as ``nav2_smac_planner/SmacPlanner2D``.

The namespace of a class without an underscore is often not the package.
"""
_CLASS_PARAMETER = re.compile(
    r"(^|[._])(plugin|type|kinematics_solver|planning_plugin|base_\w+_planner|\w+_controller_manager)$"
)
_PLUGIN = re.compile(r"(^|[._])plugin$")
_CONTROLLER_TYPE = re.compile(r"(?:^|\.)(?P<name>\w+)\.type$")
_OTHER_NAMES = frozenset(
    {
        *("cached_ik_kinematics_plugin", "chomp_interface", "default_planner_request_adapters", "fake_components"),
        *("kdl_kinematics_plugin", "lma_kinematics_plugin", "mock_components", "occupancy_map_monitor"),
        *("ompl_interface", "solver_plugins", "srv_kinematics_plugin", "stomp_moveit"),
    }
)
"""The first names of classes that belong to packages with other names."""


_NAMES_WITH_COLONS = frozenset(
    {
        *("dwb_core", "dwb_plugins", "nav2_controller", "nav2_costmap_2d", "nav2_graceful_controller"),
        *("nav2_mppi_controller", "nav2_regulated_pure_pursuit_controller", "nav2_rotation_shim_controller"),
        *("nav2_smoother", "nav2_waypoint_follower"),
    }
)
"""Packages whose plugins pluginlib knows by the C++ name, such as ``nav2_costmap_2d::VoxelLayer``, and by no other."""
_MOVEIT_PLUGINS = {
    "controller_manager": ("moveit_simple_controller_manager/MoveItSimpleControllerManager",),
    "kdl_kinematics_plugin": ("kdl_kinematics_plugin/KDLKinematicsPlugin",),
    "lma_kinematics_plugin": ("lma_kinematics_plugin/LMAKinematicsPlugin",),
    "moveit_fake_controller_manager": ("moveit_fake_controller_manager/MoveItFakeControllerManager",),
    "moveit_ros_control_interface": (
        "moveit_ros_control_interface/Ros2ControlManager",
        "moveit_ros_control_interface/Ros2ControlMultiManager",
    ),
    "moveit_simple_controller_manager": ("moveit_simple_controller_manager/MoveItSimpleControllerManager",),
    "srv_kinematics_plugin": ("srv_kinematics_plugin/SrvKinematicsPlugin",),
}
"""The plugins for MoveIt of its packages, and of those that are mistaken for them."""
_SLASH, _COLONS = "/", "::"


@dataclass(frozen=True)
class PluginPackages:
    """The packages of the plugins that a parameter file loads.

    Attributes:
        versions: the repository before and after the change.
        path: the path of the parameter file in the new version.
    """

    versions: Versions
    path: str

    def find_change_reason(self, parameter: str, old: YamlValue, new: YamlValue) -> Phrase | None:
        """Return the reason why another class of a plugin is breaking, or None if it is not.

        A class with the same name may only have moved into a package that replaces the old one.
        """
        reason = find_unknown_class_reason(parameter, new.text)
        if reason is not None:
            return reason if find_unknown_class_reason(parameter, old.text) is None else None
        package = find_plugin_package(parameter, new.text)
        if package is None or package in _split(old.text) or _split(old.text)[-1] == _split(new.text)[-1]:
            return None
        return self.explain_missing_package(package)

    def find_addition_reason(self, values: Mapping[str, YamlValue]) -> Phrase | None:
        """Return the reason why added values are breaking, or None if they are not.

        An added controller, which has a type, counts if a launch file names it, because others may not be started.
        """
        plugins = {name: value for name, value in values.items() if _PLUGIN.search(name) or self._is_started(name)}
        for name, value in plugins.items():
            reason = find_unknown_class_reason(name, value.text)
            if reason is not None:
                return reason
        packages = dict.fromkeys(find_plugin_package(name, value.text) for name, value in plugins.items())
        reasons = (self.explain_missing_package(package) for package in packages if package is not None)
        return next((reason for reason in reasons if reason is not None), None)

    def _is_started(self, parameter: str) -> bool:
        """Return whether a parameter is the type of a controller that a launch file names."""
        controller = _CONTROLLER_TYPE.search(parameter)
        if controller is None:
            return False
        name = re.compile(rf"(?<![\w/]){re.escape(controller['name'])}(?![\w/])")
        version = self.versions.new
        return any(name.search(version.text(path)) for path in find_launch_files(version))

    def explain_missing_package(self, package: str) -> Phrase | None:
        """Return the reason why a plugin of a package is not loaded, or None if the package may exist."""
        if not is_undeclared_and_new(self.versions, self.path, package):
            return None
        return phrase("package.xml does not name '{name}', without which the plugin is not loaded", name=package)


def find_unknown_class_reason(parameter: str, text: str) -> Phrase | None:
    """Return the reason why pluginlib does not find a plugin of a known package, or None if it may exist."""
    if not _CLASS_PARAMETER.search(parameter):
        return None
    package, slash, name = text.partition(_SLASH)
    known: tuple[str, ...] = ()
    if slash and package in _NAMES_WITH_COLONS:
        known = (f"{package}{_COLONS}{name}",)
    elif slash and text not in _MOVEIT_PLUGINS.get(package, (text,)):
        known = _MOVEIT_PLUGINS[package]
    if not known:
        return None
    return phrase("there is no plugin '{name}', only {others}", name=text, others=quoted_names(known))


def find_plugin_package(parameter: str, text: str) -> str | None:
    """Return the package of the plugin that the value of a parameter names; None for other values."""
    match = _CLASS.fullmatch(text) if _CLASS_PARAMETER.search(parameter) else None
    return None if match is None or match["package"] in _OTHER_NAMES else match["package"]


def _split(text: str) -> list[str]:
    return re.split(r"/|::", text)
