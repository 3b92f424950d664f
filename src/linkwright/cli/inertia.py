"""``linkwright inertia``: compute the mass properties of links from their geometry."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import print_message
from linkwright.cli.model_arguments import add_model
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, has_errors, phrase, print_diagnostics
from linkwright.diagnostics.translation import localized
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.urdf import Robot


_MAX_VALUE = 1e15
"""The maximum mass in kg and density in kg/m3. Larger values are refused as mistakes."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``inertia``."""
    add_model(parser)
    parser.add_argument(
        "--density",
        metavar="KG_PER_M3",
        type=_parse_positive,
        help="density of all links; by default a link keeps its mass, and a link without a mass gets 1000 kg/m3",
    )
    parser.add_argument(
        "--mass", metavar="LINK=KG", action="append", default=[], help="mass of one link; may be repeated"
    )
    parser.add_argument(
        "--link",
        metavar="NAME",
        action="append",
        default=[],
        help="show only this link, with its computed <inertial> block; may be repeated",
    )
    parser.add_argument(
        "--from",
        dest="preferred_kind",
        choices=("collision", "visual"),
        default="collision",
        help="the shapes to use; a link without them uses the other shapes (default: %(default)s)",
    )
    parser.add_argument(
        "--write",
        action="store_true",
        help="write the blocks into the files that define the links, leaving the rest unchanged",
    )
    parser.add_argument(
        "--format", choices=("text", "json"), default="text", help="the output format (default: %(default)s)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print or write the ``<inertial>`` elements of the links.

    Returns:
        1 if the description has errors or an element could not be written, otherwise 0.
    """
    from linkwright.descriptions import examine
    from linkwright.inertia import MeshLibrary, estimate
    from linkwright.inertia.reports import format_json, format_text
    from linkwright.inertia.writing import WriteResult, write_inertials
    from linkwright.packages import PackageFinder

    folder = Path(arguments.file).absolute().parent
    finder = PackageFinder(start=[folder, Path.cwd()])
    description = examine(arguments.file, arguments=parse_assignments(arguments.values), packages=finder)
    robot = description.robot
    if robot is None or has_errors(description.diagnostics):
        print_diagnostics(description.diagnostics, sys.stderr)
    if robot is None:
        return 1
    masses = _parse_masses(arguments.mass, robot)
    link_names = _select_links(arguments.link, robot)
    meshes = MeshLibrary(finder, folder)
    estimates = [
        estimate(
            robot.links[name],
            meshes,
            density=arguments.density,
            mass=masses.get(name),
            preferred_kind=arguments.preferred_kind,
        )
        for name in link_names
    ]
    result: WriteResult | None = None
    if arguments.write:
        properties = {estimate.link: estimate.properties for estimate in estimates if estimate.properties is not None}
        result = write_inertials(robot, properties)
    if arguments.format == "json":
        sys.stdout.write(format_json(robot, estimates, result))
    else:
        detailed_links = link_names if arguments.link and result is None else () if result is None else result.refusals
        sys.stdout.write(format_text(robot, estimates, result, detailed_links))
        if not (arguments.link or arguments.write):
            print_message(
                localized(
                    phrase("`--link NAME` prints the <inertial> of one link, `--write` writes all of them to the file")
                )
            )
    if result is not None:
        print_diagnostics(_create_refusal_findings(result.refusals, robot), sys.stderr)
    return 1 if has_errors(description.diagnostics) or (result is not None and result.refusals) else 0


def _parse_positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value <= _MAX_VALUE:
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive number")
    return value


def _select_links(names: Sequence[str], robot: Robot) -> list[str]:
    """Return the selected links in file order, or all links if none is selected.

    Raises:
        LinkwrightError: CLI311, the robot does not have a selected link.
    """
    diagnostics = [_unknown_link_error(name, robot) for name in names if name not in robot.links]
    if diagnostics:
        raise LinkwrightError(*diagnostics)
    return [name for name in robot.links if not names or name in names]


def _parse_masses(assignments: Sequence[str], robot: Robot) -> dict[str, float]:
    """Parse arguments such as ``arm=1.5``, and return the mass in kg of each link.

    Raises:
        LinkwrightError: CLI311, the robot does not have such a link; CLI312, an argument has no mass.
    """
    masses: dict[str, float] = {}
    diagnostics = []
    for assignment in assignments:
        name, _, value = assignment.rpartition("=")
        name = name.removesuffix(":")
        try:
            masses[name] = _parse_positive(value)
        except argparse.ArgumentTypeError:
            name = ""
        if not name:
            message = phrase("'{argument}' does not set the mass of a link", argument=assignment)
            diagnostics.append(
                Diagnostic("CLI312", message, hint=phrase("write --mass LINK=KG, such as --mass arm_link=1.5"))
            )
        elif name not in robot.links:
            diagnostics.append(_unknown_link_error(name, robot))
    if diagnostics:
        raise LinkwrightError(*diagnostics)
    return masses


def _unknown_link_error(name: str, robot: Robot) -> Diagnostic:
    return Diagnostic(
        "CLI311", phrase("the robot has no link '{name}'", name=name), hint=did_you_mean(name, robot.links)
    )


def _create_refusal_findings(reasons: Mapping[str, str], robot: Robot) -> list[Diagnostic]:
    """Return a finding for each ``<inertial>`` element that could not be written."""
    diagnostics = []
    for name, reason in reasons.items():
        element = robot.links[name].element
        diagnostics.append(
            Diagnostic(
                "INR211",
                phrase("<inertial> of link '{name}' is not written: {reason}", name=name, reason=reason),
                element.span() if element else None,
                hint=phrase("add the block printed above to the link, or write expressions with the same values"),
                source=element.source if element else None,
            )
        )
    return diagnostics
