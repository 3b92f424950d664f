"""Action servers and clients of rclpy's nodes (rclpy ``action``)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from linkwright.graph.actions import client as action_client
from linkwright.graph.actions import server as action_server
from linkwright.graph.introspection import NamesAndTypes
from linkwright.standins.rclpy_api.waitable import NumberOfEntities

if TYPE_CHECKING:
    from linkwright.standins.rclpy_api.node import Node


class ActionServer(action_server.ActionServer):
    """Executes the goals of an action.

    Args:
        node: whose it is.
        action_type: the action class.
        action_name: relative, absolute or private (``~/``) name.
        execute_callback: called with the handle of each goal that is executed; gives the result.
        options: what else `linkwright.graph.actions.server.ActionServer` takes.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[Any], Any],
        **options: Any,
    ) -> None:
        super().__init__(node.graph_node, action_type, action_name, execute_callback, **options)

    def get_num_entities(self) -> NumberOfEntities:
        """What it is made of: a timer for results that are no longer kept, and three services."""
        return NumberOfEntities(num_timers=1, num_services=3)


class ActionClient(action_client.ActionClient):
    """Sends goals to an action.

    Args:
        node: whose it is.
        action_type: the action class.
        action_name: relative, absolute or private (``~/``) name.
        options: what else `linkwright.graph.actions.client.ActionClient` takes.
    """

    def __init__(self, node: Node, action_type: Any, action_name: str, **options: Any) -> None:
        super().__init__(node.graph_node, action_type, action_name, **options)

    def get_num_entities(self) -> NumberOfEntities:
        """What it is made of: subscriptions to feedback and status, and three clients."""
        return NumberOfEntities(num_subscriptions=2, num_clients=3)


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """The actions that there are, with their types."""
    return node.graph_node.get_action_names_and_types()


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions that a node sends goals to, with their types."""
    graph = node.graph_node.graph
    return graph.get_action_client_names_and_types_by_node(remote_node_name, remote_node_namespace)


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions that a node executes, with their types."""
    graph = node.graph_node.graph
    return graph.get_action_server_names_and_types_by_node(remote_node_name, remote_node_namespace)
