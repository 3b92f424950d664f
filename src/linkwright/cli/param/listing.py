"""``linkwright param list``."""

from __future__ import annotations

import argparse
import asyncio
import re
import sys
from typing import TYPE_CHECKING

from linkwright.cli.calls import NoAnswerError, find_node, node_names
from linkwright.cli.param.access import TYPE_NAMES, RemoteParameters
from linkwright.cli.param.arguments import add_node_arguments
from linkwright.cli.session import run_in_graph
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the parameters of one node or of all"

_LONGEST_ANSWER = 5.0
"""Seconds for each of all nodes; one that hangs must not keep the others from being listed."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser, optional=True)
    parser.add_argument(
        "--param-prefixes", metavar="PREFIX", nargs="+", default=[], help="list only parameters below these"
    )
    parser.add_argument("--param-type", action="store_true", help="print the type of each")
    parser.add_argument("--filter", metavar="REGEX", help="list only names in which this is found")


def run(arguments: argparse.Namespace) -> int:
    """Print the names, below each node's."""
    try:
        wanted = re.compile(arguments.filter or "")
    except re.error as error:
        hint = phrase("names are looked for as regular expressions; write '\\.' for a dot")
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
        hidden = arguments.include_hidden_nodes
        if arguments.node_name is not None:
            node = await find_node(session, arguments.node_name, hidden=hidden, timeout=arguments.timeout)
            print(
                "\n".join(await _lines(RemoteParameters(session, node, arguments.service_timeout), arguments, wanted))
            )
            return 0
        services = dict(session.node.get_service_names_and_types())
        nodes = [
            node for node in dict.fromkeys(node_names(session, hidden=hidden)) if f"{node}/list_parameters" in services
        ]
        timeout = arguments.service_timeout or _LONGEST_ANSWER
        asked = [_lines(RemoteParameters(session, node, timeout), arguments, wanted) for node in nodes]
        failed = False
        for node, lines in zip(nodes, await asyncio.gather(*asked, return_exceptions=True), strict=True):
            if isinstance(lines, NoAnswerError):
                failed = True
                print(f"Exception while calling service of node '{node}': {lines}", file=sys.stderr)
            elif isinstance(lines, BaseException):
                raise lines
            else:
                print("\n".join([f"{node}:", *lines]))
        return 1 if failed else 0

    return run_in_graph(arguments, job)


async def _lines(parameters: RemoteParameters, arguments: argparse.Namespace, wanted: re.Pattern[str]) -> list[str]:
    names = [name for name in await parameters.names(arguments.param_prefixes) if wanted.search(name)]
    if not arguments.param_type:
        return [f"  {name}" for name in names]
    descriptors = await parameters.descriptors(names)
    return [f"  {each.name} (type: {TYPE_NAMES.get(each.type, 'unknown')})" for each in descriptors]
