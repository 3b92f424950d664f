"""``linkwright param dump``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.cli.output import write_output
from linkwright.cli.param.access import RemoteParameters, plain_value
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
        import yaml

        parameters = await RemoteParameters.of(session, arguments)
        names = await parameters.names()
        values = await parameters.values(names) if names else []
        tree: dict[str, Any] = {}
        for name, value in zip(names, values, strict=False):
            _insert(tree, name.split("."), plain_value(value))
        text = yaml.dump({parameters.node: {"ros__parameters": tree}}, default_flow_style=False, allow_unicode=True)
        if arguments.output_dir is None:
            print(text)
            return 0
        file = Path(arguments.output_dir) / f"{parameters.node.strip('/').replace('/', '__')}.yaml"
        write_output(file, text)
        print(f"Saving to:  {file}")
        return 0

    return run_in_graph(arguments, job)


def _insert(tree: dict[str, Any], path: list[str], value: Any) -> None:
    """Put a value below the parts of its name; where a part has a value itself the name stays whole."""
    for at, part in enumerate(path[:-1]):
        below = tree.setdefault(part, {})
        if not isinstance(below, dict):
            tree[".".join(path[at:])] = value
            return
        tree = below
    tree[path[-1]] = value
