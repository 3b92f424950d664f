"""``linkwright param describe``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from linkwright.cli.param.access import TYPE_NAMES, RemoteParameters
from linkwright.cli.param.arguments import add_node_arguments
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "say what parameters are for and which values they take"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument("parameter_names", metavar="NAME", nargs="+", help="the parameters' names")


def run(arguments: argparse.Namespace) -> int:
    """Print what the node says of them, as ros2 does."""

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        await parameters.must_have(arguments.parameter_names)
        for descriptor in await parameters.descriptors(arguments.parameter_names):
            print("\n".join(describe(descriptor)))
        return 0

    return run_in_graph(arguments, job)


def describe(descriptor: Any) -> list[str]:
    """What is printed of a rcl_interfaces/msg/ParameterDescriptor."""
    lines = [f"Parameter name: {descriptor.name}", f"  Type: {TYPE_NAMES.get(descriptor.type, 'unknown')}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    for given in [*descriptor.floating_point_range, *descriptor.integer_range][:1]:
        lines += [f"    Min value: {given.from_value}", f"    Max value: {given.to_value}"]
        if given.step:
            lines.append(f"    Step: {given.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return lines
