"""The hardware plugins of ros2_control for descriptions, with their parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from linkwright.language.format import Document, Target
from linkwright.language.plugin_classes import PluginClass, plugin_classes
from linkwright.lint.targets import find_files_and_packages
from linkwright.loading.extensions import extensions
from linkwright.xmltree.tokens import Kind, tokens

BASE = "hardware_interface"
"""The package of the base classes of hardware plugins."""
_MOCK_PARAMETERS = {
    "calculate_dynamics": "whether velocity and acceleration commands move the position",
    "disable_commands": "whether commands are ignored",
    "mock_sensor_commands": "whether the states of sensors have command interfaces, too",
    "mock_gpio_commands": "whether the states of GPIOs have command interfaces, too",
    "position_state_following_offset": "a difference between the position and its command",
    "custom_interface_with_following_offset": "the interface with the position and its offset, instead of position",
}
_SIMULATION_PARAMETERS = {"robot_namespace": "the namespace of the controller manager"}
_KNOWN_PLUGINS: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "mock_components/GenericSystem": ("follows all commands at once, without hardware", _MOCK_PARAMETERS),
    "gz_ros2_control/GazeboSimSystem": ("the joints and sensors of a model in gz", _SIMULATION_PARAMETERS),
    "gazebo_ros2_control/GazeboSystem": ("the joints and sensors of a model in Gazebo classic", _SIMULATION_PARAMETERS),
    "ign_ros2_control/IgnitionSystem": ("the joints and sensors of a model in Ignition Gazebo", _SIMULATION_PARAMETERS),
    "topic_based_ros2_control/TopicBasedSystem": (
        "commands and states in topics with joint states",
        {
            "joint_commands_topic": "the topic of the commands",
            "joint_states_topic": "the topic of the states",
            "trigger_joint_command_threshold": "the difference from which a command is published",
            "sum_wrapped_joint_states": "whether positions count full turns",
        },
    ),
    "fake_components/GenericSystem": ("the name of mock_components/GenericSystem in ROS 2 Foxy", _MOCK_PARAMETERS),
}
_PARAMETER_ACCESS = re.compile(
    r"""\bhardware_parameters\s{0,9}(?:\.\s{0,9}(?:at|find|count)\s{0,9}\(|\[)\s{0,99}["']([\w.]{1,80})["']"""
)
_SOURCE_SUFFIXES = (".cpp", ".hpp", ".cc", ".cxx", ".h")
_MAX_TEXT_LENGTH = 300_000
_MAX_FILES = 300


@dataclass(frozen=True, slots=True)
class HardwareParameter:
    """A parameter of a hardware plugin.

    Attributes:
        name: the name in the element ``<param>``.
        meaning: the purpose, or empty if it is unknown.
        target: the location in the sources that reads it, or None if it is unknown.
    """

    name: str
    meaning: str = ""
    target: Target | None = None


def hardware_plugins(document: Document) -> dict[str, str]:
    """Return the purposes of hardware plugins by type, the plugins that packages export first."""
    purposes = {plugin.name: plugin.description for plugin in plugin_classes(document, BASE)}
    purposes |= {name: purpose for name, (purpose, _) in _KNOWN_PLUGINS.items() if name not in purposes}
    return purposes | {name: "" for name in sorted(extensions("linkwright.hardware")) if name not in purposes}


def find_hardware_class(document: Document, name: str) -> PluginClass | None:
    """Return the class of a hardware plugin that a package of the workspace exports, or None."""
    plugins = plugin_classes(document, BASE)
    return next((plugin for plugin in plugins if name in (plugin.name, plugin.type)), None)


def hardware_parameters(document: Document, name: str, excluded_offset: int = -1) -> dict[str, HardwareParameter]:
    """Return the parameters of a hardware plugin, by name.

    They are the known parameters, the parameters that the plugin's sources read, and those that the text sets.

    Args:
        document: a description.
        name: the type of the plugin, as ``package/Class``.
        excluded_offset: the offset of a parameter in the text that is ignored.
    """
    known_parameters = _KNOWN_PLUGINS.get(name, ("", {}))[1]
    parameters = {parameter: HardwareParameter(parameter, meaning) for parameter, meaning in known_parameters.items()}
    plugin = find_hardware_class(document, name)
    for parameter in () if plugin is None else _find_parameters_in_sources(plugin.package, document):
        parameters.setdefault(parameter.name, parameter)
    for parameter_name in _find_parameters_in_text(document.text, name, excluded_offset):
        parameters.setdefault(parameter_name, HardwareParameter(parameter_name))
    return parameters


def _find_parameters_in_sources(folder: Path, document: Document) -> Iterator[HardwareParameter]:
    for file in find_files_and_packages(folder, _SOURCE_SUFFIXES)[0][:_MAX_FILES]:
        text = document.other(file)
        for use in _PARAMETER_ACCESS.finditer(text) if len(text) <= _MAX_TEXT_LENGTH else ():
            yield HardwareParameter(use[1], f"`{file.name}`", Target(file, *use.span(1)))


def _find_parameters_in_text(text: str, plugin: str, excluded_offset: int) -> Iterator[str]:
    """Yield the parameters that a text sets for a plugin."""
    is_inside_hardware, is_plugin, tag = False, False, ""
    for token in tokens(text):
        if token.kind is Kind.START:
            is_inside_hardware, tag = is_inside_hardware or token.name == "hardware", token.name
            if is_inside_hardware and is_plugin and tag == "param":
                name_attribute = next((attribute for attribute in token.attributes() if attribute.name == "name"), None)
                if (
                    name_attribute is not None
                    and name_attribute.value
                    and name_attribute.value_start != excluded_offset
                ):
                    yield name_attribute.value
        elif token.kind is Kind.TEXT and is_inside_hardware and tag == "plugin":
            is_plugin = token.text.strip() == plugin
        elif token.kind is Kind.END:
            is_inside_hardware, tag = is_inside_hardware and token.name != "hardware", ""
