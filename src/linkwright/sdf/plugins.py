"""The element ``<plugin>``: a library for the simulator, with parameters of any form."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import TEXT
from linkwright.xmltree import Element

_LIBRARY_SUFFIX = re.compile(r"\.(so|dylib|dll)(\.[0-9.]+)?$")
_GZ_PREFIX = re.compile(r"^(gz-sim|ignition-gazebo)[0-9]*-")


@dataclass(frozen=True, slots=True)
class Plugin:
    """A library that the simulator loads.

    Attributes:
        filename: the file name of the library, with or without ``lib`` and ``.so``.
        name: the name of the plugin; in gz-sim, the name of its class.
        element: the ``<plugin>`` element, which contains the parameters.
    """

    filename: str
    name: str = ""
    element: Element | None = field(default=None, compare=False, repr=False)


PLUGIN = ElementRule(
    "plugin",
    "a library that the simulator loads",
    (
        AttributeRule("filename", TEXT, "the library file, with or without lib and .so", required=True, default=""),
        AttributeRule("name", TEXT, "the name; in gz-sim, the name of the class", default=""),
    ),
    is_repeated=True,
    make=Plugin,
    keeps_element=True,
    passes_element=True,
    field="plugins",
)


def library_name(filename: str) -> str:
    """Return the name of a library without folder, ``lib``, ``.so`` and version.

    The prefix ``ignition-gazebo-`` becomes ``gz-sim-``.
    """
    name = _LIBRARY_SUFFIX.sub("", filename.strip().replace("\\", "/").rpartition("/")[2])
    return _GZ_PREFIX.sub("gz-sim-", name.removeprefix("lib"))


def find_original_library(class_name: str) -> str:
    """Return the library that defines a class, derived from the namespace of the class.

    For the namespace ``ign_ros2_control`` it is ``ign_ros2_control-system``; for a class without a namespace it is
    empty. The class identifies copies that vendors rename, such as ``franka_ign_ros2_control-system``.
    """
    namespace, separator, _ = class_name.strip().partition("::")
    return f"{namespace}-system" if separator else ""
