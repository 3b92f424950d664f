"""The base of action servers and action clients."""

from __future__ import annotations

from abc import ABC, abstractmethod
from types import GenericAlias
from typing import TYPE_CHECKING, Any

from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.node import Node

if TYPE_CHECKING:
    from typing_extensions import Self


class ActionEndpoint(ABC):
    """The server or client side of an action.

    Leaving its ``with`` block destroys it.

    Args:
        node: the node that owns the endpoint.
        action_type: the action's class or type name.
        action_name: a relative, absolute or private name.

    Raises:
        InvalidServiceNameError: the name is not valid.
    """

    __class_getitem__: Any = classmethod(GenericAlias)  # As in rclpy, annotations may name the action type.

    def __init__(self, node: Node, action_type: Any, action_name: str) -> None:
        from linkwright.messages import get_action

        self._node = node
        self._handle: NodeHandle = node.handle
        self._action_type = get_action(action_type) if isinstance(action_type, str) else action_type
        self._action_name = node.resolve_service_name(action_name)
        self._destroyed = False

    @property
    def action_type(self) -> Any:
        """The class of the action."""
        return self._action_type

    @property
    def action_name(self) -> str:
        """The action's absolute name."""
        return self._action_name

    @abstractmethod
    def destroy(self) -> None:
        """Remove the endpoint from the graph.

        A second call does nothing.
        """

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def _full_name(self, name: str) -> str:
        """Return the absolute name of one of the action's services or topics.

        It has the form ``NAME/_action/...``.
        """
        return f"{self._action_name}/_action/{name}"
