"""Texts of interfaces for display: definitions, and templates to fill in."""

from __future__ import annotations

from typing import Any

from linkwright.messages.classes import get_interface
from linkwright.messages.definitions.library import LIBRARY
from linkwright.messages.message import ActionType, ServiceType
from linkwright.messages.yaml_text import to_yaml


def definition_text(interface: Any) -> str:
    """Return the text of an interface file.

    The comments in files that come with Linkwright differ from ROS's.

    Args:
        interface: a class, or a type name.

    Raises:
        InterfaceNotFoundError: there is no interface with this name.
    """
    return LIBRARY.source(interface if isinstance(interface, str) else interface.TYPE_NAME).text


def prototype(interface: Any, *, flow_style: bool = False) -> str:
    """Return a message, a service request or an action goal with default values, as YAML.

    Args:
        interface: a class, or a type name.
        flow_style: as in `to_yaml`.

    Raises:
        InterfaceNotFoundError: there is no interface with this name.
    """
    cls = get_interface(interface) if isinstance(interface, str) else interface
    if issubclass(cls, ServiceType):
        cls = cls.Request
    elif issubclass(cls, ActionType):
        cls = cls.Goal
    return to_yaml(cls(), flow_style=flow_style)


def interface_names(kind: str) -> list[str]:
    """Return the sorted type names of all available interfaces of one kind.

    These come with Linkwright, or are in the packages that the active finder finds.

    Args:
        kind: ``msg``, ``srv`` or ``action``.
    """
    return LIBRARY.names(kind)
