"""``linkwright diagram``: the structure of a robot as Graphviz text and as a picture."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from linkwright.cli.output import write_output
from linkwright.diagnostics import print_diagnostics

NAME = "diagram"
HELP = "draw the links and joints of a model as urdf_to_graphviz does (.gv and PDF or SVG)"

_PICTURES = (".pdf", ".svg", ".png")


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    parser.add_argument(
        "output",
        metavar="OUT",
        nargs="?",
        help="base name of the two files, default the robot's name; an ending .pdf, .svg or .png picks the picture",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write OUT.gv and the picture, and say so as urdf_to_graphviz does."""
    from linkwright.urdf import examine, to_gv
    from linkwright.urdf.diagram import render

    reading = examine(arguments.file)
    print_diagnostics(reading.diagnostics, sys.stderr)
    robot = reading.robot
    if robot is None:
        return 1
    base = Path(arguments.output or robot.name or "robot")
    ending = ".pdf"
    if base.suffix.lower() in (*_PICTURES, ".gv"):
        ending = base.suffix.lower() if base.suffix.lower() in _PICTURES else ending
        base = base.with_suffix("")
    text = to_gv(robot)
    gv = base.with_name(base.name + ".gv")
    write_output(gv, text)
    print(f"Created file {gv}")
    picture = base.with_name(base.name + ending)
    render(text, picture)
    print(f"Created file {picture}")
    return 0
