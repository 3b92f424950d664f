"""The arguments that the verbs for parameters share."""

from __future__ import annotations

import argparse

from linkwright.cli.session import add_session_arguments


def add_node_arguments(parser: argparse.ArgumentParser, *, optional: bool = False) -> None:
    """Declare the node and how long to wait for it."""
    add_session_arguments(parser)
    parser.add_argument(
        "node_name",
        metavar="NODE",
        nargs="?" if optional else None,
        help="such as /robot_state_publisher" + ("; all nodes when left out" if optional else ""),
    )
    parser.add_argument(
        "--include-hidden-nodes", "-a", "--all", action="store_true", help="consider hidden nodes as well"
    )
    parser.add_argument(
        "--timeout", metavar="SECONDS", type=float, default=1.0, help="wait so long for the node (default: 1)"
    )
    parser.add_argument(
        "--service-timeout", metavar="SECONDS", type=float, help="wait so long for an answer (default: as it takes)"
    )
