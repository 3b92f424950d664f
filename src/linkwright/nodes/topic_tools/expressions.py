"""transform and relay_field of topic_tools: compute messages with Python expressions.

As in topic_tools, the expressions are not restricted, because the author of a command line or a launch file can run
programs anyway. Expressions can use the modules that ``--import`` names. If one of the names is that of a message
package, the expressions can use the package's types, such as ``std_msgs.msg.String``.
"""

from __future__ import annotations

import argparse
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from importlib import import_module
from os import getpid
from typing import Any, ClassVar, NoReturn

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import (
    SENSOR_DATA_QOS,
    DurabilityPolicy,
    Graph,
    HistoryPolicy,
    Publisher,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    Subscription,
)
from linkwright.graph.qos.compatibility import fit_profile
from linkwright.messages import get_message, interface_names, set_fields
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import get_arguments


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        hint = phrase("usage: {usage}", usage=" ".join(self.format_usage().removeprefix("usage: ").split()))
        raise LinkwrightError(Diagnostic("NODE432", phrase("{problem}", problem=foreign(message)), hint=hint))


class _ExpressionTool(SingleNode, ABC):
    """The base class of nodes that compute an output message from each input message.

    Raises:
        LinkwrightError: an argument (NODE432) or the expression (NODE434) is invalid.
    """

    _output_class: Any

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._graph = graph
        self._arguments = self._create_parser().parse_args(get_arguments(options))
        self._node, _ = create_node(graph, options, f"{self.PROGRAM}_{getpid()}")
        self._publisher: Publisher[Any] | None = None
        self._subscription: Subscription[Any] | None = None
        with handle_start_errors(self._node):
            self._output_class = _import_message_class(self._arguments.output_type)
            self._prepare()
        self._graph_changed = self._node.create_guard_condition(self._subscribe_when_available)
        graph.watch(self._graph_changed.trigger)
        self._subscribe_when_available()

    PROGRAM: ClassVar[str]

    def close(self) -> None:
        """Close the node."""
        self._graph.unwatch(self._graph_changed.trigger)
        super().close()

    @abstractmethod
    def _prepare(self) -> None:
        """Compile the expressions from the command line."""

    @abstractmethod
    def _convert(self, message: Any) -> Any:
        """Return the message to publish for an input message."""

    def _create_parser(self) -> argparse.ArgumentParser:
        parser = _Parser(prog=self.PROGRAM, add_help=False)
        for name in ("input", "output_topic", "output_type"):
            parser.add_argument(name)
        parser.add_argument("--wait-for-start", action="store_true")
        parser.add_argument("--qos-profile", choices=QoSPresetProfiles.short_keys())
        parser.add_argument("--qos-depth", type=int)
        for name, kind in (
            ("history", HistoryPolicy),
            ("reliability", ReliabilityPolicy),
            ("durability", DurabilityPolicy),
        ):
            parser.add_argument(f"--qos-{name}", choices=kind.short_keys())
        return parser

    def _subscribe_when_available(self) -> None:
        sources = self._node.get_publishers_info_by_topic(self._arguments.input)
        if self._subscription is None and sources:
            qos = self._choose_profile([source.qos_profile for source in sources])
            self._publisher = self._node.create_publisher(self._output_class, self._arguments.output_topic, qos)
            self._subscription = self._node.create_subscription(
                sources[0].topic_type, self._arguments.input, self._receive, qos
            )

    def _choose_profile(self, offers: list[QoSProfile]) -> QoSProfile:
        overrides = {
            name: getattr(self._arguments, f"qos_{name}") for name in ("depth", "history", "reliability", "durability")
        }
        if self._arguments.qos_profile is None and not any(overrides.values()):
            return fit_profile(SENSOR_DATA_QOS, offers).profile
        base = QoSPresetProfiles.get_from_short_key(self._arguments.qos_profile or "sensor_data")
        return QoSProfile(
            overrides["depth"] or base.depth,
            ReliabilityPolicy[overrides["reliability"].upper()] if overrides["reliability"] else base.reliability,
            DurabilityPolicy[overrides["durability"].upper()] if overrides["durability"] else base.durability,
            HistoryPolicy[overrides["history"].upper()] if overrides["history"] else base.history,
        )

    def _receive(self, message: Any) -> None:
        try:
            output = self._convert(message)
        except Exception as error:  # noqa: BLE001 - the user's expression may raise any exception
            self._node.get_logger().error(
                f"{self._arguments.expression}: {type(error).__name__}: {error}", throttle_duration_sec=5.0
            )
            return
        if self._publisher is not None:
            self._publisher.publish(output)


class Transform(_ExpressionTool):
    """The running transform node, which evaluates one expression for each message.

    In the expression, ``m`` is the message or one of its fields.
    """

    PROGRAM = "transform"

    def _create_parser(self) -> argparse.ArgumentParser:
        parser = super()._create_parser()
        parser.add_argument("expression", nargs="?", default="m")
        parser.add_argument("-i", "--import", dest="modules", nargs="+", default=["numpy"])
        parser.add_argument("--field")
        return parser

    def _prepare(self) -> None:
        self._field = [name for name in (self._arguments.field or "").split(".") if name]
        names = {name: _import_name(name) for name in self._arguments.modules}
        self._expression = _compile_expression(
            self._arguments.expression, {name.partition(".")[0]: names[name] for name in names}
        )

    def _convert(self, message: Any) -> Any:
        for name in self._field:
            message = getattr(message, name)
        output = self._expression(message)
        if isinstance(output, self._output_class):
            return output
        if isinstance(output, Mapping):
            result = self._output_class()
            set_fields(result, output)
            return result
        raise TypeError(f"the expression gives a {type(output).__name__}, not a {self._arguments.output_type}")


class RelayField(_ExpressionTool):
    """The running relay_field node, which computes the fields of each message.

    The fields are YAML. Each string in it is an expression, in which ``m`` is the input message.
    """

    PROGRAM = "relay_field"

    def _create_parser(self) -> argparse.ArgumentParser:
        parser = super()._create_parser()
        parser.add_argument("expression")
        return parser

    def _prepare(self) -> None:
        try:
            fields = yaml.safe_load(self._arguments.expression)
        except yaml.YAMLError as error:
            raise _parse_error(self._arguments.expression, error) from None
        if not isinstance(fields, dict):
            raise _parse_error(self._arguments.expression, "it is not a mapping of fields")
        self._fields = {name: _compile_value(value) for name, value in fields.items()}

    def _convert(self, message: Any) -> Any:
        result = self._output_class()
        stamps = set_fields(
            result,
            {name: value(message) for name, value in self._fields.items()},
            expand_header_auto=True,
            expand_time_now=True,
        )
        now = self._node.get_clock().now().to_msg()
        for stamp in stamps:
            stamp(now)
        return result


class _PackageTypes:
    """A message package as an object in expressions, for types such as ``std_msgs.msg.String``."""

    def __init__(self, package: str) -> None:
        self.msg = _Messages(package)


class _Messages:
    def __init__(self, package: str) -> None:
        self._package = package

    def __getattr__(self, name: str) -> Any:
        return get_message(f"{self._package}/msg/{name}")


def _import_name(name: str) -> Any:
    package = name.partition(".")[0]
    if any(interface_name.startswith(f"{package}/msg/") for interface_name in interface_names("msg")):
        return _PackageTypes(package)
    try:
        module = import_module(name)
    except ImportError as error:
        raise _parse_error(f"--import {name}", error) from None
    return import_module(package) if package != name else module


def _compile_value(value: Any) -> Callable[[Any], Any]:
    """Compile a YAML value to a function of the input message.

    A string is an expression, or a literal string if it is not a valid expression.
    """
    if isinstance(value, dict):
        fields = {name: _compile_value(compute) for name, compute in value.items()}
        return lambda message: {name: compute(message) for name, compute in fields.items()}
    if not isinstance(value, str):
        return lambda message: value  # noqa: ARG005  # the value is the same for all messages
    try:
        expression = _compile_expression(value, {})
    except LinkwrightError:
        return lambda message: value  # noqa: ARG005  # the value is the same for all messages

    def evaluate(message: Any) -> Any:
        try:
            return expression(message)
        except NameError:
            return value

    return evaluate


def _compile_expression(text: str, names: Mapping[str, Any]) -> Callable[[Any], Any]:
    try:
        function: Callable[[Any], Any] = eval(f"lambda m: ({text})", dict(names))  # noqa: S307 - see the module
    except SyntaxError as error:
        raise _parse_error(text, error.msg) from None
    return function


def _import_message_class(name: str) -> Any:
    package, _, type_name = name.replace("/msg/", "/").partition("/")
    return get_message(f"{package}/msg/{type_name}")


def _parse_error(text: str, reason: object) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic("NODE434", phrase("'{text}' cannot be parsed: {reason}", text=text, reason=foreign(reason)))
    )
