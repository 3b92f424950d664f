"""``linkwright param get``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.param.access import RemoteParameters
from linkwright.cli.param.arguments import add_node_arguments
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print the value of a parameter"

_LABELS = {
    1: ("Boolean value is:", "bool_value"),
    2: ("Integer value is:", "integer_value"),
    3: ("Double value is:", "double_value"),
    4: ("String value is:", "string_value"),
    5: ("Byte values are:", "byte_array_value"),
    6: ("Boolean values are:", "bool_array_value"),
    7: ("Integer values are:", "integer_array_value"),
    8: ("Double values are:", "double_array_value"),
    9: ("String values are:", "string_array_value"),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument("parameter_name", metavar="NAME", help="the parameter's name")
    parser.add_argument("--hide-type", action="store_true", help="print the value alone")


def run(arguments: argparse.Namespace) -> int:
    """Print the value, as ros2 does."""

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        values = await parameters.values([arguments.parameter_name])
        if not values or values[0].type == 0:
            await parameters.must_have([arguments.parameter_name])
            print("Parameter not set.")
            return 0
        label, field = _LABELS[values[0].type]
        value = getattr(values[0], field)
        print(value if arguments.hide_type else f"{label} {value}")
        return 0

    return run_in_graph(arguments, job)
