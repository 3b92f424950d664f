"""``linkwright param delete``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.param.access import RemoteParameters, print_result
from linkwright.cli.param.arguments import add_node_arguments
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "delete a parameter that the node lets go"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument("parameter_name", metavar="NAME", help="the parameter's name")


def run(arguments: argparse.Namespace) -> int:
    """Delete it, and say whether it was."""
    from linkwright.graph.parameters.parameter import Parameter, ParameterType

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        await parameters.must_have([arguments.parameter_name])
        nothing = Parameter(arguments.parameter_name, ParameterType.NOT_SET).to_parameter_msg()
        (result,) = await parameters.set([nothing])
        print_result(result, "Deleted parameter successfully", "Deleting parameter failed")
        return 0 if result.successful else 1

    return run_in_graph(arguments, job)
