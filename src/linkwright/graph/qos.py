"""Quality of service: what publishers offer, what subscriptions ask for, and when the two go together."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class ReliabilityPolicy(Enum):
    """Whether every message arrives."""

    RELIABLE = 1
    BEST_EFFORT = 2


class DurabilityPolicy(Enum):
    """Whether subscriptions that come late get what was published before."""

    TRANSIENT_LOCAL = 1
    VOLATILE = 2


class HistoryPolicy(Enum):
    """Whether only the last `depth` messages wait, or all."""

    KEEP_LAST = 1
    KEEP_ALL = 2


@dataclass(frozen=True, slots=True)
class QoSProfile:
    """The policies of a publisher or subscription; the defaults are ROS 2's but for `depth`, which is to be thought of.

    Attributes:
        depth: how many messages wait for a callback, and how many a transient local publisher keeps for late comers.
            It means nothing with KEEP_ALL.
        reliability: RELIABLE or BEST_EFFORT.
        durability: TRANSIENT_LOCAL or VOLATILE.
        history: KEEP_LAST or KEEP_ALL.
    """

    depth: int
    reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE
    durability: DurabilityPolicy = DurabilityPolicy.VOLATILE
    history: HistoryPolicy = HistoryPolicy.KEEP_LAST

    def __post_init__(self) -> None:
        if self.history is HistoryPolicy.KEEP_LAST and self.depth < 1:
            raise ValueError(f"a history that keeps the last messages needs a depth of at least 1, not {self.depth}")

    @classmethod
    def of(cls, qos: QoSProfile | int) -> QoSProfile:
        """A profile as it is; a number means the default profile with that depth, as in rclpy."""
        return cls(qos) if isinstance(qos, int) else qos

    @property
    def queue_length(self) -> int | None:
        """How many messages may wait; None for any number."""
        return self.depth if self.history is HistoryPolicy.KEEP_LAST else None


DEFAULT_QOS = QoSProfile(depth=10)
"""ROS 2's default: reliable, volatile, the last 10."""

SENSOR_DATA_QOS = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
"""Best effort, the last 5; robot_state_publisher subscribes to joint states with it."""

TF_QOS = QoSProfile(depth=100)
"""For ``/tf``, both sides (tf2_ros DynamicBroadcasterQoS, DynamicListenerQoS)."""

STATIC_TF_PUBLISHER_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For publishers of ``/tf_static`` (tf2_ros StaticBroadcasterQoS)."""

STATIC_TF_SUBSCRIPTION_QOS = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For subscriptions to ``/tf_static`` (tf2_ros StaticListenerQoS)."""

DESCRIPTION_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For ``robot_description``, both sides."""


def incompatible_policies(offered: QoSProfile, requested: QoSProfile) -> list[str]:
    """Names of the policies in which a subscription asks for more than a publisher offers; none when they match.

    A reliable subscription needs a reliable publisher, and a transient local one a transient local publisher
    (DDS "requested versus offered"). The names are those that rclcpp logs.
    """
    policies = []
    if requested.reliability is ReliabilityPolicy.RELIABLE and offered.reliability is ReliabilityPolicy.BEST_EFFORT:
        policies.append("RELIABILITY_QOS_POLICY")
    if requested.durability is DurabilityPolicy.TRANSIENT_LOCAL and offered.durability is DurabilityPolicy.VOLATILE:
        policies.append("DURABILITY_QOS_POLICY")
    return policies
