"""Declare parameters that are required or set by command-line arguments."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.graph import Node, Parameter, ParameterType
from linkwright.graph.command_line.ros_arguments import parse
from linkwright.nodes.options import NodeOptions

_COMMON_PREFIXES = ("qos_overrides.", "start_type_description_service", "strict_callback_groups", "diagnostic_updater.")
"""The prefixes of parameters that may be set for any node, even if the node does not read them."""


def declare_required(node: Node, name: str, kind: ParameterType, usage: str) -> Any:
    """Declare a parameter without a default, and return its value.

    Args:
        node: the node that declares the parameter.
        name: the name of the parameter.
        kind: the type of the parameter.
        usage: a command line that starts the node, for the hint.

    Raises:
        LinkwrightError: NODE431, the parameter is not set; GRAPH201, the value has another type.
    """
    node.declare_parameter(name, kind)
    value = node.get_parameter_or(name, Parameter(name)).value
    if value is None:
        message = phrase("parameter '{name}' of '{node}' is not set", name=name, node=node.get_name())
        raise LinkwrightError(Diagnostic("NODE431", message, hint=phrase("usage: {usage}", usage=usage)))
    return value


def options_from_arguments(
    options: NodeOptions, arguments: Sequence[str], names: Mapping[str, Callable[[str], Any]], usage: str
) -> NodeOptions:
    """Return the options with the parameters that command-line arguments set.

    Args:
        options: the options of the node.
        arguments: the arguments without ROS arguments.
        names: the parameters that the arguments set, in order, each with its converter; later arguments may be omitted.
        usage: a command line that starts the node, for the hint.

    Raises:
        LinkwrightError: NODE432, an argument is not a value of its parameter, or there are more arguments than names.
    """
    hint = phrase("usage: {usage}", usage=usage)
    if len(arguments) > len(names):
        message = phrase("unexpected argument '{argument}'", argument=arguments[len(names)])
        raise LinkwrightError(Diagnostic("NODE432", message, hint=hint))
    argument_values = {
        name: _convert_argument(argument, name, names[name], hint)
        for argument, name in zip(arguments, names, strict=False)
    }
    return replace(options, parameters={**options.parameters, **argument_values})


def _convert_argument(argument: str, name: str, convert: Callable[[str], Any], hint: Phrase) -> Any:
    try:
        return convert(argument)
    except ValueError:
        message = phrase("'{text}' is not a valid value for '{name}'", text=argument, name=name)
        raise LinkwrightError(Diagnostic("NODE432", message, hint=hint)) from None


def get_arguments(options: NodeOptions) -> list[str]:
    """Return the command-line arguments of a node that are not ROS arguments."""
    return parse(options.arguments).non_ros_arguments


def check_positive(node: Node, name: str, value: float) -> float:
    """Return the value of a parameter after checking that it is greater than zero.

    Raises:
        LinkwrightError: NODE433, the value is not greater than zero.
    """
    if not value > 0:
        raise invalid_value_error(name, value, node.get_name())
    return value


def invalid_value_error(name: str, value: object, node: str, choices: Sequence[str] = ()) -> LinkwrightError:
    """Return the error NODE433 for an invalid value of a parameter."""
    message = phrase("parameter '{name}' of '{node}' cannot be '{value}'", name=name, node=node, value=value)
    hint = None
    if choices:
        hint = did_you_mean(str(value), choices) or phrase("choose from {names}", names=", ".join(choices))
    return LinkwrightError(Diagnostic("NODE433", message, hint=hint))


def log_unknown_parameters(node: Node) -> None:
    """Log the parameters that are set but not declared.

    This must be called after all declarations.

    A name that looks misspelled causes a warning. Other names are logged only as information, because parameters for
    all nodes of a launch (``/**``) also reach nodes that do not have them.
    """
    declared_names = node.parameter_names()
    undeclared_names = [name for name in node.undeclared_overrides() if not name.startswith(_COMMON_PREFIXES)]
    logger = node.get_logger()
    unread_names = []
    for name in undeclared_names:
        hint = did_you_mean(name, declared_names)
        if hint is None:
            unread_names.append(name)
        else:
            logger.warning(f"'{name}' is not a parameter of this node; {hint}")
    if unread_names:
        logger.info(f"parameters that this node does not have are ignored: {', '.join(unread_names)}")
