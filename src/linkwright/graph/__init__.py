"""The computation graph: nodes, topics, parameters, quality of service, time, logging and transforms."""

from linkwright.graph.bus import Publisher, Subscription
from linkwright.graph.clock import Clock, JumpClock, SystemClock, TimePoint
from linkwright.graph.executor import run_logged
from linkwright.graph.graph import Graph
from linkwright.graph.log import Logger, LogLevel, LogRecord, LogSink, console_line, print_to_console
from linkwright.graph.names import InvalidNameError
from linkwright.graph.node import Node
from linkwright.graph.parameters import (
    InvalidParameterTypeError,
    InvalidParameterValueError,
    Parameter,
    ParameterAlreadyDeclaredError,
    ParameterDescriptor,
    ParameterNotDeclaredError,
    ParameterType,
    SetParametersResult,
)
from linkwright.graph.qos import (
    DEFAULT_QOS,
    DESCRIPTION_QOS,
    SENSOR_DATA_QOS,
    STATIC_TF_PUBLISHER_QOS,
    STATIC_TF_SUBSCRIPTION_QOS,
    TF_QOS,
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.timer import GuardCondition, Timer
from linkwright.graph.transform_buffer import FrameSnapshot, TransformBuffer
from linkwright.graph.transform_errors import (
    TransformArgumentError,
    TransformConnectivityError,
    TransformError,
    TransformLookupError,
    TransformLoopError,
)
from linkwright.graph.transform_listener import TransformListener

__all__ = [
    "DEFAULT_QOS",
    "DESCRIPTION_QOS",
    "SENSOR_DATA_QOS",
    "STATIC_TF_PUBLISHER_QOS",
    "STATIC_TF_SUBSCRIPTION_QOS",
    "TF_QOS",
    "Clock",
    "DurabilityPolicy",
    "FrameSnapshot",
    "Graph",
    "GuardCondition",
    "HistoryPolicy",
    "InvalidNameError",
    "InvalidParameterTypeError",
    "InvalidParameterValueError",
    "JumpClock",
    "LogLevel",
    "LogRecord",
    "LogSink",
    "Logger",
    "Node",
    "Parameter",
    "ParameterAlreadyDeclaredError",
    "ParameterDescriptor",
    "ParameterNotDeclaredError",
    "ParameterType",
    "Publisher",
    "QoSProfile",
    "ReliabilityPolicy",
    "SetParametersResult",
    "Subscription",
    "SystemClock",
    "TimePoint",
    "Timer",
    "TransformArgumentError",
    "TransformBuffer",
    "TransformConnectivityError",
    "TransformError",
    "TransformListener",
    "TransformLookupError",
    "TransformLoopError",
    "console_line",
    "print_to_console",
    "run_logged",
]
