"""Stands in for ``rclpy.qos``."""

from linkwright.graph.qos import (
    ACTION_STATUS_QOS as qos_profile_action_status_default,
)
from linkwright.graph.qos import (
    BEST_AVAILABLE_QOS as qos_profile_best_available,
)
from linkwright.graph.qos import (
    DEFAULT_QOS as qos_profile_default,
)
from linkwright.graph.qos import (
    PARAMETER_EVENTS_QOS as qos_profile_parameter_events,
)
from linkwright.graph.qos import (
    PARAMETERS_QOS as qos_profile_parameters,
)
from linkwright.graph.qos import (
    ROSOUT_QOS as qos_profile_rosout_default,
)
from linkwright.graph.qos import (
    SENSOR_DATA_QOS as qos_profile_sensor_data,
)
from linkwright.graph.qos import (
    SERVICES_QOS as qos_profile_services_default,
)
from linkwright.graph.qos import (
    SYSTEM_DEFAULT_QOS as qos_profile_system_default,
)
from linkwright.graph.qos import (
    UNKNOWN_QOS as qos_profile_unknown,
)
from linkwright.graph.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyEnum,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_policy_name_from_kind,
)
from linkwright.graph.qos import (
    InvalidQoSProfileError as InvalidQoSProfileException,
)
from linkwright.graph.qos_compatibility import QoSCompatibility, qos_check_compatible
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.qos import add_old_names

add_old_names()

_qos_profile_default = qos_profile_default

QoSDurabilityPolicy = DurabilityPolicy
QoSHistoryPolicy = HistoryPolicy
QoSLivelinessPolicy = LivelinessPolicy
QoSReliabilityPolicy = ReliabilityPolicy

__all__ = [
    "DurabilityPolicy",
    "HistoryPolicy",
    "InvalidQoSProfileException",
    "LivelinessPolicy",
    "QoSCompatibility",
    "QoSDurabilityPolicy",
    "QoSHistoryPolicy",
    "QoSLivelinessPolicy",
    "QoSPolicyEnum",
    "QoSPolicyKind",
    "QoSPresetProfiles",
    "QoSProfile",
    "QoSReliabilityPolicy",
    "ReliabilityPolicy",
    "qos_check_compatible",
    "qos_policy_name_from_kind",
    "qos_profile_action_status_default",
    "qos_profile_best_available",
    "qos_profile_default",
    "qos_profile_parameter_events",
    "qos_profile_parameters",
    "qos_profile_rosout_default",
    "qos_profile_sensor_data",
    "qos_profile_services_default",
    "qos_profile_system_default",
    "qos_profile_unknown",
]
