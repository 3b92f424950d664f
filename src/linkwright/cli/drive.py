"""``linkwright drive``: drive a robot in a simulated world.

Elements that its description lacks are inferred.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import print_message
from linkwright.cli.model_arguments import add_model
from linkwright.cli.simulation_options import add_simulation_options, open_recording, refuse_terminal_without_page
from linkwright.cli.view import add_viewer_options, find_terminal_folder
from linkwright.diagnostics import (
    Phrase,
    Severity,
    counted,
    display_path,
    has_errors,
    joined,
    phrase,
    print_diagnostics,
)
from linkwright.diagnostics.translation import localized
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.inference import Inference
    from linkwright.urdf import Robot

_DRIVE_KINDS = ("differential", "skid", "ackermann", "mecanum", "joints")


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``drive``."""
    add_model(parser)
    parser.add_argument(
        "--world", metavar="WORLD", default="empty", help="the world: a file or a name (default: a plane)"
    )
    parser.add_argument(
        "--drive",
        metavar="KIND",
        choices=_DRIVE_KINDS,
        help="the kind of drive, if the file does not specify it: %(choices)s",
    )
    parser.add_argument(
        "--wheels",
        metavar="LEFT,RIGHT",
        help="the joints or links of the driven wheels, if the file does not specify them",
    )
    parser.add_argument(
        "--show", action="store_true", help="print the inferred facts and the elements that state them, and exit"
    )
    parser.add_argument(
        "--write",
        action="store_true",
        help="write the inferred elements into the file, leaving the rest unchanged, and exit",
    )
    add_simulation_options(parser)
    add_viewer_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Infer the missing elements, and then drive the robot, or print or write the elements.

    Returns:
        The exit status, which is 1 if the description has errors.
    """
    from linkwright.descriptions import examine
    from linkwright.hosting.plans import HostOptions
    from linkwright.hosting.simulated import SimulatedWorld, run_simulated
    from linkwright.inertia import MeshLibrary
    from linkwright.inference import infer
    from linkwright.inference.writing import write_inference
    from linkwright.packages import PackageFinder
    from linkwright.simulation.library import load_mujoco
    from linkwright.simulation.server.worlds import load_world

    refuse_terminal_without_page(arguments)
    path = Path(arguments.file).absolute()
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    values = parse_assignments(arguments.values)
    description = examine(arguments.file, arguments=values, packages=finder)
    robot = description.robot
    if robot is None or not robot.links:
        print_diagnostics(description.diagnostics, sys.stderr)
        return 1
    wheels = [name.strip() for name in (arguments.wheels or "").split(",") if name.strip()]

    def infer_drive(robot: Robot) -> Inference:
        return infer(robot, MeshLibrary(finder, path.parent), kind=arguments.drive, wheels=wheels)

    inference = infer_drive(robot)
    if arguments.show:
        sys.stdout.write(_format_inferences(inference))
        return 0
    if arguments.write:
        result = write_inference(robot, inference)
        for file in result.files:
            print(localized(phrase("Changed file {file}", file=display_path(file))))
        print_diagnostics(result.refused, sys.stderr)
        return 1 if result.refused else 0
    load_mujoco()
    load_world(arguments.world)  # report a missing world before the simulation starts to log
    print_diagnostics(
        [diagnostic for diagnostic in inference.diagnostics if diagnostic.severity is not Severity.INFO], sys.stderr
    )
    print_message(localized(_summarize(robot, inference)))
    world = replace(
        SimulatedWorld.of(arguments.world, description, inference, infer_drive),
        arguments=tuple(values.items()),
        seconds=arguments.seconds,
        headless=arguments.headless,
        rate=arguments.rate,
    )
    options = HostOptions(
        arguments.host,
        arguments.port,
        not arguments.no_open,
        history=arguments.history,
        terminal=find_terminal_folder(arguments),
    )
    with open_recording(arguments) as writer:
        status = run_simulated(world, finder, options, foxglove=arguments.foxglove, writer=writer)
    return status or int(has_errors(description.diagnostics))


def _summarize(robot: Robot, inference: Inference) -> Phrase:
    """Return a one-line summary of the inferred elements."""
    drive = inference.drive
    parts: list[Phrase] = []
    if drive is not None and drive.left:
        names = [joined([wheel.joint for wheel in wheels]) for wheels in (drive.left, drive.right)]
        parts.append(phrase("{kind} drive, {left} and {right}", kind=drive.kind, left=names[0], right=names[1]))
    codes = [diagnostic.code for diagnostic in inference.diagnostics]
    collisions, masses = codes.count("DRIVE101"), codes.count("DRIVE102") + codes.count("DRIVE103")
    if collisions:
        parts.append(counted("collisions of {count} link", "collisions of {count} links", collisions))
    if masses:
        parts.append(counted("the mass of {count} link", "masses of {count} links", masses))
    if not parts:
        return phrase("'{robot}' needs no inferred elements", robot=robot.name)
    return phrase(
        "inferred for '{robot}': {parts}; `--show` explains the elements, `--write` writes them to the file",
        robot=robot.name,
        parts=joined(parts),
    )


def _format_inferences(inference: Inference) -> str:
    """Return a text that lists each inference with its file, line, message and added elements."""
    from linkwright.xmltree.patches import format_block

    lines: list[str] = []
    for finding in inference.findings:
        diagnostic = finding.diagnostic
        location = f"{diagnostic.span.file}:{diagnostic.span.line}: " if diagnostic.span else ""
        lines.append(f"{location}{diagnostic.code} {localized(diagnostic.message)}")
        lines += [f"    {line}" for element in finding.added for line in format_block(element).splitlines()]
    return "".join(f"{line}\n" for line in lines)
