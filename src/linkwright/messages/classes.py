"""Makes the classes of messages, services and actions, each once, when it is first asked for."""

from __future__ import annotations

import threading
from importlib import import_module
from typing import Any, cast

from linkwright.messages.class_code import build_class
from linkwright.messages.definitions.interfaces import (
    Action,
    Definition,
    Service,
    Structure,
    event_of,
    feedback_message_of,
    get_result_of,
    send_goal_of,
)
from linkwright.messages.definitions.library import LIBRARY, not_of_kind
from linkwright.messages.definitions.names import python_module
from linkwright.messages.errors import InterfaceNotFoundError
from linkwright.messages.message import ActionImplementation, ActionType, DurationValue, Message, ServiceType, TimeValue

_classes: dict[str, Any] = {}
_lock = threading.RLock()

_BASES: dict[str, type[Message]] = {
    "builtin_interfaces/msg/Time": TimeValue,
    "builtin_interfaces/msg/Duration": DurationValue,
}
"""Classes that can do more than hold their fields."""

_WRITTEN_BY_HAND = {"tf2_msgs/msg/TFMessage": "linkwright.messages.tf_message"}
"""The modules of classes that are not made from their definitions; this one imports numpy."""


def get_message(name: str) -> type[Any]:
    """The class of a message, or of a part of a service or action (``std_srvs/srv/SetBool_Request``).

    Args:
        name: ``sensor_msgs/msg/JointState`` or ``sensor_msgs/JointState``.

    Raises:
        InterfaceNotFoundError: MSG101 with the nearest names, MSG102 for a text that is not a name.
        DefinitionError: the interface file in the workspace has mistakes.
    """
    return _named(name, Message, "msg")


def get_service(name: str) -> type[Any]:
    """The class of a service, with `Request` and `Response`; names and errors as `get_message`."""
    return _named(name, ServiceType, "srv")


def get_action(name: str) -> type[Any]:
    """The class of an action, with `Goal`, `Result`, `Feedback` and `Impl`; names and errors as `get_message`."""
    return _named(name, ActionType, "action")


def get_interface(name: str) -> type[Any]:
    """The class of a message, service or action; of ``package/Name`` the first of these that there is."""
    return cast("type[Any]", _classes.get(name) or _made(LIBRARY.definition(name)))


def class_of(structure: Structure) -> type[Any]:
    """The class of a structure."""
    return cast("type[Any]", _made(structure))


def add_class(message_class: type[Message]) -> None:
    """Register a class that was written by hand for its type."""
    _classes[message_class.TYPE_NAME] = message_class


def _named(name: str, base: type, kind: str) -> type[Any]:
    found = _classes.get(name)
    if found is None:
        # Parts of services and actions are named after these: a message may be 'std_srvs/srv/SetBool_Request'.
        found = _made(LIBRARY.definition(name, *(() if name.count("/") == 2 else (kind,))))
    if not issubclass(found, base):
        raise InterfaceNotFoundError(not_of_kind(LIBRARY.definition(name), kind))
    return cast("type[Any]", found)


def _made(definition: Definition) -> Any:
    found = _classes.get(definition.type_name)
    if found is None:
        with _lock:
            found = _classes.get(definition.type_name)
            if found is None:
                found = _classes[definition.type_name] = _make(definition)
    return found


def _make(definition: Definition) -> type:
    if isinstance(definition, Structure):
        return _make_message(definition)
    if isinstance(definition, Service):
        return _make_service(definition)
    return _make_action(definition)


def _make_message(structure: Structure) -> type:
    parts = {name: _made(LIBRARY.structure(name)) for name in structure.references}
    if structure.type_name in _WRITTEN_BY_HAND:
        import_module(_WRITTEN_BY_HAND[structure.type_name])  # calls `add_class`
        return cast("type", _classes[structure.type_name])
    base = _BASES.get(structure.type_name, Message)
    return build_class(structure, base, parts, python_module(structure.type_name))


def _make_service(service: Service) -> type:
    name = service.type_name
    return type(
        name.rpartition("/")[2],
        (ServiceType,),
        {
            "__module__": python_module(name),
            "__doc__": f"Service class '{name.rpartition('/')[2]}'.",
            "TYPE_NAME": name,
            "Request": _made(service.request),
            "Response": _made(service.response),
            "Event": _LazyClass(event_of(service)),
        },
    )


def _make_action(action: Action) -> type:
    name = action.type_name
    implementation = type(
        "Impl",
        (ActionImplementation,),
        {
            "SendGoalService": _made(send_goal_of(action)),
            "GetResultService": _made(get_result_of(action)),
            "FeedbackMessage": _made(feedback_message_of(action)),
            "CancelGoalService": get_service("action_msgs/srv/CancelGoal"),
            "GoalStatusMessage": get_message("action_msgs/msg/GoalStatusArray"),
        },
    )
    return type(
        name.rpartition("/")[2],
        (ActionType,),
        {
            "__module__": python_module(name),
            "__doc__": f"Action class '{name.rpartition('/')[2]}'.",
            "TYPE_NAME": name,
            "Goal": _made(action.goal),
            "Result": _made(action.result),
            "Feedback": _made(action.feedback),
            "Impl": implementation,
        },
    )


class _LazyClass:
    """A class attribute with a message class, made on first access."""

    def __init__(self, structure: Structure) -> None:
        self._structure = structure

    def __get__(self, instance: object, owner: type) -> type:
        return cast("type", _made(self._structure))


Message._class_named = staticmethod(get_message)
Message._class_of = staticmethod(class_of)
