"""QoS policies and profiles, with rclpy's names and values."""

from __future__ import annotations

import warnings
from enum import Enum, IntEnum
from typing import Any, TypeVar

from linkwright.graph.time.values import INFINITE, Duration

P = TypeVar("P", bound="QoSPolicyEnum")


class QoSPolicyKind(IntEnum):
    """The policies, with the numbers that events use (rmw ``rmw_qos_policy_kind_t``)."""

    INVALID = 1
    DURABILITY = 2
    DEADLINE = 4
    LIVELINESS = 8
    RELIABILITY = 16
    HISTORY = 32
    LIFESPAN = 64
    DEPTH = 128
    LIVELINESS_LEASE_DURATION = 256
    AVOID_ROS_NAMESPACE_CONVENTIONS = 512


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    """Return the name of a policy, given by its kind or number."""
    return QoSPolicyKind(policy_kind).name


class InvalidQoSProfileError(Exception):
    """Raised when a profile lacks history or depth (rclpy ``InvalidQoSProfileException``)."""

    def __init__(self, *reasons: object) -> None:
        super().__init__("Invalid QoSProfile", *reasons)


class QoSPolicyEnum(IntEnum):
    """The base class of policy values (rclpy ``QoSPolicyEnum``)."""

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names of the values, as used on command lines."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        """Return the number of a policy value, given its name in any case.

        Raises:
            KeyError: there is no value with this name.
        """
        return cls[name.upper()].value

    @property
    def short_key(self) -> str:
        """The value's name, as used on command lines."""
        return self.name.lower()

    def __str__(self) -> str:
        return f"{type(self).__name__}.{self.name}"


class HistoryPolicy(QoSPolicyEnum):
    """The history policy: whether only the last `depth` messages are stored, or all messages."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    """The reliability policy: whether lost messages are sent again until they arrive."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(QoSPolicyEnum):
    """The durability policy: whether subscriptions that join late receive earlier messages."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class LivelinessPolicy(QoSPolicyEnum):
    """The liveliness policy: how a publisher asserts that it is alive."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


UNSPECIFIED = Duration()
"""The default of durations. A deadline, lifespan or lease with this value has no limit."""

BEST_AVAILABLE_DURATION = Duration(nanoseconds=INFINITE.nanoseconds - 1)
"""A duration as strict as the other endpoints allow (rmw ``RMW_QOS_DEADLINE_BEST_AVAILABLE``)."""

_DEFAULT_DEPTH = 10


class QoSProfile:
    """The policies of a publisher, subscription, service or client (rclpy ``QoSProfile``).

    Args:
        depth: the maximum number of messages that are queued for a callback, and that a transient local publisher
            stores for late joiners. It has no effect with KEEP_ALL.
        reliability: RELIABLE or BEST_EFFORT.
        durability: TRANSIENT_LOCAL or VOLATILE.
        history: KEEP_LAST or KEEP_ALL.
        lifespan: the time after publication for which a message is delivered.
        deadline: the maximum time between two messages.
        liveliness: how the publisher asserts that it is alive.
        liveliness_lease_duration: the time for which the publisher counts as alive after its last assertion.
        avoid_ros_namespace_conventions: whether the topic's name on the wire has no ROS prefix.

    Raises:
        InvalidQoSProfileError: neither history nor depth is given, or KEEP_LAST is given without depth.
    """

    __slots__ = (
        "_avoid_ros_namespace_conventions",
        "_deadline",
        "_depth",
        "_durability",
        "_history",
        "_lifespan",
        "_liveliness",
        "_liveliness_lease_duration",
        "_reliability",
    )

    def __init__(
        self,
        depth: int | None = None,
        reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE,
        durability: DurabilityPolicy = DurabilityPolicy.VOLATILE,
        history: HistoryPolicy | None = None,
        *,
        lifespan: Duration = UNSPECIFIED,
        deadline: Duration = UNSPECIFIED,
        liveliness: LivelinessPolicy = LivelinessPolicy.SYSTEM_DEFAULT,
        liveliness_lease_duration: Duration = UNSPECIFIED,
        avoid_ros_namespace_conventions: bool = False,
    ) -> None:
        if history is None:
            if depth is None:
                raise InvalidQoSProfileError("History and/or depth settings are required.")
            history = HistoryPolicy.KEEP_LAST
        self.history = history
        if self._history is HistoryPolicy.KEEP_LAST and depth is None:
            raise InvalidQoSProfileError("History set to KEEP_LAST without a depth setting.")
        self.depth = _DEFAULT_DEPTH if depth is None else depth
        self.reliability = reliability
        self.durability = durability
        self.lifespan = lifespan
        self.deadline = deadline
        self.liveliness = liveliness
        self.liveliness_lease_duration = liveliness_lease_duration
        self.avoid_ros_namespace_conventions = avoid_ros_namespace_conventions

    @classmethod
    def of(cls, qos: QoSProfile | int) -> QoSProfile:
        """Return a profile unchanged, or convert a number to a profile of that depth.

        As in rclpy, the other policies of the converted profile have their defaults.

        Raises:
            ValueError: the number is negative.
            TypeError: `qos` is neither a profile nor a number.
        """
        if isinstance(qos, QoSProfile):
            return qos
        if isinstance(qos, int):
            return cls(qos)
        raise TypeError(f"Expected QoSProfile or int, but received {qos!r}")

    @property
    def queue_length(self) -> int | None:
        """The maximum number of messages in a queue, or None for no limit.

        A depth of 0 counts as 1, as in Cyclone DDS.
        """
        return None if self._history is HistoryPolicy.KEEP_ALL else max(self._depth, 1)

    @property
    def history(self) -> HistoryPolicy:
        """The history policy: whether only the last `depth` messages are stored, or all of them."""
        return self._history

    @history.setter
    def history(self, value: HistoryPolicy | int) -> None:
        self._history: HistoryPolicy = _check_policy(HistoryPolicy, value)

    @property
    def depth(self) -> int:
        """The maximum number of messages that are stored with KEEP_LAST."""
        return self._depth

    @depth.setter
    def depth(self, value: int) -> None:
        assert isinstance(value, int)
        if value < 0:
            raise ValueError("depth must be greater than or equal to zero")
        if value == 0 and self._history is HistoryPolicy.KEEP_LAST:
            warnings.warn(
                "A zero depth with KEEP_LAST doesn't make sense; no data could be stored. "
                "This will be interpreted as SYSTEM_DEFAULT",
                stacklevel=3,
            )
        self._depth: int = value

    @property
    def reliability(self) -> ReliabilityPolicy:
        """The reliability policy: whether every message arrives."""
        return self._reliability

    @reliability.setter
    def reliability(self, value: ReliabilityPolicy | int) -> None:
        self._reliability: ReliabilityPolicy = _check_policy(ReliabilityPolicy, value)

    @property
    def durability(self) -> DurabilityPolicy:
        """The durability policy: whether late joiners receive earlier messages."""
        return self._durability

    @durability.setter
    def durability(self, value: DurabilityPolicy | int) -> None:
        self._durability: DurabilityPolicy = _check_policy(DurabilityPolicy, value)

    @property
    def lifespan(self) -> Duration:
        """The time after publication until a message expires."""
        return self._lifespan

    @lifespan.setter
    def lifespan(self, value: Duration) -> None:
        assert isinstance(value, Duration)
        self._lifespan: Duration = value

    @property
    def deadline(self) -> Duration:
        """The maximum time between two messages."""
        return self._deadline

    @deadline.setter
    def deadline(self, value: Duration) -> None:
        assert isinstance(value, Duration)
        self._deadline: Duration = value

    @property
    def liveliness(self) -> LivelinessPolicy:
        """The way in which the publisher asserts that it is alive."""
        return self._liveliness

    @liveliness.setter
    def liveliness(self, value: LivelinessPolicy | int) -> None:
        self._liveliness: LivelinessPolicy = _check_policy(LivelinessPolicy, value)

    @property
    def liveliness_lease_duration(self) -> Duration:
        """The time until the publisher counts as lost after its last assertion."""
        return self._liveliness_lease_duration

    @liveliness_lease_duration.setter
    def liveliness_lease_duration(self, value: Duration) -> None:
        assert isinstance(value, Duration)
        self._liveliness_lease_duration: Duration = value

    @property
    def avoid_ros_namespace_conventions(self) -> bool:
        """Whether the topic's name on the wire has no ROS prefix."""
        return self._avoid_ros_namespace_conventions

    @avoid_ros_namespace_conventions.setter
    def avoid_ros_namespace_conventions(self, value: bool) -> None:
        assert isinstance(value, bool)
        self._avoid_ros_namespace_conventions: bool = value

    def policies(self) -> dict[str, Any]:
        """Return the policies by name, in rclpy's order."""
        return {name: getattr(self, name) for name in _ORDER}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QoSProfile):
            return NotImplemented
        return self.policies() == other.policies()

    __hash__ = None  # type: ignore[assignment]  # a profile can be changed

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!s}' for name, value in self.policies().items())})"


_ORDER = (
    "history",
    "depth",
    "reliability",
    "durability",
    "lifespan",
    "deadline",
    "liveliness",
    "liveliness_lease_duration",
    "avoid_ros_namespace_conventions",
)


def _check_policy(kind: type[P], value: object) -> P:
    assert isinstance(value, int)
    return kind(value)


DEFAULT_QOS = QoSProfile(depth=10)
"""The default of ROS 2: reliable, volatile, with the last 10 messages."""

SYSTEM_DEFAULT_QOS = QoSProfile(
    0, ReliabilityPolicy.SYSTEM_DEFAULT, DurabilityPolicy.SYSTEM_DEFAULT, HistoryPolicy.SYSTEM_DEFAULT
)
"""The middleware chooses the policies (rmw ``rmw_qos_profile_system_default``)."""

UNKNOWN_QOS = QoSProfile(
    0,
    ReliabilityPolicy.UNKNOWN,
    DurabilityPolicy.UNKNOWN,
    HistoryPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
"""The profile of endpoints whose QoS is not known (rmw ``rmw_qos_profile_unknown``)."""

BEST_AVAILABLE_QOS = QoSProfile(
    10,
    ReliabilityPolicy.BEST_AVAILABLE,
    DurabilityPolicy.BEST_AVAILABLE,
    deadline=BEST_AVAILABLE_DURATION,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
    liveliness_lease_duration=BEST_AVAILABLE_DURATION,
)
"""The strictest policies that match the endpoints known at creation (rmw ``rmw_qos_profile_best_available``)."""

SENSOR_DATA_QOS = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
"""Best effort, with the last 5 messages. The node robot_state_publisher uses it for joint states."""

SERVICES_QOS = QoSProfile(depth=10)
"""For services and clients."""

PARAMETERS_QOS = QoSProfile(depth=1000)
"""For the parameter services."""

PARAMETER_EVENTS_QOS = QoSProfile(depth=1000)
"""For ``/parameter_events``."""

CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""For subscriptions to ``/clock`` (rclcpp ``ClockQoS``)."""

SIMULATION_CLOCK_QOS = QoSProfile(depth=10)
"""For publishers of ``/clock`` in simulations (gazebo_ros, ros_gz_bridge): reliable subscriptions also receive it."""

ROSOUT_QOS = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10))
"""For ``/rosout`` (rcl ``rcl_qos_profile_rosout_default``)."""

ACTION_STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For publishers of and subscriptions to the status topic of actions."""

TF_QOS = QoSProfile(depth=100)
"""For publishers of and subscriptions to ``/tf`` (tf2_ros DynamicBroadcasterQoS, DynamicListenerQoS)."""

STATIC_TF_PUBLISHER_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For publishers of ``/tf_static`` (tf2_ros StaticBroadcasterQoS)."""

STATIC_TF_SUBSCRIPTION_QOS = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For subscriptions to ``/tf_static`` (tf2_ros StaticListenerQoS)."""

LATCHED_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For publishers and subscriptions of maps, states and other data whose last message reaches late subscriptions."""

DESCRIPTION_QOS = LATCHED_QOS
"""For publishers of and subscriptions to ``robot_description``."""


class QoSPresetProfiles(Enum):
    """The preset profiles of rclpy, by name."""

    UNKNOWN = UNKNOWN_QOS
    DEFAULT = DEFAULT_QOS
    SYSTEM_DEFAULT = SYSTEM_DEFAULT_QOS
    SENSOR_DATA = SENSOR_DATA_QOS
    SERVICES_DEFAULT = SERVICES_QOS
    PARAMETERS = PARAMETERS_QOS
    PARAMETER_EVENTS = PARAMETER_EVENTS_QOS
    ACTION_STATUS_DEFAULT = ACTION_STATUS_QOS
    BEST_AVAILABLE = BEST_AVAILABLE_QOS

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names of the profiles, as used on command lines."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        """Return a profile, given its name in any case.

        Raises:
            KeyError: there is no profile with this name.
        """
        return cls[name.upper()].value
