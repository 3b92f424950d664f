"""Snapshots of the scene of a viewer and the files to draw it, for pages without a server."""

from __future__ import annotations

import dataclasses
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain
from math import atan2, isfinite, pi
from os.path import normpath
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast
from urllib.parse import unquote, urlsplit

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, foreign, phrase
from linkwright.geometry.arrays import quaternion_inverse, quaternion_multiply, rotate
from linkwright.geometry.single import pose_quaternion
from linkwright.nodes.joint_layout import JointSettings, make_layout
from linkwright.packages import enclosing_package
from linkwright.page.files import FileRefusedError, MeshFolders
from linkwright.page.outbox import ScaledData
from linkwright.page.protocol.comparison import ComparedDescriptions
from linkwright.page.protocol.configuration import Display, DisplayProperties, Property, Tree
from linkwright.page.protocol.message import FrameTable, Hello, ServerMessage, unpack_transforms
from linkwright.page.protocol.robot import JointControl, JointPositions, Joints, RobotScene
from linkwright.page.protocol.views_and_tools import SavedViews, View, ViewClasses, ViewState
from linkwright.panels.comparison.feature import without_paths
from linkwright.urdf import Joint, Robot

if TYPE_CHECKING:
    from linkwright.page.outbox import Payload
    from linkwright.panels.page_feature import FeatureHost
    from linkwright.rviz.displays.robot_model import RobotModelDisplay
    from linkwright.rviz.visualization.manager import VisualizationManager


Pose = NDArray[np.float64]
"""A pose: x, y, z in meters, qx, qy, qz, qw, shape (7,)."""


def compute_positions(robot: Robot, poses: Mapping[str, Pose]) -> dict[str, float]:
    """Return the positions (rad or m) of the movable joints by name, computed from link poses.

    Joints whose links have no known pose are omitted.

    Args:
        robot: the description.
        poses: the poses of the links by name, all in the same frame.
    """
    positions = {}
    for joint in robot.joints.values():
        if joint.type not in ("revolute", "continuous", "prismatic"):
            continue
        if joint.parent in poses and joint.child in poses:
            position = _compute_position(joint, poses[joint.parent], poses[joint.child])
            if isfinite(position):
                positions[joint.name] = position
    return positions


def _compute_position(joint: Joint, parent: Pose, child: Pose) -> float:
    inverse_parent = quaternion_inverse(parent[3:])
    axis = np.asarray(joint.axis, dtype=np.float64)
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        return 0.0
    axis = axis / length
    origin = np.asarray(pose_quaternion(joint.origin), dtype=np.float64)
    if joint.type == "prismatic":
        translation = rotate(inverse_parent, child[:3] - parent[:3]) - np.asarray(joint.origin.xyz)
        return float(np.dot(rotate(quaternion_inverse(origin), translation), axis))
    relative_rotation = quaternion_multiply(quaternion_inverse(origin), quaternion_multiply(inverse_parent, child[3:]))
    angle = 2.0 * atan2(float(np.dot(relative_rotation[:3], axis)), float(relative_rotation[3]))
    angle = (angle + pi) % (2.0 * pi) - pi
    return _move_within_limits(joint, angle)


def _move_within_limits(joint: Joint, angle: float) -> float:
    """Return the angle, or an equivalent angle within the limits of the joint if there is one."""
    if joint.type == "continuous" or joint.limit is None:
        return angle
    for equivalent_angle in (angle, angle + 2.0 * pi, angle - 2.0 * pi):
        if joint.limit.lower - 1e-3 <= equivalent_angle <= joint.limit.upper + 1e-3:
            return equivalent_angle
    return angle


_ADDRESS = re.compile(r"/mesh/([^/]+)/(.+)")
_COLLADA_IMAGE = re.compile(r"<init_from>\s*(?:<ref>)?\s*([^<]+?)\s*<")
_MATERIAL_FILE = re.compile(r"^[ \t]*mtllib[ \t]+(.+?)[ \t]*\r?$", re.MULTILINE)
_MATERIAL_MAP = re.compile(r"^[ \t]*(?:map_\w+|bump|norm|disp)[ \t]+(.+?)[ \t]*\r?$", re.MULTILINE)


def find_mesh_addresses(scenes: Iterable[RobotScene]) -> list[str]:
    """Return the addresses of the meshes and textures of robots, without duplicates."""
    links = chain.from_iterable(scene.links for scene in scenes)
    shapes = chain.from_iterable((*link.visuals, *link.collisions) for link in links)
    addresses_or_none = chain.from_iterable((shape.url, shape.texture) for shape in shapes)
    return list(dict.fromkeys(address for address in addresses_or_none if address is not None))


class FileSet:
    """A set of files read by address, with the same restrictions as for pages.

    Args:
        meshes: the folders that may be read.
    """

    def __init__(self, meshes: MeshFolders) -> None:
        self._meshes = meshes

    def path(self, address: str) -> Path:
        """Return the path of the file at an address.

        Raises:
            FileRefusedError: the file may not be read, or does not exist.
        """
        match = _ADDRESS.fullmatch(urlsplit(address).path)
        if match is None:
            raise FileRefusedError(404, "no such file")
        return self._meshes.file(match[1], unquote(match[2]))

    def collect(self, addresses_to_read: Iterable[str]) -> dict[str, bytes]:
        """Return the contents of files and of the files that they refer to, by address path.

        Missing files are omitted.
        """
        contents: dict[str, bytes] = {}
        pending = [urlsplit(address).path for address in addresses_to_read]
        while pending:
            address = pending.pop()
            if address in contents:
                continue
            try:
                path = self.path(address)
                contents[address] = path.read_bytes()
            except (FileRefusedError, OSError):
                continue
            folder = address.rpartition("/")[0]
            pending += [f"{folder}/{name}" for name in find_referenced_files(path.suffix.lower(), contents[address])]
        return contents


def find_referenced_files(suffix: str, data: bytes) -> list[str]:
    """Return the files that a mesh or material file refers to, as relative paths.

    Args:
        suffix: the suffix of the file in lower case, such as ``.dae``.
        data: the content of the file.
    """
    names: list[str] = []
    if suffix == ".dae":
        names = _COLLADA_IMAGE.findall(data.decode("utf-8", "replace"))
    elif suffix == ".obj":
        names = _MATERIAL_FILE.findall(data.decode("utf-8", "replace"))
    elif suffix == ".mtl":
        # Options may precede the file name, which then cannot contain spaces.
        lines = _MATERIAL_MAP.findall(data.decode("utf-8", "replace"))
        names = [line.split()[-1] if line.startswith("-") else line for line in lines]
    elif suffix == ".gltf":
        try:
            document = json.loads(data)
            entries = [*document.get("buffers", ()), *document.get("images", ())]
            names = [str(part["uri"]) for part in entries if "uri" in part]
        except (ValueError, AttributeError, TypeError):
            return []
    return [name for name in names if not name.startswith(("data:", "/", "file:", "http:", "https:"))]


_UNCHANGED_MESSAGES = (DisplayProperties, FrameTable, SavedViews, ViewClasses, ViewState)
"""Messages that are included unchanged, because they reveal nothing about the machine of the program."""

_PATH_PROPERTIES = frozenset({"Description File"})
"""Properties with paths on the machine of the program."""


@dataclass(frozen=True)
class Snapshot:
    """A robot, and all messages that a page needs to draw it.

    Attributes:
        name: the name of the robot.
        robot: the description of the robot.
        scene: the links of the robot in the form for pages.
        positions: the joint positions by name, rad or m.
        messages: the messages that a page needs; the frame table is the last one.
        frames: the binary frames, beginning with the transforms.
        meshes: finds the files that `scene` refers to.
        problems: the findings about shapes that cannot be drawn.
        marker_meshes: the addresses of the meshes of markers.
        outside_files: the included files that are neither in a package nor below the description's folder.
        awaits_size: whether a page must measure the robot and fit the sizes of grid and axes.
        spacing: the typical distance in m between the frames of a link and its parent; None if unknown.
    """

    name: str
    robot: Robot
    scene: RobotScene
    positions: Mapping[str, float]
    messages: Sequence[ServerMessage]
    frames: Sequence[bytes]
    meshes: MeshFolders = field(repr=False)
    problems: Sequence[Diagnostic] = ()
    marker_meshes: Sequence[str] = ()
    outside_files: Sequence[Path] = ()
    awaits_size: bool = False
    spacing: float | None = None


def take_configuration_snapshot(
    viewer: FeatureHost, manager: VisualizationManager, view: View | None = None
) -> Snapshot:
    """Return a snapshot of the current state of a configuration.

    Args:
        viewer: the viewer that shows the configuration.
        manager: the manager of the configuration.
        view: the view of the camera; None for the view of a new page.

    Raises:
        LinkwrightError: VIEW201, there is no robot.
    """
    models = [model for model in manager.robot_models() if model.enabled and model.scene.links]
    if not models:
        raise no_robot_error()
    opening_messages, frames = viewer.opening_messages(manager)
    if view is not None:
        opening_messages = [
            ViewState(view, server_message.revision) if isinstance(server_message, ViewState) else server_message
            for server_message in opening_messages
        ]
    snapshot = take_snapshot(models[0], opening_messages, frames, viewer.context.meshes)
    files = viewer.context.library.files
    outside_paths = [
        path for model in models for path in find_outside_files(files(model.text), model.scene, snapshot.meshes)
    ]
    return dataclasses.replace(
        snapshot,
        outside_files=list(dict.fromkeys(outside_paths)),
        problems=[problem for model in models for problem in _find_problems(model)],
        awaits_size=manager.config.awaits_size,
        spacing=manager.config.spacing,
    )


def find_outside_files(read: Sequence[Path], scene: RobotScene, meshes: MeshFolders) -> list[Path]:
    """Return the files of a description that recipients of an export may not be allowed to see.

    As in ROS, includes, ``load_yaml`` and ``file://`` can read any file of the machine.

    Args:
        read: the source files of the text, beginning with the main file.
        scene: the links, which refer to meshes and textures.
        meshes: the folders from which meshes and textures may be read.

    Returns:
        The files that are neither in a package nor below the folder of the main file.
    """
    files = FileSet(meshes)
    file_paths = dict.fromkeys(Path(normpath(path.absolute())) for path in read)  # Paths may contain `..`.
    for address in find_mesh_addresses([scene]):
        with suppress(FileRefusedError):
            file_paths[files.path(address)] = None
    main_folder = read[0].absolute().parent if read else None
    return [
        path
        for path in file_paths
        if not (main_folder and path.is_relative_to(main_folder)) and enclosing_package(path.parent) is None
    ]


def take_snapshot(
    model: RobotModelDisplay, opening: Sequence[ServerMessage], payloads: Sequence[Payload], meshes: MeshFolders
) -> Snapshot:
    """Return a snapshot of a robot, with the messages that a page needs without a server.

    Args:
        model: the display of the robot whose joints can be moved.
        opening: the messages for a page that opens.
        payloads: the binary frames for this page.
        meshes: the folders that the page may read from.

    Raises:
        LinkwrightError: VIEW201, the display has no robot.
    """
    robot, scene = model.robot, model.scene
    if robot is None:
        raise no_robot_error()
    frames = [frame for payload in payloads if isinstance(frame := _get_full_content(payload), bytes)]
    table = next(message for message in opening if isinstance(message, FrameTable))
    poses = _read_poses(table, frames)
    positions = compute_positions(robot, {link.name: poses[link.frame] for link in scene.links if link.frame in poses})
    messages: list[ServerMessage] = []
    for message in opening:
        if isinstance(message, Tree):
            messages.append(_without_details(message))
        elif isinstance(message, RobotScene):
            messages.append(replace(message, links=[replace(link, place=None) for link in message.links]))
        elif isinstance(message, ComparedDescriptions):
            messages.append(without_paths(message))
        elif isinstance(message, Hello):
            messages.append(replace(message, run=""))
        elif isinstance(message, _UNCHANGED_MESSAGES):
            messages.append(message)
    controls = _make_joint_controls(robot)
    messages[-1:-1] = [
        Joints(controls),
        JointPositions({control.name: positions.get(control.name, 0.0) for control in controls}),
    ]
    problems = _find_problems(model)
    return Snapshot(
        robot.name, robot, scene, positions, messages, frames, meshes.copy(), problems, _find_marker_meshes(payloads)
    )


def _find_problems(model: RobotModelDisplay) -> list[Diagnostic]:
    """Return the findings about shapes of a robot that cannot be drawn."""
    return [
        Diagnostic(
            "VIEW203",
            phrase("link '{link}' is exported incompletely: {text}", link=link, text=foreign(text)),
            severity=Severity.WARNING,
        )
        for link, texts in model.file_problems.items()
        for text in texts
    ]


def no_robot_error() -> LinkwrightError:
    """Return the error VIEW201: there is no robot to export."""
    hint = phrase("wait until the robot is drawn, or enable its RobotModel display")
    return LinkwrightError(Diagnostic("VIEW201", phrase("no robot can be exported, because none is shown"), hint=hint))


def _get_full_content(payload: Payload) -> bytes | str | None:
    """Return the full content of a payload, as for a new page, or None if it is empty."""
    if isinstance(payload, ScaledData):
        return payload.full_frame
    return payload if isinstance(payload, (bytes, str)) else payload.since(0)[0]


def _find_marker_meshes(payloads: Sequence[Payload]) -> list[str]:
    from linkwright.rviz.markers.shapes import MarkerStore

    shapes = [shape for payload in payloads if isinstance(payload, MarkerStore) for shape in payload.shapes]
    return [shape.mesh.url for shape in shapes if shape.mesh is not None and shape.mesh.url is not None]


def _read_poses(table: FrameTable, frames: Sequence[bytes]) -> dict[str, NDArray[np.float64]]:
    for frame in frames:
        revision, poses = unpack_transforms(frame)
        if revision == table.revision:
            return {name: pose for name, pose in zip(table.names, poses, strict=True) if not np.isnan(pose[0])}
    return {}


def _without_details(tree: Tree) -> Tree:
    """Return a tree of displays without status and paths.

    They would reveal details of this machine.
    """
    displays: list[Display] = [
        replace(display, status=[], level="ok", properties=_without_paths(display.properties))
        for display in tree.displays
    ]
    return replace(tree, global_status=[], global_level="ok", displays=displays)


def _without_paths(properties: Sequence[Property]) -> list[Property]:
    return [
        replace(row, value="" if row.name in _PATH_PROPERTIES else row.value, children=_without_paths(row.children))
        for row in properties
    ]


def _make_joint_controls(robot: Robot) -> list[JointControl]:
    """Return a slider for each movable joint, as in joint_state_publisher_gui."""
    layout = make_layout(robot, JointSettings())
    controls = []
    for joint in layout.ranges.values():
        if joint.lower == joint.upper:
            continue
        mimic_rule = layout.dependent.get(joint.name)
        kind = cast("Any", joint.kind)  # Movable joints have one of these three kinds.
        control = JointControl(joint.name, kind, joint.lower, joint.upper, joint.zero)
        if mimic_rule is not None:
            control = replace(control, mimic=mimic_rule.parent, multiplier=mimic_rule.factor, offset=mimic_rule.offset)
        controls.append(control)
    return controls
