"""Managed nodes (rclpy ``lifecycle``)."""

from __future__ import annotations

from typing import Any

from linkwright.graph.lifecycle.managed_node import LifecycleNodeMixin
from linkwright.graph.loop.node_handle import CallbackGroup
from linkwright.standins.rclpy_api.node import Node


class LifecycleNode(LifecycleNodeMixin, Node):
    """A managed node, and the base class of users' managed nodes.

    Args:
        node_name: the name of the node.
        enable_communication_interface: whether the node offers services for transitions, and publishes them.
        callback_group: the callback group of these services.
        arguments: further arguments of `Node`.

    Raises:
        TypeError: `enable_communication_interface` is not a bool.
    """

    def __init__(
        self,
        node_name: str,
        *,
        enable_communication_interface: bool = True,
        callback_group: CallbackGroup | None = None,
        **arguments: Any,
    ) -> None:
        if not isinstance(enable_communication_interface, bool):
            raise TypeError(f"enable_communication_interface must be a bool, not {enable_communication_interface!r}")
        Node.__init__(self, node_name, **arguments)
        LifecycleNodeMixin.__init__(
            self, enable_communication_interface=enable_communication_interface, callback_group=callback_group
        )
