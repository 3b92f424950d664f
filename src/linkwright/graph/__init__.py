"""The computation graph: nodes, topics, parameters, QoS, time, logging and transforms."""

from typing import TYPE_CHECKING

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind, MessageInfo
from linkwright.graph.endpoints.bus import Transport
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import Client, Service
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.faults import InterruptedWaitError, InvalidHandleError, NodeNotFoundError
from linkwright.graph.log.console import format_console_line, print_to_console
from linkwright.graph.log.logger import Logger, LogLevel, LogRecord, LogSink, log_failure, run_logged
from linkwright.graph.loop.dispatcher import Entity, GuardCondition
from linkwright.graph.loop.future import Future
from linkwright.graph.loop.timer import Rate, Timer, TimerInfo
from linkwright.graph.names.rules import (
    InvalidNameError,
    InvalidNamespaceError,
    InvalidNodeNameError,
    InvalidServiceNameError,
    InvalidTopicNameError,
    NodeIdentity,
)
from linkwright.graph.node import Graph, Node
from linkwright.graph.parameters.parameter import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    Parameter,
    ParameterAlreadyDeclaredException,
    ParameterDescriptor,
    ParameterException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterType,
    ParameterUninitializedException,
    SetParametersResult,
)
from linkwright.graph.qos.compatibility import QoSCompatibility, qos_check_compatible
from linkwright.graph.qos.profile import (
    ACTION_STATUS_QOS,
    CLOCK_QOS,
    DEFAULT_QOS,
    DESCRIPTION_QOS,
    LATCHED_QOS,
    PARAMETER_EVENTS_QOS,
    PARAMETERS_QOS,
    ROSOUT_QOS,
    SENSOR_DATA_QOS,
    SERVICES_QOS,
    SIMULATION_CLOCK_QOS,
    STATIC_TF_PUBLISHER_QOS,
    STATIC_TF_SUBSCRIPTION_QOS,
    SYSTEM_DEFAULT_QOS,
    TF_QOS,
    DurabilityPolicy,
    HistoryPolicy,
    InvalidQoSProfileError,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.clock import (
    Clock,
    ClockChange,
    JumpClock,
    JumpHandle,
    JumpThreshold,
    ROSClock,
    SystemClock,
    Timebase,
    TimeJump,
)
from linkwright.graph.time.values import ClockType, Duration, Time
from linkwright.graph.transforms.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
from linkwright.loading.deferred import deferred

if TYPE_CHECKING:
    from linkwright.graph.actions.client import ActionClient, ClientGoalHandle
    from linkwright.graph.actions.goal import CancelResponse, GoalResponse, GoalStatus, ServerGoalHandle
    from linkwright.graph.actions.server import ActionServer
    from linkwright.graph.endpoints.event_types import PublisherEventCallbacks, SubscriptionEventCallbacks
    from linkwright.graph.transforms.buffer import FrameSnapshot, TransformBuffer
    from linkwright.graph.transforms.listener import TransformListener

__all__ = [
    "ACTION_STATUS_QOS",
    "CLOCK_QOS",
    "DEFAULT_QOS",
    "DESCRIPTION_QOS",
    "LATCHED_QOS",
    "PARAMETERS_QOS",
    "PARAMETER_EVENTS_QOS",
    "ROSOUT_QOS",
    "SENSOR_DATA_QOS",
    "SERVICES_QOS",
    "SIMULATION_CLOCK_QOS",
    "STATIC_TF_PUBLISHER_QOS",
    "STATIC_TF_SUBSCRIPTION_QOS",
    "SYSTEM_DEFAULT_QOS",
    "TF_QOS",
    "ActionClient",
    "ActionServer",
    "CancelResponse",
    "Client",
    "ClientGoalHandle",
    "Clock",
    "ClockChange",
    "ClockType",
    "ConnectivityException",
    "DurabilityPolicy",
    "Duration",
    "EndpointInfo",
    "EndpointKind",
    "Entity",
    "ExtrapolationException",
    "FrameSnapshot",
    "Future",
    "GoalResponse",
    "GoalStatus",
    "Graph",
    "GuardCondition",
    "HistoryPolicy",
    "InterruptedWaitError",
    "InvalidArgumentException",
    "InvalidHandleError",
    "InvalidNameError",
    "InvalidNamespaceError",
    "InvalidNodeNameError",
    "InvalidParameterException",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidQoSProfileError",
    "InvalidServiceNameError",
    "InvalidTopicNameError",
    "JumpClock",
    "JumpHandle",
    "JumpThreshold",
    "LivelinessPolicy",
    "LogLevel",
    "LogRecord",
    "LogSink",
    "Logger",
    "LookupException",
    "MessageInfo",
    "Node",
    "NodeIdentity",
    "NodeNotFoundError",
    "Parameter",
    "ParameterAlreadyDeclaredException",
    "ParameterDescriptor",
    "ParameterException",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterType",
    "ParameterUninitializedException",
    "Publisher",
    "PublisherEventCallbacks",
    "QoSCompatibility",
    "QoSPolicyKind",
    "QoSPresetProfiles",
    "QoSProfile",
    "ROSClock",
    "Rate",
    "ReliabilityPolicy",
    "ServerGoalHandle",
    "Service",
    "SetParametersResult",
    "Subscription",
    "SubscriptionEventCallbacks",
    "SystemClock",
    "Time",
    "TimeJump",
    "Timebase",
    "Timer",
    "TimerInfo",
    "TransformBuffer",
    "TransformException",
    "TransformListener",
    "Transport",
    "format_console_line",
    "log_failure",
    "print_to_console",
    "qos_check_compatible",
    "run_logged",
]

__getattr__ = deferred(
    __name__,
    {
        "actions.client": ("ActionClient", "ClientGoalHandle"),
        "actions.goal": ("CancelResponse", "GoalResponse", "GoalStatus", "ServerGoalHandle"),
        "actions.server": ("ActionServer",),
        "endpoints.event_types": ("PublisherEventCallbacks", "SubscriptionEventCallbacks"),
        "transforms.buffer": ("FrameSnapshot", "TransformBuffer"),
        "transforms.listener": ("TransformListener",),
    },
)
"""Names that most nodes do not use. Transforms need numpy, whose import takes longer than everything else here."""
