"""``linkwright param load``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.param.access import RemoteParameters, print_result
from linkwright.cli.param.arguments import add_node_arguments
from linkwright.cli.session import run_in_graph
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "set the parameters of a node that a parameter file gives it"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument("parameter_file", metavar="FILE", help="a YAML file of parameters")
    parser.add_argument(
        "--no-use-wildcard", action="store_true", help="leave out what the file gives to all nodes ('/**')"
    )
    parser.add_argument("--use-wildcard", action="store_true", help="accepted for ros2's sake; that is what is done")


def run(arguments: argparse.Namespace) -> int:
    """Set them, and say of each whether it was."""
    from linkwright.graph.parameters.files import read_parameter_file
    from linkwright.graph.parameters.parameter import Parameter

    rules = read_parameter_file(arguments.parameter_file)

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        values = rules.for_node(parameters.node)
        if arguments.no_use_wildcard:
            named = dict(rules).get(parameters.node, {})
            values = {name: value for name, value in values.items() if name in named}
        if not values:
            nodes = [pattern for pattern, _ in rules]
            message = phrase(
                "Param file does not contain parameters for {node}, only for nodes: {nodes}",
                node=parameters.node,
                nodes=nodes,
            )
            raise LinkwrightError(Diagnostic("CLI426", message))
        wanted = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        results = await parameters.set(wanted)
        for parameter, result in zip(wanted, results, strict=True):
            name = parameter.name
            print_result(result, f"Set parameter {name} successful", f"Set parameter {name} failed")
        return 0 if all(result.successful for result in results) else 1

    return run_in_graph(arguments, job)
