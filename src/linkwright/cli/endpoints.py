"""Publishers and subscriptions as ``ros2 topic info --verbose`` prints them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from linkwright.graph import QoSProfile

_INFINITE_NS = 0x7FFFFFFF_FFFFFFFF
"""From this many nanoseconds on (rmw: 9223372036.854775807 s) a duration counts as endless."""


def endpoint_text(info: Any) -> str:
    """What is known of an endpoint (rclpy ``TopicEndpointInfo``), in several lines.

    The type's hash is shown where the other side tells it, which Humble does not.
    """
    lines = [
        f"Node name: {info.node_name}",
        f"Node namespace: {info.node_namespace}",
        f"Topic type: {info.topic_type}",
    ]
    if str(info.topic_type_hash or ""):
        lines.append(f"Topic type hash: {info.topic_type_hash}")
    lines += [
        f"Endpoint type: {info.endpoint_type.name}",
        f"GID: {'.'.join(f'{byte:02x}' for byte in info.endpoint_gid)}",
        "QoS profile:",
        *qos_lines(info.qos_profile),
    ]
    return "\n".join(lines)


def qos_lines(qos: QoSProfile) -> list[str]:
    """The policies of a profile, a line each."""
    history = qos.history.name
    if history == "KEEP_LAST":
        history = f"{history} ({qos.depth})"
    return [
        f"  Reliability: {qos.reliability.name}",
        f"  History (Depth): {history}",
        f"  Durability: {qos.durability.name}",
        f"  Lifespan: {_duration(qos.lifespan)}",
        f"  Deadline: {_duration(qos.deadline)}",
        f"  Liveliness: {qos.liveliness.name}",
        f"  Liveliness lease duration: {_duration(qos.liveliness_lease_duration)}",
    ]


def _duration(duration: Any) -> str:
    nanoseconds = duration.nanoseconds
    if nanoseconds == 0 or nanoseconds >= _INFINITE_NS:
        return "Infinite"
    return f"{nanoseconds} nanoseconds"
