"""Whether a class is that of a message or service (rclpy ``type_support``); where it is not, the errors are rclpy's."""

from __future__ import annotations

import sys
from typing import Any, TypeVar

MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")


def check_for_type_support(interface: Any) -> None:
    """Raise AttributeError unless something is the class of a message, service or action of ours."""
    if isinstance(getattr(interface, "TYPE_NAME", None), str):
        return
    module = sys.modules.get(getattr(interface, "__module__", ""))
    place = getattr(module, "__file__", None)
    where = f", from {place}," if place else ""
    raise AttributeError(
        f"{interface!r}{where} is not an interface class that this rclpy can use. This might be a ROS 1 message type, "
        "or one built for a real ROS 2, which does not go together with Linkwright's rclpy"
    )


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Raise unless something is the class of a message.

    Raises:
        AttributeError: it is no class of an interface.
        RuntimeError: it is one of a service or action.
    """
    check_for_type_support(msg_type)
    if "/msg/" not in msg_type.TYPE_NAME and hasattr(msg_type, "Request"):
        raise RuntimeError("The message type provided is not valid, this might be a service or action")


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Raise unless something is the class of a service.

    Raises:
        AttributeError: it is no class of an interface.
        RuntimeError: it is one of a message or action.
    """
    check_for_type_support(srv_type)
    if not (hasattr(srv_type, "Request") and hasattr(srv_type, "Response")):
        raise RuntimeError("The service type provided is not valid, this might be a message or action")
