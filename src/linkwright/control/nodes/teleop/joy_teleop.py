"""joy_teleop's joy_teleop, which turns buttons and axes of a joystick into messages, service calls and action goals.

The parameters of each command are below its name, as in teleop_tools: ``type`` (``topic``, ``service`` or ``action``),
``interface_type``, the name of the topic, service or action, the buttons and axes that activate the command, and its
values. A fixed message, a service call and a goal are sent once when the command becomes active; a message with
``axis_mappings`` is sent for each message of the joystick while it is active.

Deliberate differences: a command with an invalid parameter is logged, and the others work; and a negative number is
not a button or an axis.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph import ActionClient, Graph, Node
from linkwright.messages import get_action, get_message, get_service
from linkwright.messages.field_values import set_fields
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_QUEUE_DEPTH = 1
_DEFAULT_BUTTON = "default"
"""Activates a command while no button is pressed."""
_PATH_SEPARATOR = "-"


class _CommandError(Exception):
    """Raised for a command with an invalid parameter; the argument is a `Phrase`."""


class _Command(ABC):
    """A command of the joystick.

    Attributes:
        node: the node.
        name: the name of the command.
        values: its parameters; nested dictionaries represent names with dots.
        is_active: whether a button or an axis activates the command.
    """

    BUTTONS, AXES = "buttons", "axes"

    def __init__(self, node: Node, name: str, values: Mapping[str, Any]) -> None:
        self.node, self.name, self.values = node, name, values
        self.is_active = False
        self._buttons, self._axes = (list(values.get(key) or ()) for key in (self.BUTTONS, self.AXES))
        if not self._buttons and not self._axes:
            self._buttons = [_DEFAULT_BUTTON]

    def read(self, key: str) -> str:
        """Return a required parameter."""
        value = self.values.get(key)
        if not isinstance(value, str) or not value:
            raise _CommandError(phrase("the command '{name}' needs '{key}'", name=self.name, key=key))
        return value

    def update(self, joy: Any) -> None:
        """Update whether the command is active, and run it."""
        was_active = self.is_active
        pressed = any(
            not any(joy.buttons) if button == _DEFAULT_BUTTON else _get(joy.buttons, int(button)) == 1
            for button in self._buttons
        )
        self.is_active = pressed or any(_get(joy.axes, int(axis)) == 1.0 for axis in self._axes)
        if self.is_active:
            self.run(joy, is_new=not was_active)

    @abstractmethod
    def run(self, joy: Any, *, is_new: bool) -> None:
        """Run the active command; `is_new` tells whether it has just become active."""


class _TopicCommand(_Command):
    """A command that publishes a fixed message, or one whose fields follow axes and buttons."""

    BUTTONS, AXES = "deadman_buttons", "deadman_axes"

    def __init__(self, node: Node, name: str, values: Mapping[str, Any]) -> None:
        super().__init__(node, name, values)
        self._type = get_message(self.read("interface_type"))
        fixed, self._mappings = (values.get(key) or {} for key in ("message_value", "axis_mappings"))
        if bool(fixed) == bool(self._mappings):
            raise _CommandError(
                phrase("the command '{name}' needs either 'message_value' or 'axis_mappings'", name=name)
            )
        self._fixed = self._type() if fixed else None
        for target, value in fixed.items():
            self._set(self._fixed, target, value.get("value") if isinstance(value, Mapping) else value)
        for target, mapping in self._mappings.items():
            self._check(target, mapping)
        self._publisher = node.create_publisher(self._type, self.read("topic_name"), _QUEUE_DEPTH)
        self._logged: set[str] = set()

    def _check(self, target: str, mapping: Any) -> None:
        """Raise an error for an incomplete mapping."""
        keys = mapping if isinstance(mapping, Mapping) else {}
        if not {"axis", "button", "value"} & keys.keys():
            raise _CommandError(
                phrase(
                    "the field '{target}' of the command '{name}' needs 'axis', 'button' or 'value'",
                    target=target,
                    name=self.name,
                )
            )
        for key in ("offset", "scale"):
            if "axis" in keys and key not in keys:
                raise _CommandError(
                    phrase(
                        "the field '{target}' of the command '{name}' has an 'axis', and also needs '{key}'",
                        target=target,
                        name=self.name,
                        key=key,
                    )
                )
        self._set(self._type(), target, keys.get("value", 0.0))

    def _set(self, message: Any, target: str, value: Any) -> None:
        """Set a field of a message; the names in the path of a nested field are joined by ``-``."""
        *parents, leaf = target.split(_PATH_SEPARATOR)
        try:
            for parent in parents:
                message = getattr(message, parent)
            set_fields(message, {leaf: value})
        except (AttributeError, TypeError) as error:
            raise _CommandError(
                phrase(
                    "the command '{name}' cannot set the field '{target}' of {type}: {reason}",
                    name=self.name,
                    target=target,
                    type=self.read("interface_type"),
                    reason=error.diagnostics[0].message if isinstance(error, LinkwrightError) else str(error),
                )
            ) from error

    def run(self, joy: Any, *, is_new: bool) -> None:
        """Publish the message."""
        if self._fixed is not None and not is_new:
            return
        message = self._type() if self._fixed is None else self._fixed
        for target, mapping in self._mappings.items():
            self._set(message, target, self._compute(mapping, joy))
        if hasattr(message, "header"):
            message.header.stamp = self.node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _compute(self, mapping: Mapping[str, Any], joy: Any) -> Any:
        """Return the value of a field; 0 if the joystick has no such axis or button, which is logged once."""
        for key, values in (("axis", joy.axes), ("button", joy.buttons)):
            if key not in mapping:
                continue
            value = _get(values, int(mapping[key]))
            if value is not None:
                return value * float(mapping.get("scale", 1.0)) + float(mapping.get("offset", 0.0))
            if key not in self._logged:
                self._logged.add(key)
                message = phrase(
                    "the joystick has no {kind} {number}, which the command '{name}' uses",
                    kind=key,
                    number=mapping[key],
                    name=self.name,
                )
                self.node.get_logger().error(message)
            return 0.0
        return mapping["value"]


class _RequestCommand(_Command):
    """A command that sends a request when it becomes active, or when the server appears meanwhile."""

    def __init__(self, node: Node, name: str, values: Mapping[str, Any]) -> None:
        super().__init__(node, name, values)
        self._is_ready = False
        self._client, self._request, self._send = self.create_client()

    @abstractmethod
    def create_client(self) -> tuple[Callable[[], bool], Any, Callable[[Any], Any]]:
        """Return a function that tells whether the server is ready, the request, and a function that sends it."""

    def fill(self, request: Any, key: str) -> Any:
        """Return a request with the values of a parameter."""
        try:
            set_fields(request, self.values.get(key) or {})
        except LinkwrightError as error:
            raise _CommandError(error.diagnostics[0].message) from error
        return request

    def run(self, joy: Any, *, is_new: bool) -> None:
        """Send the request, unless it was already sent."""
        was_ready, self._is_ready = self._is_ready, self._client()
        if self._is_ready and (is_new or not was_ready):
            self._send(self._request)


class _ServiceCommand(_RequestCommand):
    """A command that calls a service."""

    def create_client(self) -> tuple[Callable[[], bool], Any, Callable[[Any], Any]]:
        """Return the functions of a client of the service, and the request."""
        service = get_service(self.read("interface_type"))
        request = self.fill(service.Request(), "service_request")
        client = self.node.create_client(service, self.read("service_name"))
        return client.service_is_ready, request, client.call_async


class _ActionCommand(_RequestCommand):
    """A command that sends a goal to an action server."""

    def create_client(self) -> tuple[Callable[[], bool], Any, Callable[[Any], Any]]:
        """Return the functions of a client of the action, and the goal."""
        action = get_action(self.read("interface_type"))
        goal = self.fill(action.Goal(), "action_goal")
        client = ActionClient(self.node, action, self.read("action_name"))
        return client.server_is_ready, goal, client.send_goal_async


_KINDS: Mapping[str, type[_Command]] = {"topic": _TopicCommand, "service": _ServiceCommand, "action": _ActionCommand}


class JoyTeleop(SingleNode):
    """The running joy_teleop."""

    DEFAULT_NAME = "joy_teleop"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        with handle_start_errors(self._node):
            self._start()

    def _start(self) -> None:
        """Create the commands, and subscribe to the joystick."""
        node = self._node
        self._commands: list[_Command] = []
        for name, values in sorted(_nest(node).items()):
            if not isinstance(values, Mapping) or "type" not in values:
                continue
            try:
                self._commands.append(_create_command(node, name, values))
            except (_CommandError, LinkwrightError) as error:
                message = error.diagnostics[0].message if isinstance(error, LinkwrightError) else error.args[0]
                node.get_logger().error(message)
        if not self._commands:
            node.get_logger().warning(
                phrase("joy_teleop has no commands: set them in a parameter file, each below its name with 'type'")
            )
        node.create_subscription(get_message("sensor_msgs/msg/Joy"), "joy", self._on_joy, _QUEUE_DEPTH)

    def _on_joy(self, joy: Any) -> None:
        for command in self._commands:
            command.update(joy)


def _create_command(node: Node, name: str, values: Mapping[str, Any]) -> _Command:
    kind = _KINDS.get(str(values["type"]))
    if kind is None:
        raise _CommandError(
            phrase(
                "the command '{name}' has the type '{kind}', but the types are topic, service and action",
                name=name,
                kind=values["type"],
            )
        )
    return kind(node, name, values)


def _nest(node: Node) -> dict[str, Any]:
    """Return the parameters of a node as nested dictionaries."""
    nested: dict[str, Any] = {}
    for name, parameter in node.get_parameters_by_prefix("").items():
        *parents, leaf = name.split(".")
        values = nested
        for parent in parents:
            child = values.setdefault(parent, {})
            values = child if isinstance(child, dict) else {}
        values[leaf] = parameter.value
    return nested


def _get(values: Sequence[Any], number: int) -> Any:
    """Return the value of a button or axis, or None if the joystick has none with this number."""
    return values[number] if 0 <= number < len(values) else None
