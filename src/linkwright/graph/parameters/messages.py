"""The interfaces of rcl_interfaces: services, descriptors and results; classes are built when they are first used."""

from __future__ import annotations

from functools import cache
from typing import Any

from linkwright.graph.parameters.parameter import Range


@cache
def service_type(service: str) -> str:
    """The type of one of a node's parameter services: ``rcl_interfaces/srv/GetParameters`` of ``get_parameters``."""
    return "rcl_interfaces/srv/" + "".join(word.capitalize() for word in service.split("_"))


def interface(name: str) -> Any:
    """A message class of rcl_interfaces."""
    from linkwright.messages import get_message

    return get_message(f"rcl_interfaces/msg/{name}")


def descriptor_message(descriptor: Any) -> Any:
    """A descriptor as an rcl_interfaces/msg/ParameterDescriptor; one that is such a message stays itself."""
    message_class = interface("ParameterDescriptor")
    if isinstance(descriptor, message_class):
        return descriptor
    message = message_class(
        name=descriptor.name,
        type=descriptor.type,
        description=descriptor.description,
        additional_constraints=descriptor.additional_constraints,
        read_only=descriptor.read_only,
        dynamic_typing=descriptor.dynamic_typing,
    )
    message.integer_range = [_range("IntegerRange", each, int) for each in descriptor.integer_range]
    message.floating_point_range = [
        _range("FloatingPointRange", each, float) for each in descriptor.floating_point_range
    ]
    return message


def result_message(verdict: Any) -> Any:
    """A result as an rcl_interfaces/msg/SetParametersResult; one that is such a message stays itself."""
    message_class = interface("SetParametersResult")
    if isinstance(verdict, message_class):
        return verdict
    return message_class(successful=verdict.successful, reason=verdict.reason)


def _range(name: str, given: Range, kind: type) -> Any:
    return interface(name)(from_value=kind(given.from_value), to_value=kind(given.to_value), step=kind(given.step))
