"""An argument that the verbs for managed nodes share."""

from __future__ import annotations

import argparse

from linkwright.cli.session import add_session_arguments


def add_node_arguments(parser: argparse.ArgumentParser, *, optional: bool = False) -> None:
    """Declare the node."""
    add_session_arguments(parser)
    parser.add_argument(
        "node_name",
        metavar="NODE",
        nargs="?" if optional else None,
        help="such as /lc_talker" + ("; all managed nodes when left out" if optional else ""),
    )
    parser.add_argument("--include-hidden-nodes", action="store_true", help="consider hidden nodes as well")
