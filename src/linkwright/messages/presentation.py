"""Texts of interfaces for display: definitions, and prototypes to fill in."""

from __future__ import annotations

from typing import Any

from linkwright.messages.classes import get_interface
from linkwright.messages.definitions.library import LIBRARY
from linkwright.messages.message import ActionType, ServiceType
from linkwright.messages.yaml_text import to_yaml


def definition_text(interface: Any) -> str:
    """The text of an interface file, as it is in the workspace; of one that comes with us, with comments of our own.

    Args:
        interface: a class, or a type name.

    Raises:
        InterfaceNotFoundError: there is none of this name.
    """
    return LIBRARY.source(interface if isinstance(interface, str) else interface.TYPE_NAME).text


def prototype(interface: Any, *, flow_style: bool = False) -> str:
    """The YAML of a message with all its defaults: the message itself, a service's request, or an action's goal.

    Args:
        interface: a class, or a type name.
        flow_style: as in `to_yaml`.

    Raises:
        InterfaceNotFoundError: there is none of this name.
    """
    cls = get_interface(interface) if isinstance(interface, str) else interface
    if issubclass(cls, ServiceType):
        cls = cls.Request
    elif issubclass(cls, ActionType):
        cls = cls.Goal
    return to_yaml(cls(), flow_style=flow_style)


def interface_names(kind: str) -> list[str]:
    """The type names of all messages (``msg``), services (``srv``) or actions (``action``) that are known, sorted.

    Those are the ones that come with Linkwright and those of the packages that the finder in force finds.
    """
    return LIBRARY.names(kind)
