"""``linkwright arm``: set up a robot for planning motions with MoveIt."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import print_message
from linkwright.cli.maintainer import find_maintainer
from linkwright.cli.model_arguments import add_model
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.output import write_output
from linkwright.diagnostics import Diagnostic, LinkwrightError, has_errors, joined, phrase
from linkwright.diagnostics.translation import localized
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.descriptions import Description
    from linkwright.diagnostics import Phrase
    from linkwright.packages import PackageFinder
    from linkwright.planning.setup.gazebo import GazeboSettings
    from linkwright.planning.setup.groups import GroupRequests, PlanningGroup
    from linkwright.planning.setup.settings import PackageSettings
    from linkwright.urdf import Robot

_DISTRIBUTIONS = ("humble", "jazzy")


def configure_init(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``arm init``."""
    add_model(parser)
    parser.add_argument("--package", metavar="NAME", help="the name of the new package (default: ROBOT_moveit_config)")
    parser.add_argument(
        "--output",
        metavar="FOLDER",
        default=".",
        help="the folder to create the package in (default: the current folder)",
    )
    parser.add_argument(
        "--group",
        metavar="NAME=BASE:TIP",
        action="append",
        default=[],
        help="a group of joints from a base link to a tip link, or NAME=JOINT,JOINT; replaces groups with these "
        "joints; may be repeated",
    )
    parser.add_argument(
        "--tip", metavar="GROUP=LINK", action="append", default=[], help="the tip link of a group; may be repeated"
    )
    parser.add_argument(
        "--end-effector",
        metavar="GROUP=LINK",
        action="append",
        default=[],
        help="make a group an end effector that is attached to a link; may be repeated",
    )
    parser.add_argument(
        "--gazebo",
        metavar="NAME:=VALUE",
        action="append",
        default=[],
        help="the value of an <xacro:arg> of the description in Gazebo; may be repeated",
    )
    parser.add_argument(
        "--distro",
        choices=_DISTRIBUTIONS,
        default="jazzy",
        help="the ROS 2 distribution, which determines the format of the planning pipelines (default: %(default)s)",
    )
    parser.add_argument("--force", action="store_true", help="overwrite the files of an existing package")


def run_init(arguments: argparse.Namespace) -> int:
    """Write a MoveIt configuration package for a robot, and print the groups that were found.

    Returns:
        1 if the description has errors, otherwise 0.
    """
    from linkwright.descriptions import examine
    from linkwright.packages import PackageFinder
    from linkwright.packages.creation.request import DEFAULT_LICENSE
    from linkwright.packages.naming import check_package_name
    from linkwright.planning.setup.assistant import PackageChoices, RobotInGazebo, set_up
    from linkwright.planning.setup.package import package_files
    from linkwright.planning.setup.settings import file_name

    finder = PackageFinder(start=[Path(arguments.file).absolute().parent, Path.cwd()])
    values = parse_assignments(arguments.values)
    description = examine(arguments.file, arguments=values, packages=finder)
    robot = _require_robot(description)
    gazebo = parse_assignments(arguments.gazebo)
    in_gazebo = examine(arguments.file, arguments={**values, **gazebo}, packages=finder) if gazebo else description
    name = arguments.package or f"{file_name(robot.name).lower().replace('-', '_').replace('.', '_')}_moveit_config"
    name_findings = check_package_name(name)
    if has_errors(name_findings):
        raise LinkwrightError(*name_findings)
    folder = Path(arguments.output) / name
    if not arguments.force:
        _refuse_existing(name, folder, finder)
    choices = PackageChoices(name, find_maintainer(None, None), DEFAULT_LICENSE, arguments.distro)
    settings = set_up(
        description,
        robot,
        finder,
        values,
        _read_requests(arguments),
        choices,
        RobotInGazebo(_require_robot(in_gazebo), gazebo),
    )
    files = package_files(settings)
    for path, text in files.items():
        write_output(folder / path, text)
    for line in _summarize(settings):
        print(localized(line))
    print(localized(phrase("Created package {folder} ({count} files)", folder=folder, count=len(files))))
    print_message(localized(phrase("`linkwright launch {package} demo.launch.py` plans motions with it", package=name)))
    print_message(
        localized(phrase("`linkwright launch {package} demo_gazebo.launch.py` does so in a simulation", package=name))
    )
    return 0


def _require_robot(description: Description) -> Robot:
    """Return the robot of a description.

    Raises:
        LinkwrightError: the description has errors.
    """
    if description.robot is None or has_errors(description.diagnostics):
        raise LinkwrightError(*description.diagnostics)
    return description.robot


def _refuse_existing(name: str, folder: Path, finder: PackageFinder) -> None:
    """Raise an error if the folder exists, or if the workspace has another package of this name.

    Raises:
        LinkwrightError: CLI206.
    """
    found = folder if folder.exists() or folder.is_symlink() else finder.find_in_sources(name)
    if found is not None:
        hint = phrase("choose another --package or --output, or add --force to overwrite its files")
        raise LinkwrightError(Diagnostic("CLI206", phrase("'{path}' already exists", path=found), hint=hint))


def _read_requests(arguments: argparse.Namespace) -> GroupRequests:
    from linkwright.planning.setup.groups import GroupRequests

    return GroupRequests(
        dict(_split(arguments.group, "--group", "NAME=BASE:TIP")),
        dict(_split(arguments.tip, "--tip", "GROUP=LINK")),
        dict(_split(arguments.end_effector, "--end-effector", "GROUP=LINK")),
    )


def _split(words: Iterable[str], option: str, form: str) -> Iterator[tuple[str, str]]:
    """Yield the name and the value of each argument of an option.

    Raises:
        LinkwrightError: CLI313, an argument does not have the form.
    """
    for word in words:
        name, _, value = word.partition("=")
        if not (name and value):
            message = phrase("'{argument}' does not have the form {form}", argument=word, form=form)
            hint = phrase("write {option} {form}", option=option, form=form)
            raise LinkwrightError(Diagnostic("CLI313", message, hint=hint))
        yield name, value


def _summarize(settings: PackageSettings) -> Iterator[Phrase | str]:
    """Yield the lines that describe the groups, the states and the pairs of links."""
    from linkwright.planning.setup.collision_pairs import ALWAYS, DEFAULT, REASONS

    for group in settings.groups.groups:
        yield _describe(group)
        states = settings.states.get(group.name, {})
        yield phrase("  named states: {states}", states=", ".join(states))
    if settings.virtual_joint is not None:
        yield phrase(
            "virtual joint: {type}, from {parent} to {child}",
            type=settings.virtual_joint.type,
            parent=settings.virtual_joint.parent_frame,
            child=settings.virtual_joint.child_link,
        )
    if settings.groups.passive_joints:
        yield phrase("passive joints: {joints}", joints=joined(settings.groups.passive_joints))
    if settings.groups.other_joints:
        yield phrase("joints without a group: {joints}", joints=joined(settings.groups.other_joints))
    counts = Counter(settings.pairs.disabled.values())
    reasons = ", ".join(f"{counts[reason]} {reason}" for reason in REASONS)
    yield phrase(
        "pairs of links: {disabled} that are not checked for collisions ({reasons}), {checked} that are",
        disabled=len(settings.pairs.disabled),
        reasons=reasons,
        checked=settings.pairs.checked,
    )
    for (first, second), reason in settings.pairs.disabled.items():
        if reason in (DEFAULT, ALWAYS):
            yield f"  {reason}: {first}, {second}"
    yield from _summarize_gazebo(settings.gazebo)


def _summarize_gazebo(gazebo: GazeboSettings) -> Iterator[Phrase]:
    """Yield the lines about what the description lacks for Gazebo."""
    if gazebo.other_hardware:
        yield phrase(
            "in Gazebo: hardware {plugins} of the description is not simulated; --gazebo NAME:=VALUE gives the "
            "<xacro:arg> that selects {hardware}",
            plugins=joined(gazebo.other_hardware),
            hardware=gazebo.simulator.hardware_plugin,
        )
    if gazebo.controllers_file:
        yield phrase(
            "in Gazebo: the plugin of the description reads the controllers from {file}", file=gazebo.controllers_file
        )
    if gazebo.links_without_mass:
        yield phrase(
            "in Gazebo: links without a mass are left out: {links}; `linkwright inertia` computes masses",
            links=joined(gazebo.links_without_mass),
        )


def _describe(group: PlanningGroup) -> Phrase:
    if group.is_end_effector:
        return phrase(
            "end effector {name}: joints {joints}, attached to {parent}",
            name=group.name,
            joints=joined(group.joints),
            parent=group.parent_link,
        )
    if group.is_chain:
        return phrase(
            "group {name}: {count} joints from {base} to {tip}",
            name=group.name,
            count=len(group.active_joints),
            base=group.base,
            tip=group.tip,
        )
    return phrase("group {name}: joints {joints}", name=group.name, joints=joined(group.joints))


VERBS = {
    "init": SubVerb(
        configure_init, run_init, help="write a MoveIt configuration package for a robot, as the setup assistant does"
    ),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``arm``."""
    configure_nested(parser, VERBS)


def run(arguments: argparse.Namespace) -> int:
    """Run the requested subcommand."""
    return run_nested(arguments)
