"""Stands in for ``rclpy.subscription``."""

from linkwright.graph.subscription import Subscription
from linkwright.graph.transport import MessageInfo

__all__ = ["MessageInfo", "Subscription"]
