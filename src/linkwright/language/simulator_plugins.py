"""The plugins of Gazebo classic and gz, with their parameters as elements.

They come from ``simulator_plugins.json``, which ``tools/simulator_plugins.py`` records.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.plugins import PLUGIN, library_name
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TRUTH, VECTOR3

_FILE = "simulator_plugins.json"
_VALUE_TYPES = {"str": TEXT, "float": NUMBER, "int": INTEGER, "bool": TRUTH, "vector": VECTOR3}
_ROS = ElementRule(
    "ros",
    "the node of the plugin",
    children=tuple(
        ElementRule(tag, meaning, attributes, is_repeated=True, text=AttributeRule("text", TEXT, meaning))
        for tag, meaning, attributes in (
            ("namespace", "the namespace of the node", ()),
            ("remapping", "another name for a topic, as in old:=new", ()),
            ("argument", "an argument of the node, as after --ros-args", ()),
            (
                "parameter",
                "a parameter of the node",
                (
                    AttributeRule("name", TEXT, "its name", required=True),
                    AttributeRule("type", TEXT, "its type: string, int, float or bool", usually_written=True),
                ),
            ),
        )
    ),
)
"""The element ``<ros>`` of the plugins of gazebo_ros_pkgs."""


@dataclass(frozen=True, slots=True)
class SimulatorPlugin:
    """A plugin of a simulator.

    Attributes:
        library: the name of the library without ``lib`` and ``.so``.
        class_name: the class, which gz needs as the name of the plugin, or empty for Gazebo classic.
        purpose: a description of the plugin.
        rule: its element, with the parameters as children.
    """

    library: str
    class_name: str
    purpose: str
    rule: ElementRule

    @property
    def is_classic(self) -> bool:
        """Whether the plugin belongs to Gazebo classic."""
        return not self.class_name

    @property
    def filename(self) -> str:
        """The file name as written in descriptions."""
        return f"lib{self.library}.so" if self.is_classic else self.library


@cache
def simulator_plugins() -> Mapping[str, SimulatorPlugin]:
    """Return the known plugins by library."""
    table = json.loads(resources.files(__package__).joinpath(_FILE).read_text(encoding="utf-8"))
    return {library: _parse_plugin(library, entry) for library, entry in table.items()}


def _parse_plugin(library: str, entry: Mapping[str, object]) -> SimulatorPlugin:
    name, purpose, parameters = str(entry["class"]), str(entry["about"]), entry["parameters"]
    assert isinstance(parameters, list)
    children = tuple(map(_parse_parameter, parameters))
    if not name:
        children = (_ROS, *children)
    return SimulatorPlugin(
        library, name, purpose, ElementRule("plugin", purpose, PLUGIN.attributes, children, is_repeated=True)
    )


def _parse_parameter(entry: Mapping[str, str]) -> ElementRule:
    name, meaning, is_repeated = entry["name"], entry["meaning"], bool(entry.get("many"))
    text = AttributeRule(
        "text",
        _VALUE_TYPES[entry["type"]],
        meaning,
        entry["unit"],
        required=bool(entry.get("required")),
        default=entry.get("default"),
    )
    return ElementRule(name, meaning, is_repeated=is_repeated, text=text, required=text.required)


def find_plugin(filename: str, name: str = "") -> SimulatorPlugin | None:
    """Return the plugin that an element ``<plugin>`` loads, or None if it is unknown.

    Args:
        filename: the file name, in any spelling.
        name: the name in the element, which must be the class in gz.
    """
    plugin = simulator_plugins().get(library_name(filename)) if filename else None
    return plugin or (_plugins_by_class().get(_modern_name(name)) if "::" in name else None)


def _modern_name(name: str) -> str:
    return name.replace("ignition::gazebo::", "gz::sim::")


@cache
def _plugins_by_class() -> Mapping[str, SimulatorPlugin]:
    return {plugin.class_name: plugin for plugin in simulator_plugins().values() if plugin.class_name}
