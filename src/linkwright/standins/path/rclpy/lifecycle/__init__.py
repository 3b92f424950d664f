"""Stands in for ``rclpy.lifecycle``."""

from linkwright.graph.lifecycle.entities import LifecyclePublisher, ManagedEntity, SimpleManagedEntity
from linkwright.graph.lifecycle.entities import LifecyclePublisher as Publisher
from linkwright.graph.lifecycle.states import LifecycleState, TransitionCallbackReturn
from linkwright.graph.lifecycle.states import LifecycleState as State
from linkwright.standins.rclpy_api.lifecycle import LifecycleNode, LifecycleNodeMixin
from linkwright.standins.rclpy_api.lifecycle import LifecycleNode as Node

__all__ = [
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "Node",
    "Publisher",
    "SimpleManagedEntity",
    "State",
    "TransitionCallbackReturn",
]
