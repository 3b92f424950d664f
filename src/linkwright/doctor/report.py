"""The report of ``ros2 doctor --report`` about the computer, network, packages and graph."""

from __future__ import annotations

import os
import platform
import socket
import sys
from collections.abc import Iterable, Mapping, Sequence
from importlib import metadata

from linkwright.doctor.record import Observation, get_node_name
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.qos.compatibility import QoSCompatibility, qos_check_compatible

Section = tuple[str, Sequence[tuple[str, str]]]
"""The title of a section, and its rows of a name and a value."""

_REPORTED_PACKAGES = ("linkwright", "cyclonedds", "eclipse-zenoh", "rosbags", "numpy", "PyYAML", "colcon-core")
_VARIABLE_MARKS = ("ROS", "RMW", "RCUTILS", "CYCLONEDDS", "ZENOH", "LINKWRIGHT", "AMENT", "COLCON")
_UNIVERSAL_TOPICS = frozenset({"/parameter_events", "/rosout"})
_PADDING = 4


def make_report(observation: Observation) -> str:
    """Return the full report about the computer and an observed graph."""
    return format_sections(
        [
            ("NETWORK CONFIGURATION", _make_network_rows()),
            ("PACKAGE VERSIONS", _make_package_rows()),
            ("PLATFORM INFORMATION", _make_platform_rows()),
            ("QOS COMPATIBILITY LIST", _make_compatibility_rows(observation)),
            ("RMW MIDDLEWARE", [("middleware name", _find_middleware_name())]),
            ("ROS ENVIRONMENT", _make_environment_rows(os.environ)),
            ("TOPIC LIST", _make_topic_rows(observation)),
            ("NODE LIST", [("node", name) for name in observation.nodes] or [("node", "none")]),
        ]
    )


def format_sections(sections: Iterable[Section]) -> str:
    """Return the text of a report's sections in the format of ``ros2 doctor``."""
    lines = []
    for title, items in sections:
        lines.append(f"\n   {title}")
        width = max((len(name) for name, _ in items), default=0) + _PADDING
        lines += [f"{name:{width}}: {value}" for name, value in items]
    return "\n".join(lines) + "\n"


def _make_network_rows() -> list[tuple[str, str]]:
    items = [("host", socket.gethostname())]
    try:
        names = [name for _, name in socket.if_nameindex()]
    except (AttributeError, OSError):  # some systems do not provide this
        names = []
    for name in names:
        items.append(("device", name))
        address = _find_ipv4_address(name)
        if address:
            items.append(("inet", address))
    return items


def _find_ipv4_address(interface: str) -> str:
    """Return the IPv4 address of a network interface, or an empty string if it is unknown."""
    if not sys.platform.startswith("linux"):
        return ""
    import fcntl
    import struct

    request = 0x8915  # the ioctl request SIOCGIFADDR
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as connection:
        try:
            response = fcntl.ioctl(connection.fileno(), request, struct.pack("256s", interface[:15].encode()))
        except OSError:
            return ""
    return socket.inet_ntoa(response[20:24])


def _make_package_rows() -> list[tuple[str, str]]:
    return [(name, _find_version(name)) for name in _REPORTED_PACKAGES]


def _find_version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "not installed"


def _make_platform_rows() -> list[tuple[str, str]]:
    items = [
        ("system", platform.system()),
        ("platform info", platform.platform()),
        ("release", platform.release()),
        ("processor", platform.processor() or platform.machine()),
        ("python", f"{platform.python_implementation()} {platform.python_version()}"),
    ]
    distribution = os.environ.get("ROS_DISTRO")
    return [*items, ("distribution name", distribution)] if distribution else items


def _find_middleware_name() -> str:
    from linkwright.wire.joining import is_available, select_middleware, unavailable_reason
    from linkwright.wire.unsupported_settings import ZENOH

    if not is_available():
        return f"none: {unavailable_reason()}"
    return (
        "Eclipse Zenoh (as rmw_zenoh_cpp)"
        if select_middleware() == ZENOH
        else "Eclipse Cyclone DDS (as rmw_cyclonedds_cpp)"
    )


def _make_environment_rows(variables: Mapping[str, str]) -> list[tuple[str, str]]:
    names = sorted(name for name in variables if any(mark in name for mark in _VARIABLE_MARKS))
    return [(name, variables[name]) for name in names] or [("variables", "none")]


def _make_compatibility_rows(observation: Observation) -> list[tuple[str, str]]:
    items = []
    subscriptions = observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION)
    for publisher in _select_reported_endpoints(observation.endpoints_of_kind(EndpointKind.PUBLISHER)):
        for subscription in subscriptions:
            if subscription.name == publisher.name:
                compatibility, reason = qos_check_compatible(publisher.qos, subscription.qos)
                status = "OK" if compatibility is QoSCompatibility.OK or observation.over_zenoh else reason
                items += [
                    ("topic [type]", f"{publisher.name} [{publisher.type_name}]"),
                    ("publisher node", get_node_name(publisher)),
                    ("subscriber node", get_node_name(subscription)),
                    ("compatibility status", status),
                ]
    return items or [("compatibility status", "No publisher/subscriber pairs found")]


def _make_topic_rows(observation: Observation) -> list[tuple[str, str]]:
    publishers, subscriptions = (
        observation.endpoints_of_kind(EndpointKind.PUBLISHER),
        observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION),
    )
    items = []
    for topic in sorted({endpoint.name for endpoint in _select_reported_endpoints([*publishers, *subscriptions])}):
        items += [
            ("topic", topic),
            ("publisher count", str(sum(publisher.name == topic for publisher in publishers))),
            ("subscriber count", str(sum(subscription.name == topic for subscription in subscriptions))),
        ]
    return items or [("topic", "none")]


def _select_reported_endpoints(endpoints: Iterable[EndpointInfo]) -> list[EndpointInfo]:
    reported = (endpoint for endpoint in endpoints if endpoint.name not in _UNIVERSAL_TOPICS)
    return sorted(reported, key=lambda endpoint: (endpoint.name, get_node_name(endpoint)))
