"""Action servers and clients of rclpy's nodes (rclpy ``action``)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.graph.actions import client as action_client
from linkwright.graph.actions import server as action_server
from linkwright.graph.introspection.graph_queries import NamesAndTypes
from linkwright.standins.rclpy_api.waitable import NumberOfEntities

if TYPE_CHECKING:
    from linkwright.standins.rclpy_api.node import Node


class ActionServer(action_server.ActionServer):
    """An action server of rclpy that also reports the number of its entities."""

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of entities of the server: three services and a timer.

        The timer drops old results.
        """
        return NumberOfEntities(num_timers=1, num_services=3)


class ActionClient(action_client.ActionClient):
    """An action client of rclpy that also reports the number of its entities."""

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of entities of the client: three service clients and two subscriptions.

        The subscriptions receive the feedback and the status.
        """
        return NumberOfEntities(num_subscriptions=2, num_clients=3)


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """Return the name and the types of each action in the graph."""
    return node.get_action_names_and_types()


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the name and the types of each action for which a node has a client."""
    return node.context.graph.get_action_client_names_and_types_by_node(remote_node_name, remote_node_namespace)


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the name and the types of each action for which a node has a server."""
    return node.context.graph.get_action_server_names_and_types_by_node(remote_node_name, remote_node_namespace)
