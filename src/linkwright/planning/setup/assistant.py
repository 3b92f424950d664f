"""Sets up a robot for planning: from its description to the files of a configuration package."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.descriptions import Description
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.packages import PackageFinder
from linkwright.packages.creation.request import Maintainer
from linkwright.packages.manifest import enclosing_package
from linkwright.planning.setup.collision_pairs import ClosedGripper, find_collision_pairs
from linkwright.planning.setup.gazebo import choose_gazebo
from linkwright.planning.setup.gripper_states import open_and_close
from linkwright.planning.setup.groups import GroupRequests, find_groups
from linkwright.planning.setup.link_surfaces import LinkSurfaces
from linkwright.planning.setup.named_states import choose_states, start_positions
from linkwright.planning.setup.position_sampler import PositionSampler
from linkwright.planning.setup.settings import DescriptionSource, PackageSettings
from linkwright.planning.setup.srdf import choose_virtual_joint
from linkwright.planning.shapes import robot_shapes
from linkwright.urdf import Robot


@dataclass(frozen=True, slots=True)
class RobotInGazebo:
    """The robot with the values of xacro arguments that it has in Gazebo.

    Attributes:
        robot: the robot.
        arguments: the values that differ from those of the demo without a simulator.
    """

    robot: Robot
    arguments: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class PackageChoices:
    """The choices of the user for the package.

    Attributes:
        name: the name of the package.
        maintainer: its maintainer.
        license: the text for ``<license>``.
        distribution: ``humble`` or ``jazzy``.
    """

    name: str
    maintainer: Maintainer
    license: str
    distribution: str


def set_up(
    description: Description,
    robot: Robot,
    finder: PackageFinder,
    arguments: Mapping[str, str],
    requests: GroupRequests,
    choices: PackageChoices,
    in_gazebo: RobotInGazebo | None = None,
) -> PackageSettings:
    """Return the contents of a configuration package for a robot.

    Args:
        description: the description of the robot, from a file.
        robot: the robot.
        finder: finds the packages with its meshes.
        arguments: the values of the description's xacro arguments.
        requests: the groups that the user names.
        choices: the name, the maintainer and the format of the package.
        in_gazebo: the robot in Gazebo, if the description has other arguments there.

    Raises:
        LinkwrightError: ARM105 or ARM106, see `find_groups`; ARM108, the description is in no package, so that it
            cannot have other arguments in Gazebo; SIM101, MuJoCo is not installed; a mesh cannot be read.
    """
    path = Path(description.name).absolute()
    groups = find_groups(robot, requests)
    meshes = MeshLibrary(finder, path.parent)
    shapes, errors = robot_shapes(robot, meshes)
    if errors:
        raise errors[0]
    sampler = PositionSampler(robot)
    grippers = [
        ClosedGripper(group.moved_links(robot), open_and_close(robot, shapes, group, sampler, sampler.default())[1])
        for group in groups.groups
        if group.is_end_effector
    ]
    pairs = find_collision_pairs(robot, shapes, LinkSurfaces(robot, meshes), grippers)
    states = choose_states(robot, shapes, groups, pairs)
    controlled = joints_with_hardware(robot)
    virtual_joint = choose_virtual_joint(robot, groups)
    in_gazebo = in_gazebo or RobotInGazebo(robot)
    source = _find_source(path, description, arguments)
    if in_gazebo.arguments and not source.package:
        message = phrase("'{file}' is in no package, so --gazebo has no effect", file=description.name)
        raise LinkwrightError(Diagnostic("ARM108", message, hint=phrase("put the file into a package")))
    return PackageSettings(
        choices.name,
        robot,
        source,
        groups,
        states,
        pairs,
        virtual_joint,
        start_positions(groups, states, robot),
        tuple(name for name in groups.controlled_joints if name not in controlled),
        choose_gazebo(in_gazebo.robot, choices.name, virtual_joint, in_gazebo.arguments),
        choices.maintainer,
        choices.license,
        choices.distribution,
    )


def joints_with_hardware(robot: Robot) -> frozenset[str]:
    """Return the joints for which the description itself has interfaces of ros2_control."""
    return frozenset(
        joint.attributes.get("name", "")
        for element in robot.extensions
        if element.tag == "ros2_control"
        for joint in element.elements("joint")
    )


def _find_source(path: Path, description: Description, arguments: Mapping[str, str]) -> DescriptionSource:
    package = enclosing_package(path.parent)
    if package is None:
        return DescriptionSource("", "", arguments, description.text)
    name, folder = package
    return DescriptionSource(name, path.relative_to(folder).as_posix(), arguments, description.text)
