"""scan_to_scan_filter_chain of laser_filters: passes laser scans through a chain of filters.

Source: laser_filters 2.0 (ROS 2 Humble): the topics, the QoS and the parameters ``filterN.name``, ``filterN.type`` and
``filterN.params``. With ``tf_message_filter_target_frame``, a scan whose transform to that frame is unknown is dropped
without waiting, so ``tf_message_filter_tolerance`` has no effect.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import MISSING, fields
from typing import Any, get_type_hints

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.graph import SENSOR_DATA_QOS, Graph, Node, ParameterDescriptor, Subscription
from linkwright.loading.extensions import extensions
from linkwright.messages import Time, get_message
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import log_unknown_parameters
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions
from linkwright.perception.scans.scan import Scan, ScanFilter

GROUP = "linkwright.laser_filters"
"""The group of entry points for filters. An entry point's name is the filter's type in a parameter file."""

_PACKAGE_PREFIX = "laser_filters/"
_FILTER_PATTERN = re.compile(r"filter(\d+)\.")
_QUEUE_DEPTH = 1000


class ScanToScanFilterChain(SingleNode):
    """The node that passes laser scans through a chain of filters.

    Raises:
        LinkwrightError: a filter of the chain does not exist (NODE451), lacks a parameter (NODE452), or has a parameter
            with an invalid value (NODE433).
    """

    DEFAULT_NAME = "scan_to_scan_filter_chain"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            self._chain = read_chain(node)
            self._target_frame: str = node.declare_parameter("tf_message_filter_target_frame", "").value
            node.declare_parameter("tf_message_filter_tolerance", 0.03)  # no effect: scans do not wait
            is_lazy = node.declare_parameter("lazy_subscription", False).value
            log_unknown_parameters(node)
        self._poses = FramePoses(node, "Dropping Scan: Transform unavailable")
        message_class = get_message("sensor_msgs/msg/LaserScan")
        self._publisher = node.create_publisher(message_class, "scan_filtered", _QUEUE_DEPTH)

        def subscribe() -> Sequence[Subscription[Any]]:
            return (node.create_subscription(message_class, "scan", self._receive, SENSOR_DATA_QOS),)

        self._subscriptions = LazySubscriptions(graph, node, (self._publisher,), subscribe) if is_lazy else None
        if not is_lazy:
            subscribe()

    def close(self) -> None:
        """Close the node."""
        if self._subscriptions is not None:
            self._subscriptions.close()
        super().close()

    def _receive(self, message: Any) -> None:
        scan: Scan | None = to_scan(message)
        header = message.header
        if (
            self._target_frame
            and self._poses.pose(self._target_frame, header.frame_id, header.stamp.nanoseconds) is None
        ):
            return
        for scan_filter in self._chain:
            assert scan is not None, "the loop ends where a scan is dropped"
            scan = scan_filter.apply(scan, self._poses.pose)
            if scan is None:
                return
        if scan is not None:
            self._publisher.publish(to_message(scan, message.scan_time))


def to_scan(message: Any) -> Scan:
    """Convert a sensor_msgs/msg/LaserScan to a scan with its own arrays."""
    return Scan(
        ranges=np.array(message.ranges, dtype=np.float32),
        intensities=np.array(message.intensities, dtype=np.float32),
        angle_min=message.angle_min,
        angle_max=message.angle_max,
        angle_increment=message.angle_increment,
        range_min=message.range_min,
        range_max=message.range_max,
        time_increment=message.time_increment,
        stamp_ns=message.header.stamp.nanoseconds,
        frame=message.header.frame_id,
    )


def to_message(scan: Scan, scan_time: float) -> Any:
    """Convert a scan to a LaserScan message, given the time between two scans in seconds."""
    message = get_message("sensor_msgs/msg/LaserScan")()
    message.header.stamp, message.header.frame_id = Time.from_nanoseconds(scan.stamp_ns), scan.frame
    message.angle_min, message.angle_max, message.angle_increment = scan.angle_min, scan.angle_max, scan.angle_increment
    message.range_min, message.range_max = scan.range_min, scan.range_max
    message.time_increment, message.scan_time = scan.time_increment, scan_time
    message.ranges, message.intensities = scan.ranges, scan.intensities
    return message


def read_chain(node: Node) -> list[ScanFilter]:
    """Return the filters of the chain that the node's parameters describe.

    The chain starts with ``filter1`` and ends before the first missing number. The parameters of its filters are
    declared.

    Raises:
        LinkwrightError: see `ScanToScanFilterChain`.
    """
    numbers = {int(match[1]) for name in node.undeclared_overrides() if (match := _FILTER_PATTERN.match(name))}
    count = next(number for number in range(1, len(numbers) + 2) if number not in numbers) - 1
    for number in sorted(number for number in numbers if number > count):
        node.get_logger().warning(f"'filter{number}' is not used: the chain ends before 'filter{count + 1}'")
    chain = []
    for number in range(1, count + 1):
        prefix = f"filter{number}."
        for name in node.undeclared_overrides():
            if name.startswith(prefix):
                node.declare_parameter(name, None, ParameterDescriptor(dynamic_typing=True))
        settings = _nest(
            {name: parameter.value for name, parameter in node.get_parameters_by_prefix(prefix[:-1]).items()}
        )
        chain.append(_make_filter(node, prefix, settings))
    return chain


def _make_filter(node: Node, prefix: str, settings: dict[str, Any]) -> ScanFilter:
    entry_points = extensions(GROUP)
    type_name = settings.get("type")
    if not isinstance(type_name, str):
        raise _parameter_error("NODE452", phrase("parameter '{name}' is not set", name=f"{prefix}type"), None)
    entry_point = entry_points.get(type_name) or entry_points.get(_PACKAGE_PREFIX + type_name)
    if entry_point is None:
        hint = did_you_mean(type_name, entry_points) or phrase(
            "choose from {names}", names=", ".join(sorted(entry_points))
        )
        raise _parameter_error(
            "NODE451", phrase("there is no filter '{kind}' ({name})", kind=type_name, name=f"{prefix}type"), hint
        )
    filter_class = load_extension(
        entry_point, "NODE453", phrase("the filter '{name}' cannot be imported", name=type_name)
    )
    field_types = get_type_hints(filter_class)
    given_values = settings.get("params") or {}
    parameters = {field.name: field for field in fields(filter_class) if field.init}
    values = {
        name: _convert(f"{prefix}params.{name}", value, field_types[name])
        for name, value in given_values.items()
        if name in parameters
    }
    for name in given_values:
        if name not in parameters:
            suggestion = did_you_mean(name, parameters)
            message = f"'{prefix}params.{name}' is not a parameter of {type_name}" + (
                f"; {suggestion}" if suggestion else ""
            )
            node.get_logger().warning(message)
    for name, parameter_field in parameters.items():
        if name not in values and parameter_field.default is MISSING and parameter_field.default_factory is MISSING:
            raise _parameter_error(
                "NODE452", phrase("parameter '{name}' is not set", name=f"{prefix}params.{name}"), None
            )
    scan_filter: ScanFilter = filter_class(**values)
    return scan_filter


def _convert(name: str, value: Any, kind: Any) -> Any:
    """Convert a parameter's value to the type of the filter's field.

    An integer is accepted as a float, and 0 and 1 as booleans.

    Raises:
        LinkwrightError: NODE433, the value has another type.
    """
    if kind is float and isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    if kind is bool and value in (True, False):
        return bool(value)
    if kind in (int, str) and isinstance(value, kind) and not isinstance(value, bool):
        return value
    if kind not in (float, bool, int, str) and isinstance(value, dict):
        return value
    raise _parameter_error("NODE433", phrase("parameter '{name}' cannot be '{value}'", name=name, value=value), None)


def _parameter_error(code: str, message: Phrase, hint: Phrase | None) -> LinkwrightError:
    return LinkwrightError(Diagnostic(code, message, hint=hint))


def _nest(values: dict[str, Any]) -> dict[str, Any]:
    tree: dict[str, Any] = {}
    for name, value in values.items():
        *path, leaf = name.split(".")
        branch = tree
        for key in path:
            branch = branch.setdefault(key, {})
        branch[leaf] = value
    return tree
