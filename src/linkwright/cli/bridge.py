"""``linkwright bridge``: carry topics and services between DDS and Zenoh."""

from __future__ import annotations

import argparse
import sys

from linkwright.cli.session import ExitOnSigterm
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.process.event_loop import run_coroutine
from linkwright.process.interruption import raise_interrupts


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bridge``."""
    parser.add_argument(
        "networks",
        metavar="NETWORK",
        nargs=2,
        help="dds or zenoh; add a colon and a number to use a domain other than ROS_DOMAIN_ID, as in dds:5",
    )
    parser.add_argument(
        "--allow",
        metavar="NAME",
        nargs="+",
        action="extend",
        default=[],
        help="carry only topics, services and actions with these names; a name includes all names below it, "
        "and * matches anything except a slash",
    )
    parser.add_argument(
        "--deny",
        metavar="NAME",
        nargs="+",
        action="extend",
        default=[],
        help="do not carry topics, services and actions with these names, even if --allow includes them",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the bridge until it is interrupted.

    Raises:
        LinkwrightError: CLI451 to CLI454, an argument is malformed or a network cannot be joined; DDS101 to DDS112, a
            setting is malformed.
    """
    from linkwright.bridge.bridge import create_bridge_id, run_bridge
    from linkwright.bridge.filters import NameFilter
    from linkwright.bridge.networks import read_network
    from linkwright.graph.log.console import print_to_console

    first, second = (read_network(network) for network in arguments.networks)
    if first == second:
        raise LinkwrightError(
            Diagnostic(
                "CLI452",
                phrase("both networks are the same: {network}", network=first.label),
                hint=phrase("pass two networks, as in: linkwright bridge dds zenoh"),
            )
        )
    names = NameFilter(arguments.allow, arguments.deny)

    def report() -> None:
        print(f"Bridging {first.label} and {second.label}. Press Ctrl-C to stop", file=sys.stderr)

    async def main() -> int:
        await run_bridge((first, second), names, create_bridge_id(), print_to_console, report)
        return 0

    with ExitOnSigterm():
        return run_coroutine(main, raise_interrupts)
