"""The package of turtlesim's interfaces, and the QoS of its topics."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.graph import QoSProfile
from linkwright.messages.distribution import is_before_kilted

TOPIC_QOS = QoSProfile.of(7)


def find_interface_package(environment: Mapping[str, str]) -> str:
    """Return the package of turtlesim's messages, services and action.

    It is turtlesim, and turtlesim_msgs if ``ROS_DISTRO`` is Kilted or a later distribution.
    """
    return "turtlesim" if is_before_kilted(environment) else "turtlesim_msgs"
