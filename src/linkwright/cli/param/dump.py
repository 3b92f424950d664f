"""``linkwright param dump``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.output import write_output
from linkwright.cli.param.access import RemoteParameters
from linkwright.cli.param.arguments import add_node_arguments
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print all parameters of a node as a parameter file"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument("--output-dir", metavar="FOLDER", help="write the file NODE.yaml there instead")
    parser.add_argument("--print", action="store_true", help="accepted for ros2's sake; that is what is done")


def run(arguments: argparse.Namespace) -> int:
    """Print the file or write it."""

    async def job(session: Session) -> int:
        from linkwright.graph.parameters.file_text import parameter_file_text, plain_value

        parameters = await RemoteParameters.of(session, arguments)
        names = await parameters.names()
        values = await parameters.values(names) if names else []
        plain = {name: plain_value(value) for name, value in zip(names, values, strict=False)}
        text = parameter_file_text(parameters.node, plain)
        if arguments.output_dir is None:
            print(text)
            return 0
        file = Path(arguments.output_dir) / f"{parameters.node.strip('/').replace('/', '__')}.yaml"
        write_output(file, text)
        print(f"Saving to:  {file}")
        return 0

    return run_in_graph(arguments, job)
