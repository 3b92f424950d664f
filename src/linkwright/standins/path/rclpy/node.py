"""Stands in for ``rclpy.node``."""

from linkwright.graph.client import Client
from linkwright.graph.parameters.errors import ParameterAlreadyDeclaredException, ParameterNotDeclaredException
from linkwright.graph.parameters.parameter import Parameter
from linkwright.graph.publisher import Publisher
from linkwright.graph.qos import QoSProfile
from linkwright.graph.rate import Rate
from linkwright.graph.service import Service
from linkwright.graph.subscription import Subscription
from linkwright.graph.timer import Timer
from linkwright.standins.rclpy_api.errors import NodeNameNonExistentError
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.node import Node
from linkwright.standins.rclpy_api.type_support import (
    MsgType,
    SrvType,
    SrvTypeRequest,
    SrvTypeResponse,
    check_for_type_support,
)

HIDDEN_NODE_PREFIX = "_"

__all__ = [
    "HIDDEN_NODE_PREFIX",
    "Client",
    "MsgType",
    "Node",
    "NodeNameNonExistentError",
    "Parameter",
    "ParameterAlreadyDeclaredException",
    "ParameterNotDeclaredException",
    "Publisher",
    "QoSProfile",
    "Rate",
    "Service",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
    "Subscription",
    "Timer",
    "check_for_type_support",
]
