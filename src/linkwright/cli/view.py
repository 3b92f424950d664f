"""``linkwright view``: show one model in the browser, with sliders for its joints."""

from __future__ import annotations

import argparse

from linkwright.assignments import parse_assignments
from linkwright.cli.launch import add_viewer_options


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    parser.add_argument(
        "values", metavar="NAME:=VALUE", nargs="*", default=[], help="values for the file's <xacro:arg>"
    )
    parser.add_argument(
        "--join", action="store_true", help="join the ROS 2 network (ROS_DOMAIN_ID), where other programs see the nodes"
    )
    add_viewer_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Show the model until the user ends it."""
    from linkwright.hosting.plans import HostOptions
    from linkwright.hosting.view import run_view

    values = parse_assignments(arguments.values)
    options = HostOptions(arguments.host, arguments.port, not arguments.no_open, network=arguments.join)
    return run_view(arguments.file, values, options, foxglove=arguments.foxglove)
