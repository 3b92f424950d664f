"""The computation graph: nodes, topics, parameters, quality of service, time, logging and transforms."""

from linkwright.graph.actions.client import ActionClient, ClientGoalHandle
from linkwright.graph.actions.goal import CancelResponse, GoalResponse, GoalStatus, ServerGoalHandle
from linkwright.graph.actions.server import ActionServer
from linkwright.graph.client import Client
from linkwright.graph.clock import Clock, ClockChange, JumpHandle, JumpThreshold, ROSClock, TimeJump
from linkwright.graph.entity import Entity
from linkwright.graph.events import PublisherEventCallbacks, SubscriptionEventCallbacks
from linkwright.graph.executor import run_logged
from linkwright.graph.faults import InterruptedWaitError, InvalidHandleError, NodeNotFoundError
from linkwright.graph.future import Future
from linkwright.graph.graph import Graph
from linkwright.graph.log.logger import Logger, LogLevel, LogRecord, LogSink, console_line, print_to_console
from linkwright.graph.names import (
    InvalidNameError,
    InvalidNamespaceError,
    InvalidNodeNameError,
    InvalidServiceNameError,
    InvalidTopicNameError,
)
from linkwright.graph.node import Node
from linkwright.graph.parameters.errors import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from linkwright.graph.parameters.parameter import Parameter, ParameterDescriptor, ParameterType, SetParametersResult
from linkwright.graph.publisher import Publisher
from linkwright.graph.qos import (
    ACTION_STATUS_QOS,
    CLOCK_QOS,
    DEFAULT_QOS,
    DESCRIPTION_QOS,
    PARAMETER_EVENTS_QOS,
    PARAMETERS_QOS,
    ROSOUT_QOS,
    SENSOR_DATA_QOS,
    SERVICES_QOS,
    STATIC_TF_PUBLISHER_QOS,
    STATIC_TF_SUBSCRIPTION_QOS,
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
from linkwright.graph.qos_compatibility import QoSCompatibility, qos_check_compatible
from linkwright.graph.rate import Rate
from linkwright.graph.service import Service
from linkwright.graph.subscription import Subscription
from linkwright.graph.time import ClockType, Duration, Time
from linkwright.graph.timebase import JumpClock, SystemClock, Timebase
from linkwright.graph.timer import GuardCondition, Timer, TimerInfo
from linkwright.graph.transforms.buffer import FrameSnapshot, TransformBuffer
from linkwright.graph.transforms.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
from linkwright.graph.transforms.listener import TransformListener
from linkwright.graph.transport import EndpointInfo, EndpointKind, MessageInfo, NodeIdentity, Transport

__all__ = [
    "ACTION_STATUS_QOS",
    "CLOCK_QOS",
    "DEFAULT_QOS",
    "DESCRIPTION_QOS",
    "PARAMETERS_QOS",
    "PARAMETER_EVENTS_QOS",
    "ROSOUT_QOS",
    "SENSOR_DATA_QOS",
    "SERVICES_QOS",
    "STATIC_TF_PUBLISHER_QOS",
    "STATIC_TF_SUBSCRIPTION_QOS",
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
    "console_line",
    "print_to_console",
    "qos_check_compatible",
    "run_logged",
]
