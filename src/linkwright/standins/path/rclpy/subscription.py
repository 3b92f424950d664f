"""Stands in for ``rclpy.subscription``."""

from linkwright.graph.subscription import Subscription
from linkwright.graph.transport import MessageInfo
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.type_support import MsgType

__all__ = ["MessageInfo", "MsgType", "Subscription"]
