"""``linkwright diagram``: draw the structure of a robot as Graphviz text and as an image."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from linkwright.cli.output import write_output
from linkwright.diagnostics import print_diagnostics
from linkwright.process.assignments import parse_assignments

_FORMATS = (".pdf", ".svg", ".png")


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``diagram``."""
    parser.usage = "linkwright diagram [-h] FILE [OUT] [NAME:=VALUE ...]"
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    parser.add_argument(
        "words",
        metavar="OUT",
        nargs="*",
        default=[],  # without a default, argparse reports the optional words as missing arguments, too
        help="base name of the two files, default the robot's name; the extension .pdf, .svg or .png selects "
        "the format of the drawing. Arguments NAME:=VALUE are values for the file's <xacro:arg>",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write OUT.gv and the drawing, and print their names as urdf_to_graphviz does."""
    from linkwright.descriptions import examine
    from linkwright.urdf import to_gv
    from linkwright.urdf.diagram import render

    names = [word for word in arguments.words if ":=" not in word]
    values = [word for word in arguments.words if ":=" in word]
    if len(names) > 1:
        print(f"linkwright diagram: expected one OUT, got {len(names)}: {', '.join(names)}", file=sys.stderr)
        return 2
    reading = examine(arguments.file, arguments=parse_assignments(values))
    print_diagnostics(reading.diagnostics, sys.stderr)
    robot = reading.robot
    if robot is None:
        return 1
    base_path = Path(*names or [robot.name or "robot"])
    extension = ".pdf"
    if base_path.suffix.lower() in (*_FORMATS, ".gv"):
        extension = base_path.suffix.lower() if base_path.suffix.lower() in _FORMATS else extension
        base_path = base_path.with_suffix("")
    text = to_gv(robot)
    gv = base_path.with_name(base_path.name + ".gv")
    write_output(gv, text)
    print(f"Created file {gv}")
    diagram = base_path.with_name(base_path.name + extension)
    render(text, diagram)
    print(f"Created file {diagram}")
    return 0
