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
from linkwright.standins.rclpy_api.node import Node
from linkwright.standins.rclpy_api.type_support import check_for_type_support

__all__ = [
    "Client",
    "Node",
    "Parameter",
    "ParameterAlreadyDeclaredException",
    "ParameterNotDeclaredException",
    "Publisher",
    "QoSProfile",
    "Rate",
    "Service",
    "Subscription",
    "Timer",
    "check_for_type_support",
]
