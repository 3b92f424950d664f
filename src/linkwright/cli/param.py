"""``linkwright param``: read and change the parameters of running nodes."""

from __future__ import annotations

import argparse
import asyncio
import re
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import NoResponseError, find_node, list_node_names
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.output import write_output
from linkwright.cli.remote_parameters import TYPE_NAMES, RemoteParameters, parse_parameter, print_result
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session


_RESPONSE_TIMEOUT_S = 5.0
"""Seconds to wait for each node when all nodes are listed.

An unresponsive node does not block the others.
"""
_USAGE_ERROR = 2


def _add_node_arguments(parser: argparse.ArgumentParser, *, optional: bool = False) -> None:
    """Declare the arguments for the node and for the timeout."""
    add_session_arguments(parser)
    if optional:
        parser.add_argument(
            "node_name", metavar="NODE", nargs="?", help="the node, such as /robot_state_publisher (default: all nodes)"
        )
    else:
        parser.add_argument("node_name", metavar="NODE", help="the node, such as /robot_state_publisher")
    parser.add_argument(
        "--include-hidden-nodes", "-a", "--all", action="store_true", help="consider hidden nodes as well"
    )
    parser.add_argument(
        "--timeout", metavar="SECONDS", type=float, default=1.0, help="the time to wait for the node (default: 1)"
    )
    parser.add_argument(
        "--service-timeout", metavar="SECONDS", type=float, help="the time to wait for a response (default: no limit)"
    )


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``param list``."""
    _add_node_arguments(parser, optional=True)
    parser.add_argument(
        "--param-prefixes", metavar="PREFIX", nargs="+", default=[], help="list only parameters with these prefixes"
    )
    parser.add_argument("--param-type", action="store_true", help="print the type of each parameter")
    parser.add_argument("--filter", metavar="REGEX", help="list only names that match this regular expression")


def run_list(arguments: argparse.Namespace) -> int:
    """Print the parameter names, grouped by node."""
    try:
        pattern = re.compile(arguments.filter or "")
    except re.error as error:
        hint = phrase("names are matched as regular expressions; write '\\.' for a dot")
        raise LinkwrightError(
            Diagnostic(
                "CLI425",
                phrase(
                    "'{filter}' is not a regular expression: {error}", filter=arguments.filter, error=foreign(error)
                ),
                hint=hint,
            )
        ) from None

    async def job(session: Session) -> int:
        include_hidden = arguments.include_hidden_nodes
        if arguments.node_name is not None:
            node = await find_node(session, arguments.node_name, hidden=include_hidden, timeout=arguments.timeout)
            print(
                "\n".join(
                    await _format_list(RemoteParameters(session, node, arguments.service_timeout), arguments, pattern)
                )
            )
            return 0
        services = dict(session.node.get_service_names_and_types())
        nodes = [
            node
            for node in dict.fromkeys(list_node_names(session, hidden=include_hidden))
            if f"{node}/list_parameters" in services
        ]
        timeout = arguments.service_timeout or _RESPONSE_TIMEOUT_S
        requests = [_format_list(RemoteParameters(session, node, timeout), arguments, pattern) for node in nodes]
        failed = False
        for node, lines in zip(nodes, await asyncio.gather(*requests, return_exceptions=True), strict=True):
            if isinstance(lines, NoResponseError):
                failed = True
                print(f"Exception while calling service of node '{node}': {lines}", file=sys.stderr)
            elif isinstance(lines, BaseException):
                raise lines
            else:
                print("\n".join([f"{node}:", *lines]))
        return 1 if failed else 0

    return run_in_graph(arguments, job)


async def _format_list(
    parameters: RemoteParameters, arguments: argparse.Namespace, pattern: re.Pattern[str]
) -> list[str]:
    names = [name for name in await parameters.list_names(arguments.param_prefixes) if pattern.search(name)]
    if not arguments.param_type:
        return [f"  {name}" for name in names]
    descriptors = await parameters.get_descriptors(names)
    return [f"  {descriptor.name} (type: {TYPE_NAMES.get(descriptor.type, 'unknown')})" for descriptor in descriptors]


def configure_get(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``param get``."""
    _add_node_arguments(parser)
    parser.add_argument("parameter_name", metavar="NAME", help="the parameter's name")
    parser.add_argument("--hide-type", action="store_true", help="print only the value")


def run_get(arguments: argparse.Namespace) -> int:
    """Print the value of a parameter, as ros2 does."""
    from linkwright.graph.parameters.value_text import UNSET_TEXT, format_parameter_value

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        values = await parameters.get_values([arguments.parameter_name])
        if not values or values[0].type == 0:
            await parameters.check_declared([arguments.parameter_name])
            print(UNSET_TEXT)
            return 0
        print(format_parameter_value(values[0], hide_type=arguments.hide_type))
        return 0

    return run_in_graph(arguments, job)


def configure_describe(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``param describe``."""
    _add_node_arguments(parser)
    parser.add_argument("parameter_names", metavar="NAME", nargs="+", help="the parameters' names")


def run_describe(arguments: argparse.Namespace) -> int:
    """Print the descriptions of parameters, as ros2 does."""

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        await parameters.check_declared(arguments.parameter_names)
        for descriptor in await parameters.get_descriptors(arguments.parameter_names):
            print("\n".join(_format_description(descriptor)))
        return 0

    return run_in_graph(arguments, job)


def _format_description(descriptor: Any) -> list[str]:
    """Return the output lines of ``param describe`` for a ParameterDescriptor message."""
    lines = [f"Parameter name: {descriptor.name}", f"  Type: {TYPE_NAMES.get(descriptor.type, 'unknown')}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    for value_range in [*descriptor.floating_point_range, *descriptor.integer_range][:1]:
        lines += [f"    Min value: {value_range.from_value}", f"    Max value: {value_range.to_value}"]
        if value_range.step:
            lines.append(f"    Step: {value_range.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return lines


def configure_set(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``param set``."""
    _add_node_arguments(parser)
    parser.add_argument(
        "words", metavar="NAME VALUE", nargs="+", help="a parameter's name and its value in YAML; may be repeated"
    )
    parser.add_argument("--atomic", action="store_true", help="set all parameters or none")


def run_set(arguments: argparse.Namespace) -> int:
    """Set parameters of a node, and print the results."""
    words = arguments.words
    if len(words) % 2:
        text = f"Parameters must be provided as name/value pairs: name value [name value ...]. Got {len(words)} word(s)"
        print(f"linkwright param set: {text}", file=sys.stderr)
        return _USAGE_ERROR
    requested_parameters = [parse_parameter(name, value) for name, value in zip(words[::2], words[1::2], strict=True)]

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        if arguments.atomic:
            result = await parameters.set_together(requested_parameters)
            print_result(result, "Set parameters atomically successful", "Setting parameters atomically failed")
            return 0 if result.successful else 1
        results = await parameters.set(requested_parameters)
        for parameter, result in zip(requested_parameters, results, strict=True):
            prefix = f"{parameter.name}: " if len(requested_parameters) > 1 else ""
            print_result(result, f"{prefix}Set parameter successful", f"{prefix}Setting parameter failed")
        return 0 if all(result.successful for result in results) else 1

    return run_in_graph(arguments, job)


def configure_delete(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``param delete``."""
    _add_node_arguments(parser)
    parser.add_argument("parameter_name", metavar="NAME", help="the parameter's name")


def run_delete(arguments: argparse.Namespace) -> int:
    """Delete a parameter, and print whether it was deleted."""
    from linkwright.graph.parameters.parameter import Parameter, ParameterType

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        await parameters.check_declared([arguments.parameter_name])
        unset_parameter = Parameter(arguments.parameter_name, ParameterType.NOT_SET).to_parameter_msg()
        (result,) = await parameters.set([unset_parameter])
        print_result(result, "Deleted parameter successfully", "Deleting parameter failed")
        return 0 if result.successful else 1

    return run_in_graph(arguments, job)


def configure_dump(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``param dump``."""
    _add_node_arguments(parser)
    parser.add_argument(
        "--output-dir", metavar="FOLDER", help="write the file NODE.yaml to this folder instead of printing it"
    )
    parser.add_argument(
        "--print", action="store_true", help="accepted for compatibility with ros2; this is the default"
    )


def run_dump(arguments: argparse.Namespace) -> int:
    """Print the parameters of a node as a parameter file, or write the file."""

    async def job(session: Session) -> int:
        from linkwright.graph.parameters.files import format_parameter_file, plain_value

        parameters = await RemoteParameters.of(session, arguments)
        names = await parameters.list_names()
        values = await parameters.get_values(names) if names else []
        plain_values = {name: plain_value(value) for name, value in zip(names, values, strict=False)}
        text = format_parameter_file(parameters.node, plain_values)
        if arguments.output_dir is None:
            print(text)
            return 0
        file = Path(arguments.output_dir) / f"{parameters.node.strip('/').replace('/', '__')}.yaml"
        write_output(file, text)
        print(f"Saving to:  {file}")
        return 0

    return run_in_graph(arguments, job)


def configure_load(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``param load``."""
    _add_node_arguments(parser)
    parser.add_argument("parameter_file", metavar="FILE", help="a YAML file of parameters")
    parser.add_argument(
        "--no-use-wildcard", action="store_true", help="ignore parameters that the file sets for all nodes ('/**')"
    )
    parser.add_argument(
        "--use-wildcard", action="store_true", help="accepted for compatibility with ros2; this is the default"
    )


def run_load(arguments: argparse.Namespace) -> int:
    """Set the parameters in a parameter file, and print for each whether it was set."""
    from linkwright.graph.parameters.files import read_parameter_file
    from linkwright.graph.parameters.parameter import Parameter

    rules = read_parameter_file(arguments.parameter_file)

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        values = rules.for_node(parameters.node)
        if arguments.no_use_wildcard:
            node_values = dict(rules).get(parameters.node, {})
            values = {name: value for name, value in values.items() if name in node_values}
        if not values:
            nodes = [pattern for pattern, _ in rules]
            message = phrase(
                "Param file does not contain parameters for {node}, only for nodes: {nodes}",
                node=parameters.node,
                nodes=nodes,
            )
            raise LinkwrightError(Diagnostic("CLI426", message))
        requested_parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        results = await parameters.set(requested_parameters)
        for parameter, result in zip(requested_parameters, results, strict=True):
            name = parameter.name
            print_result(result, f"Set parameter {name} successful", f"Set parameter {name} failed")
        return 0 if all(result.successful for result in results) else 1

    return run_in_graph(arguments, job)


VERBS = {
    "delete": SubVerb(configure_delete, run_delete, help="delete a parameter, if the node allows it"),
    "describe": SubVerb(configure_describe, run_describe, help="describe parameters and the values that they accept"),
    "dump": SubVerb(configure_dump, run_dump, help="print all parameters of a node as a parameter file"),
    "get": SubVerb(configure_get, run_get, help="print the value of a parameter"),
    "list": SubVerb(configure_list, run_list, help="list the parameters of one node or of all nodes"),
    "load": SubVerb(configure_load, run_load, help="set the parameters of a node from a parameter file"),
    "set": SubVerb(configure_set, run_set, help="set parameters of a node"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
